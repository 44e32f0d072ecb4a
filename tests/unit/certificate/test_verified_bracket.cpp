#include <gtest/gtest.h>

#include <cmath>

#include <beltrami/certificate/verified_bracket.h>
#include <beltrami/solve/dirichlet_solver.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

Eigen::VectorXcd harmonic_values(const Surface& surface, const BoundaryCondition& boundary) {
    return dirichlet_solver(surface).solve(prescribed_values(boundary, surface));
}

/// The map of a bracket attains what it says, by its own bounds, and has the boundary values.
void expect_verified(const VerifiedBracket& bracket) {
    const QuadraticSpace space(bracket.surface, bracket.cones);
    for (const double bound : space.bounds(bracket.map))
        EXPECT_LE((1 + bound) / (1 - bound), bracket.K_upper * (1 + 1e-9));
    const Eigen::VectorXcd values = prescribed_values(bracket.boundary, bracket.surface);
    for (const auto& loop : bracket.surface.topology.boundary_loops)
        for (const int v : loop) EXPECT_LT(std::abs(bracket.map[v] - values[v]), 1e-14);
    EXPECT_EQ(bracket.reached, bracket.reason.empty());
}

TEST(VerifiedBracket, OfAnExactMapFromAHarmonicStart) {
    const Surface surface(disk(7));
    const BoundaryCondition boundary = test::boundary_values(surface, test::exact_composition);
    VerifiedBracketOptions options;
    options.gap = 0.03;
    options.K_lower = 2.98;
    const VerifiedBracket bracket = verified_bracket(surface, boundary, harmonic_values(surface, boundary), options);
    expect_verified(bracket);
    EXPECT_TRUE(bracket.reached) << bracket.reason;
    EXPECT_GT(bracket.K_upper, 3);  // K* of the polygon is larger than that of the circle
    EXPECT_LE(bracket.K_upper, 1.03 * bracket.K_lower);
}

TEST(VerifiedBracket, AConePointNeedsPowerElements) {
    // A cone of 300 degrees onto the flat polygon: no map that is smooth at its tip has K < 1.2, the extremal one is
    // nearly conformal.
    Mesh mesh = disk(6);
    const Positions flat = mesh.positions;
    mesh.positions.resize(flat.rows(), 3);
    const double slope = std::sqrt(std::pow(6.0 / 5, 2) - 1);
    for (Eigen::Index v = 0; v < flat.rows(); ++v)
        mesh.positions.row(v) << flat(v, 0), flat(v, 1), -slope * flat.row(v).norm();
    const Surface surface(mesh);
    const BoundaryCondition boundary = test::boundary_values(surface, [](Complex z) { return z; });
    double tip = 0;
    for (const ConePoint& cone : cone_points(surface)) tip = std::max(tip, cone.stretch);
    EXPECT_GT(tip, 1.15);
    VerifiedBracketOptions options;
    options.gap = 0.05;
    options.most_triangles = 3000;
    const VerifiedBracket bracket = verified_bracket(surface, boundary, harmonic_values(surface, boundary), options);
    expect_verified(bracket);
    EXPECT_FALSE(bracket.cones.empty());
    EXPECT_LT(bracket.K_upper, tip) << bracket.reason;
    EXPECT_GE(bracket.K_upper, bracket.K_lower);
}

TEST(VerifiedBracket, StartsThatFoldAreOpened) {
    const Surface surface(disk(10));
    const BoundaryCondition boundary = test::boundary_values(surface, test::three_lobes);
    VerifiedBracketOptions options;
    options.gap = 0.2;
    options.K_lower = 1.8;
    options.most_triangles = 3000;
    const VerifiedBracket bracket = verified_bracket(surface, boundary, harmonic_values(surface, boundary), options);
    EXPECT_GE(bracket.K_lower, 1.8);
    if (bracket.reached)
        expect_verified(bracket);
    else
        EXPECT_FALSE(bracket.reason.empty());
}

}  // namespace
}  // namespace beltrami
