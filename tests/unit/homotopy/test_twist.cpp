#include <gtest/gtest.h>

#include <cmath>

#include <beltrami/base/constants.h>
#include <beltrami/base/error.h>
#include <beltrami/homotopy/twist.h>
#include <beltrami/meshing/planar_domains.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/solve/beltrami_solver.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

constexpr double kInnerRadius = 0.05;

Complex turned_by(Complex z, double kappa, double angle) {
    const double r = std::abs(z);
    return z * std::pow(r, kappa - 1) * std::polar(1.0, angle / std::log(kInnerRadius) * std::log(r));
}

struct Ring {
    Mesh mesh;
    Surface surface;
    Eigen::VectorXcd z;
    explicit Ring(int around, int layers, double amount = 0)
        : mesh(annulus(kInnerRadius, 1, around, layers, {amount})), surface(mesh), z(test::complex_positions(mesh)) {}
};

/// Three round holes of different sizes.
Mesh three_holes(double edge_length) {
    const auto hole = [](double x, double y, double r) { return Circle{{x, y}, r}; };
    DomainOptions options;
    options.edge_length = edge_length;
    options.hole_edge_length = 0.2 * edge_length;
    options.grading = 0.1;  // twists want layers that are thin against their radius
    return circle_domain({}, {hole(-0.45, 0.1, 0.12), hole(0.4, 0.3, 0.08), hole(0.25, -0.45, 0.15)}, options);
}

TEST(LogarithmicMap, OfARingIsTheClosedFormWithAnyTurns) {
    for (const int around : {32, 64}) {
        const Ring ring(around, around / 2);
        double error = 0;
        for (const int turns : {0, 1, -1, 2})
            for (const double smallest : {0.0, 1.0}) {
                const double angle = kTurn * turns + smallest;
                const BoundaryCondition boundary = test::boundary_values(
                    ring.surface, [&](Complex p) { return Complex(2, 1) + turned_by(p, 0.7, angle); });
                const Eigen::VectorXcd f = logarithmic_map(ring.surface, ring.z, 0, boundary, turns);
                const HoleTurns found = homotopy_class(ring.surface, ring.z, f).holes[0];
                EXPECT_EQ(found.turns, turns);
                EXPECT_NEAR(found.angle, angle, 1e-9);
                for (Eigen::Index v = 0; v < f.size(); ++v)
                    error = std::max(error, std::abs(f[v] - Complex(2, 1) - turned_by(ring.z[v], 0.7, angle)));
            }
        // In geometric layers log|z| is harmonic to the last digit.
        EXPECT_LT(error, 1e-9);
    }
}

TEST(LogarithmicMap, ConvergesOnAnIrregularMesh) {
    std::vector<double> errors;
    for (const double h : {0.06, 0.03}) {
        DomainOptions options;
        options.edge_length = h;
        const Mesh mesh = circle_domain({}, {Circle{{0, 0}, 0.3}}, options);
        const Surface surface(mesh);
        const Eigen::VectorXcd z = test::complex_positions(mesh);
        const auto exact = [](Complex p) { return p * std::polar(1.0, kTurn / std::log(0.3) * std::log(std::abs(p))); };
        const Eigen::VectorXcd f = logarithmic_map(surface, z, 0, test::boundary_values(surface, exact), 1);
        double error = 0;
        for (Eigen::Index v = 0; v < f.size(); ++v) error = std::max(error, std::abs(f[v] - exact(z[v])));
        errors.push_back(error);
    }
    EXPECT_LT(errors[1], 0.02);
    EXPECT_LT(errors[1], errors[0] / 2.5);
}

TEST(LogarithmicMap, ImpossibleBoundaryValuesAreRefused) {
    const Ring ring(24, 0);
    const BoundaryCondition away = test::boundary_values(
        ring.surface, [](Complex p) { return std::abs(p) < 0.5 ? p + 5.0 : p; });  // hole outside the outer loop
    EXPECT_THROW(logarithmic_map(ring.surface, ring.z, 0, away, 0), Error);
    BoundaryCondition part = test::boundary_values(ring.surface, [](Complex p) { return p; });
    part.vertices.pop_back();
    part.images.pop_back();
    EXPECT_THROW(logarithmic_map(ring.surface, ring.z, 0, part, 0), Error);
}

TEST(TwistedMap, TurnsOneHoleAndLeavesTheOthers) {
    const Mesh mesh = three_holes(0.04);
    const Surface surface(mesh);
    const Eigen::VectorXcd z = test::complex_positions(mesh);
    const BoundaryCondition boundary =
        test::boundary_values(surface, [](Complex p) { return p + 0.08 * std::conj(p) + 0.05 * p * p; });
    const Eigen::VectorXcd f = harmonic_map(surface, boundary);
    const auto paths = loop_paths(surface, z, 0);
    const HomotopyClass before = homotopy_class(surface, paths, f);
    for (const std::vector<int>& extra :
         {std::vector<int>{0, 1, 0, 0}, {0, 0, -1, 0}, {0, 0, 0, 1}, {0, 1, -1, 1}, {0, 0, 0, 0}}) {
        const Eigen::VectorXcd g = twisted_map(surface, z, 0, f, extra);
        const HomotopyClass after = homotopy_class(surface, paths, g);
        for (std::size_t i = 0; i < 3; ++i) {
            EXPECT_TRUE(before.holes[i].meaningful);
            EXPECT_EQ(after.holes[i].turns, before.holes[i].turns + extra[i + 1]);
            EXPECT_NEAR(after.holes[i].angle - before.holes[i].angle, kTurn * extra[i + 1], 1e-9);
        }
        for (const auto& loop : surface.topology.boundary_loops)
            for (const int v : loop) EXPECT_EQ(g[v], f[v]);
        const Distortion d = distortion(surface.operators, g);
        // Shear 3.4 to 5.4: irregular faces of more than 8/shear³ radii fold (docs/homotopy.md).
        EXPECT_LT(static_cast<double>(d.flipped.size()), 0.15 * mesh.face_count());
    }
}

