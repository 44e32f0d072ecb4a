#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <beltrami/charts/averaged_coefficient.h>
#include <beltrami/meshing/planar_domains.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/solve/beltrami_solver.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

constexpr double kInner = 0.05;

/// The ring's map with a stretch and turns: F = κx + i(y + sx) in the logarithms, and its φ = c/z².
struct Turned {
    double kappa, s;
    Complex operator()(Complex z) const {
        const double x = std::log(std::abs(z));
        return z * std::exp(Complex((kappa - 1) * x, s * x));
    }
    Complex d_z() const { return {0.5 * (kappa + 1), 0.5 * s}; }
    Complex d_zbar() const { return {0.5 * (kappa - 1), 0.5 * s}; }
    double k() const { return std::abs(d_zbar() / d_z()); }
    double K() const { return (1 + k()) / (1 - k()); }
    /// μ = (∂̄F/∂F) z/conj(z)
    Complex mu(Complex z) const { return d_zbar() / d_z() * z / std::conj(z); }
    /// conj(φ)/|φ| = μ/k
    Complex phi(Complex z) const { return std::conj(d_zbar() / d_z()) / k() / (z * z); }
};

Turned with_turns(int turns, double kappa) {
    return {kappa, 2 * std::numbers::pi * turns / std::log(kInner)};
}

template <class Function>
Eigen::VectorXcd values(const Eigen::VectorXcd& z, const Function& f) {
    Eigen::VectorXcd result(z.size());
    for (Eigen::Index i = 0; i < z.size(); ++i) result[i] = f(z[i]);
    return result;
}

double worst(const Eigen::VectorXcd& a, const Eigen::VectorXcd& b) {
    return (a - b).cwiseAbs().maxCoeff();
}

TEST(AveragedCoefficient, ConvergesFasterThanThatOfTheFaces) {
    const Turned map = with_turns(1, 1.3);
    double averaged[2], raw[2];
    for (const int i : {0, 1}) {
        const Mesh mesh = annulus(kInner, 1, i ? 128 : 64);
        const Surface surface(mesh);
        const Eigen::VectorXcd z = test::complex_positions(mesh), f = values(z, map);
        const Chart chart = make_chart(surface, z, true);
        const auto mu = [&](Complex p) { return map.mu(p); };
        const auto phi = [&](Complex p) { return map.phi(p); };
        const Eigen::VectorXcd exact = values(chart.positions, mu);
        const Eigen::VectorXcd found = averaged_coefficient(surface, chart, values(chart.positions, phi), f),
                               own = beltrami_coefficient(surface.operators, f);
        // Root of the mean square in the hyperbolic measure |φ| dA, the same on all rings.
        double a = 0, r = 0, total = 0;
        for (Eigen::Index s = 0; s < exact.size(); ++s) {
            const double weight = surface.operators.weights[s] / std::norm(chart.positions[s]);
            a += weight * std::norm(found[s] - exact[s]);
            r += weight * std::norm(own[s] - exact[s]);
            total += weight;
        }
        averaged[i] = std::sqrt(a / total);
        raw[i] = std::sqrt(r / total);
    }
    EXPECT_LT(averaged[1], 0.2 * raw[1]);
    EXPECT_LT(averaged[1], averaged[0] / 2.5);
    EXPECT_GT(raw[1], raw[0] / 2.5);
}

