#include <gtest/gtest.h>

#include <cmath>

#include <beltrami/operators/distortion.h>
#include <beltrami/unfold/local_unfold.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

std::vector<Freedom> rim_fixed(const Surface& surface) {
    std::vector<Freedom> freedoms(static_cast<std::size_t>(surface.mesh.vertex_count()), Freedom::free);
    for (const int v : surface.topology.boundary_loops[0]) freedoms[v] = Freedom::fixed;
    return freedoms;
}

/// The square rolled out by exp: its right side is 1e-9 as long as its left one. Conformal up to the mesh.
Eigen::VectorXcd crowded(const Surface& square) {
    return test::complex_positions(square.mesh).unaryExpr([](Complex z) {
        return std::exp(-20.0 * (z.real() + Complex(0, 0.05) * z.imag()));
    });
}

TEST(LocalUnfolding, LeavesAMapWithoutFolds) {
    const Surface square(test::jittered_square(24));
    const Eigen::VectorXcd map = crowded(square);
    ASSERT_TRUE(distortion(square.operators, map).flipped.empty());
    const LocalUnfolding result = unfold_locally(square, rim_fixed(square), map);
    EXPECT_TRUE(result.fold_free);
    EXPECT_TRUE(result.unfolded.empty());
    EXPECT_EQ(result.map, map);
}

TEST(LocalUnfolding, OpensFoldsOfAnySize) {
    const Surface square(test::jittered_square(24));
    const Eigen::VectorXcd map = crowded(square);
    Eigen::VectorXcd folded = map;
    const int far = 12 * 25 + 22, near = 12 * 25 + 5;  // 22 and 5 cells from the left
    for (const int v : {far, near}) folded[v] = map[v] + 2.5 * (map[v + 1] - map[v]);
    ASSERT_FALSE(distortion(square.operators, folded).flipped.empty());
    const LocalUnfolding result = unfold_locally(square, rim_fixed(square), folded);
    EXPECT_TRUE(result.fold_free);
    EXPECT_FALSE(result.unfolded.empty());
    EXPECT_TRUE(distortion(square.operators, result.map).flipped.empty());
    for (int v = 0; v < folded.size(); ++v) {
        const int column = v % 25;
        if (column > 9 && column < 18) {
            EXPECT_EQ(result.map[v], folded[v]);
        }
        if (square.topology.on_boundary[v]) {
            EXPECT_EQ(result.map[v], folded[v]);
        }
    }
    EXPECT_LT(std::abs(result.map[far] - map[far]), 2.5 * std::abs(map[far + 1] - map[far]));
}

}  // namespace
}  // namespace beltrami