TEST(TwistedMap, AndBackIsNearlyTheMapItself) {
    const Ring ring(120, 66);
    const Eigen::VectorXcd back =
        twisted_map(ring.surface, ring.z, 0, twisted_map(ring.surface, ring.z, 0, ring.z, {0, 1}), {0, -1});
    double error = 0;
    for (Eigen::Index v = 0; v < back.size(); ++v) error = std::max(error, std::abs(back[v] / ring.z[v] - 1.0));
    EXPECT_LT(error, 0.02);  // interpolation between the vertices, twice
}

TEST(TwistedMap, TooCoarseOrTooNarrowIsRefused) {
    const Ring coarse(12, 3);
    EXPECT_THROW(twisted_map(coarse.surface, coarse.z, 0, coarse.z, {0, 5}), Error);
    EXPECT_THROW(twisted_map(coarse.surface, coarse.z, 0, coarse.z, {1}), Error);
    // A long hole beside another one: no round ring around it is free.
    const Polygon outer{{0, 0}, {10, 0}, {10, 4}, {0, 4}}, slot{{1, 1}, {9, 1}, {9, 1.5}, {1, 1.5}};
    const Polygon other{{4, 2.5}, {5, 2.5}, {5, 3}, {4, 3}};
    DomainOptions options;
    options.edge_length = 0.5;
    const Mesh mesh = polygon_domain(outer, {slot, other}, options);
    const Surface surface(mesh);
    const Eigen::VectorXcd z = test::complex_positions(mesh);
    const int slot_loop = surface.topology.loop_lengths[1] > surface.topology.loop_lengths[2] ? 1 : 2;
    std::vector<int> extra(3, 0);
    EXPECT_EQ(twisted_map(surface, z, 0, z, extra), z);
    extra[slot_loop] = 1;
    EXPECT_THROW(twisted_map(surface, z, 0, z, extra), Error);
}

TEST(StartInClass, ReachesTheWantedTurns) {
    const Ring ring(64, 64);
    const BoundaryCondition plain = test::boundary_values(ring.surface, [](Complex p) { return turned_by(p, 1, 0.3); });
    for (const int turns : {0, 1, -2}) {
        const StartInClass start = start_in_class(ring.surface, ring.z, 0, plain, {0, turns});
        EXPECT_EQ(start.homotopy.holes[0].turns, turns);
        EXPECT_TRUE(start.homotopy.holes[0].meaningful);
        EXPECT_TRUE(distortion(ring.surface.operators, start.map).flipped.empty());
    }
    const Mesh mesh = three_holes(0.04);
    const Surface surface(mesh);
    const Eigen::VectorXcd z = test::complex_positions(mesh);
    // The holes move and the map starts with folds.
    const BoundaryCondition moved = test::boundary_values(surface, [](Complex p) {
        if (std::abs(p) > 0.99) return p;
        if (std::abs(p - Complex(-0.45, 0.1)) < 0.13) return p + Complex(0.2, 0.3);
        return p;
    });
    const StartInClass start = start_in_class(surface, z, 0, moved, {0, 1, 0, -1});
    EXPECT_EQ(start.homotopy.holes[0].turns, 1);
    EXPECT_EQ(start.homotopy.holes[1].turns, 0);
    EXPECT_EQ(start.homotopy.holes[2].turns, -1);
}

TEST(FStep, WithTheCoefficientOfATwistedMapKeepsItsClass) {
    const Ring ring(120, 66);
    for (const int turns : {1, -1, 2}) {
        const Eigen::VectorXcd f = twisted_map(ring.surface, ring.z, 0, ring.z, {0, turns});
        const BoundaryCondition boundary = test::boundary_values(ring.surface, [](Complex p) { return p; });
        Eigen::VectorXcd nu = beltrami_coefficient(ring.surface.operators, f);
        for (Eigen::Index s = 0; s < nu.size(); ++s)
            if (std::abs(nu[s]) > 0.95) nu[s] *= 0.95 / std::abs(nu[s]);
        BeltramiSolver solver(ring.surface, freedoms(boundary, ring.surface), 1);
        solver.factorize(nu);
        const HoleTurns found =
            homotopy_class(ring.surface, ring.z, solver.solve(prescribed_values(boundary, ring.surface))).holes[0];
        EXPECT_EQ(found.turns, turns);
        EXPECT_TRUE(found.meaningful);
    }
}

}  // namespace
}  // namespace beltrami
