#include <gtest/gtest.h>

#include <beltrami/charts/round_disk.h>
#include <beltrami/coefficient/coefficient_step.h>
#include <beltrami/differentials/polynomial_space.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/solve/beltrami_solver.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

struct Setting {
    explicit Setting(int triangles)
        : surface(disk(disk_rings_for_triangles(triangles))), chart(round_disk_chart(surface)) {}
    Eigen::VectorXd areas() const {
        return Eigen::Map<const Eigen::VectorXd>(surface.operators.weights.data(), surface.operators.sample_count())
            .cwiseProduct(chart.derivatives.cwiseAbs2());
    }
    Surface surface;
    Chart chart;
};

/// Weights that differ from sample to sample.
Eigen::VectorXd uneven(const Eigen::VectorXd& areas) {
    Eigen::VectorXd weights = areas;
    for (int s = 0; s < weights.size(); ++s) weights[s] *= 1.5 + std::sin(7 * s);
    return weights;
}

TEST(ChartCells, NodesHaveTheMassAndTheMeanOfTheSamples) {
    const Setting setting(20'000);
    const ChartCells cells(setting.chart, setting.areas(), 0.3);
    const Eigen::VectorXd weights = uneven(setting.areas()), at_nodes = cells.node_weights(weights);
    EXPECT_GT(at_nodes.minCoeff(), 0);
    EXPECT_NEAR(at_nodes.sum(), weights.sum(), 1e-12);
    EXPECT_LT(
        std::abs(at_nodes.cast<Complex>().dot(cells.nodes()) - weights.cast<Complex>().dot(setting.chart.positions)),
        1e-12);
    EXPECT_LT(cells.nodes().size(), setting.surface.operators.sample_count() / 3);
}

TEST(ChartCells, PlacesIntegrateCubicsExactly) {
    const Setting setting(20'000);
    const ChartCells cells(setting.chart, setting.areas(), 0.3);
    Eigen::VectorXcd weights = uneven(setting.areas()).cast<Complex>();
    for (int s = 0; s < weights.size(); ++s) weights[s] *= std::polar(1.0, 0.1 * s);
    const Eigen::VectorXcd at_places = cells.place_weights(weights);
    for (int power = 0; power < 4; ++power) {
        const Complex exact = (weights.array() * setting.chart.positions.array().pow(power)).sum(),
                      found = (at_places.array() * cells.places().array().pow(power)).sum();
        EXPECT_LT(std::abs(found - exact), 1e-12);
    }
}

TEST(ChartCells, TurnWithTheChart) {
    const Setting setting(8'000);
    Chart turned = setting.chart;
    turned.positions *= std::polar(1.0, 0.7);
    const ChartCells cells(setting.chart, setting.areas(), 0.3), others(turned, setting.areas(), 1.0);
    ASSERT_EQ(cells.nodes().size(), others.nodes().size());
    EXPECT_LT((std::polar(1.0, 0.7) * cells.nodes() - others.nodes()).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_LT((std::polar(1.0, 0.7) * cells.places() - others.places()).cwiseAbs().maxCoeff(), 1e-12);
}

/// k of the c-step on every sample.
double k_on_samples(const Setting& setting, const DifferentialSpace& space, const Eigen::VectorXcd& mu) {
    DualProblem problem;
    problem.basis = space.evaluate({setting.chart.positions, setting.chart.derivatives});
    problem.complex_coefficients = space.complex_coefficients();
    problem.weights.resize(mu.size());
    problem.pairing = Eigen::VectorXcd::Zero(space.size());
    problem.rounding = 1e-3;
    for (int s = 0; s < mu.size(); ++s) {
        const double square = std::norm(mu[s]), area = setting.surface.operators.weights[s];
        problem.weights[s] = area * (1 + square) / (1 - square);
        problem.pairing += area / (1 - square) * mu[s] * problem.basis.row(s).transpose();
    }
    const DualSolution dual = solve_dual(problem, {});
    return dilatation_of_pairing(2 * dual.pairing / problem.weights.dot(dual.phi.cwiseAbs()));
}

/// μ of the harmonic map with values on the circle.
template <class Values>
Eigen::VectorXcd harmonic_mu(const Surface& surface, Values&& values) {
    BoundaryCondition boundary;
    for (const int v : surface.topology.boundary_loops[0])
        boundary.pin(v, values(Complex(surface.mesh.positions(v, 0), surface.mesh.positions(v, 1))));
    return beltrami_coefficient(surface.operators, harmonic_map(surface, boundary));
}

Complex composition(Complex z) {
    const Complex g = z + 0.3 * z * z;
    return std::exp(0.6 * (g + 0.5 * std::conj(g)));
}
Complex lobes(Complex z) {
    const double t = std::arg(z);
    return std::polar(1 + 0.2 * std::cos(3 * t), t + 0.4 * std::sin(t) + 0.1 * std::sin(3 * t));
}

TEST(ChartCells, GiveTheDilatationOfAllSamples) {
    const Setting setting(20'000);
    const PolynomialSpace space(28, 28);
    CoefficientStep step(setting.surface, setting.chart, {}, 0.3, 1500, CoefficientStep::Sums::over_cells);
    step.set_space(space);
    for (const auto values : {composition, lobes}) {
        const Eigen::VectorXcd mu = harmonic_mu(setting.surface, values);
        ASSERT_LT(mu.cwiseAbs().maxCoeff(), 0.95);
        EXPECT_NEAR(step.solve(mu, {}, 1e-7).k, k_on_samples(setting, space, mu), 1e-5);
    }
}

}  // namespace
}  // namespace beltrami
