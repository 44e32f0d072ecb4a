#include <beltrami/certificate/solution_bounds.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <beltrami/differentials/tabulated_space.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

/// An affine map, K = 3, with one face crushed to almost nothing by a vertex that is out of its place.
TEST(SolutionBounds, OneCrushedFaceDoesNotDecideTheEstimateOfATabulatedDifferential) {
    const Surface source(disk(12));
    const Eigen::VectorXcd z = test::complex_positions(source.mesh);
    const auto affine = [](Complex at) { return at + 0.5 * std::conj(at); };
    const BoundaryCondition boundary = test::boundary_values(source, affine);
    Eigen::VectorXcd map = z.unaryExpr(affine);
    const auto face = source.mesh.faces[0];
    ASSERT_FALSE(source.topology.on_boundary[face[0]]);
    const Complex middle = 0.5 * (map[face[1]] + map[face[2]]);
    map[face[0]] = middle + 1e-6 * (map[face[0]] - middle);

    const Eigen::Index samples = source.operators.sample_count();
    const Chart chart = chart_of_frames(source);
    const TabulatedSpace space(Eigen::MatrixXcd::Ones(samples, 1), Coefficients::complex);
    const Eigen::VectorXcd one = Eigen::VectorXcd::Ones(1), phi = Eigen::VectorXcd::Ones(samples);
    const Distortion measured = distortion(source.operators, map);
    ASSERT_TRUE(measured.flipped.empty());
    const ReichStrebel integrals = reich_strebel(source, chart, space, one, measured.mu);
    ASSERT_TRUE(integrals.valid);
    EXPECT_LT(integrals.estimate, 1);  // the face is stretched across φ, a million times more than the others
    const std::vector<LoopPath> paths;
    const std::vector<int> turns;
    const SolutionBounds bounds =
        solution_bounds({source, boundary, chart, space, one, phi, 0.5, map, measured, integrals, paths, 0, turns}, {});
    EXPECT_NEAR(bounds.K, 3, 0.3);
    EXPECT_NEAR(bounds.k, k_of(bounds.K), 1e-15);
    // What is called a lower bound is that of the map as it is.
    EXPECT_EQ(bounds.K_lower, std::max(1.0, integrals.lower));
    EXPECT_LE(bounds.K_lower, bounds.K);
}

}  // namespace
}  // namespace beltrami