TEST(AveragedCoefficient, GivesTheDilatationOfTwoTurnsThatFacesOverestimate) {
    for (const double kappa : {1.0, 1.5}) {
        const Turned map = with_turns(2, kappa);
        JitterOptions jitter;
        jitter.amplitude = 0.2;
        const Mesh mesh = annulus(kInner, 1, 120, 66, jitter);
        const Surface surface(mesh);
        const Eigen::VectorXcd z = test::complex_positions(mesh);
        const Chart chart = make_chart(surface, z, true);
        const Eigen::VectorXcd phi = values(chart.positions, [&](Complex p) { return map.phi(p); });
        const BoundaryCondition boundary = test::boundary_values(surface, map);
        BeltramiSolver solver(surface, freedoms(boundary, surface), 1);
        solver.factorize(map.k() * phi.conjugate().cwiseQuotient(phi.cwiseAbs().cast<Complex>()));
        const Eigen::VectorXcd f = solver.solve(prescribed_values(boundary, surface));
        // 1/I⁻ of Reich and Strebel with the averaged coefficient.
        const Eigen::VectorXcd mu = averaged_coefficient(surface, chart, phi, f);
        double total = 0, integral = 0, own = 0, own_plus = 0;
        const Eigen::VectorXcd own_mu = beltrami_coefficient(surface.operators, f);
        for (Eigen::Index s = 0; s < mu.size(); ++s) {
            const double weight = surface.operators.weights[s] * std::abs(phi[s]);
            const Complex unit = phi[s] / std::abs(phi[s]);
            ASSERT_LT(std::abs(mu[s]), 1);
            total += weight;
            integral += weight * std::norm(1.0 - mu[s] * unit) / (1 - std::norm(mu[s]));
            const Complex held = std::abs(own_mu[s]) > 0.95 ? own_mu[s] * (0.95 / std::abs(own_mu[s])) : own_mu[s];
            own += weight * std::norm(1.0 - held * unit) / (1 - std::norm(held));
            own_plus += weight * std::norm(1.0 + held * unit) / (1 - std::norm(held));
        }
        EXPECT_NEAR(total / integral / map.K(), 1, 0.005);
        EXPECT_GT(std::sqrt(own_plus / own) / map.K(), 1.04);
    }
}

TEST(AveragedCoefficient, OfAnAffineMapIsItsOwn) {
    // φ = 1 has one branch everywhere; frames of faces in space differ from face to face.
    for (const bool in_space : {false, true}) {
        Mesh mesh = test::mixed_square(8);
        if (in_space) {
            const Positions flat = mesh.positions;
            mesh.positions.resize(flat.rows(), 3);
            mesh.positions << flat.col(0), flat.col(1), Eigen::VectorXd::Ones(flat.rows()) + 0.0 * flat.col(0);
            for (Eigen::Index v = 0; v < flat.rows(); ++v) mesh.positions(v, 2) = 0.5 * flat(v, 0);
        }
        const Surface surface(mesh);
        Eigen::VectorXcd w(mesh.vertex_count());  // the plane's own coordinates
        for (int v = 0; v < mesh.vertex_count(); ++v)
            w[v] = {(in_space ? std::sqrt(1.25) : 1.0) * mesh.positions(v, 0), mesh.positions(v, 1)};
        const Chart chart = make_chart(surface, w, true);
        const Eigen::VectorXcd f = values(w, [](Complex p) { return 2.0 * p + Complex(0.5, 0.3) * std::conj(p); });
        const Eigen::VectorXcd phi = chart.derivatives.cwiseProduct(chart.derivatives) * Complex(0.2, 1);
        EXPECT_LT(worst(averaged_coefficient(surface, chart, phi, f), beltrami_coefficient(surface.operators, f)),
                  1e-12);
    }
}

TEST(AveragedCoefficient, KeepsTheFacesOwnAtZerosOfTheDifferential) {
    const Mesh mesh = disk(12);
    const Surface surface(mesh);
    const Eigen::VectorXcd z = test::complex_positions(mesh);
    const Chart chart = make_chart(surface, z, true);
    const Eigen::VectorXcd phi = chart.positions;  // a simple zero at vertex 0
    const Eigen::VectorXcd f = values(z, [](Complex p) { return p + 0.3 * std::conj(p); });
    const Eigen::VectorXcd found = averaged_coefficient(surface, chart, phi, f);
    for (Eigen::Index s = 0; s < found.size(); ++s) {
        EXPECT_TRUE(std::isfinite(std::abs(found[s])));
        EXPECT_LT(std::abs(found[s] - 0.3), std::abs(chart.positions[s]) < 0.1 ? 0.1 : 0.05);
    }
    const Eigen::VectorXcd none = Eigen::VectorXcd::Zero(phi.size());
    EXPECT_EQ(averaged_coefficient(surface, chart, none, f), beltrami_coefficient(surface.operators, f));
}

}  // namespace
}  // namespace beltrami
