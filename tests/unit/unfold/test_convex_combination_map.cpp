#include <beltrami/unfold/convex_combination_map.h>

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <beltrami/generate/grids.h>
#include <beltrami/operators/distortion.h>

#include "support/meshes.h"

namespace beltrami {

namespace {

constexpr ConvexWeights kBoth[] = {ConvexWeights::uniform, ConvexWeights::mean_value};

/// The boundary by arc length on the unit circle.
BoundaryCondition on_circle(const Surface& surface) {
    BoundaryCondition boundary;
    const auto& loop = surface.topology.boundary_loops[0];
    double along = 0;
    for (std::size_t i = 0; i < loop.size(); ++i) {
        boundary.pin(loop[i], std::polar(1.0, 2 * std::numbers::pi * along / surface.topology.loop_lengths[0]));
        along += surface.boundary_edge_lengths[0][i];
    }
    return boundary;
}

/// The square bent into a long narrow tongue, whose harmonic map to the disk folds.
Mesh tongue() {
    Mesh mesh = test::jittered_square(10);
    Positions p = Positions::Zero(mesh.vertex_count(), 3);
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        const double x = mesh.positions(v, 0), y = mesh.positions(v, 1);
        p.row(v) << x, 40 * y * y, 9 * std::sin(8 * y) * x;
    }
    mesh.positions = p;
    return mesh;
}

}  // namespace

TEST(ConvexCombinationMap, NeverFoldsOntoConvexPolygons) {
    for (const Mesh& mesh : {tongue(), test::jittered_square(7)}) {
        const Surface surface(mesh);
        const BoundaryCondition boundary = on_circle(surface);
        ASSERT_TRUE(has_convex_target(surface, boundary));
        for (const ConvexWeights weights : kBoth) {
            const Eigen::VectorXcd map = convex_combination_map(surface, boundary, weights);
            EXPECT_LT(distortion(surface.operators, map).max, 1);
            for (std::size_t i = 0; i < boundary.vertices.size(); ++i)
                EXPECT_EQ(map[boundary.vertices[i]], boundary.images[i]);
        }
        int factorizations = 0;
        EXPECT_TRUE(convex_embedding(surface, boundary, factorizations));
        EXPECT_EQ(factorizations, 1);
    }
}

TEST(ConvexCombinationMap, MeanValuesReproduceAffineMaps) {
    for (const Cells cells : {Cells::triangles, Cells::quads}) {
        const Surface surface(rectangle(2, 1, 9, 5, cells));
        const auto affine = [](Complex z) { return Complex(3, 1) * z + Complex(0.4, -0.7) * std::conj(z) + 5.0; };
        const BoundaryCondition boundary = test::boundary_values(surface, affine);
        const Eigen::VectorXcd map = convex_combination_map(surface, boundary, ConvexWeights::mean_value);
        for (int v = 0; v < map.size(); ++v)
            EXPECT_LT(std::abs(map[v] - affine({surface.mesh.positions(v, 0), surface.mesh.positions(v, 1)})), 1e-12);
    }
}

TEST(ConvexCombinationMap, DoesNotDependOnScale) {
    const Surface surface(tongue());
    Mesh large = tongue();
    large.positions *= 1e100;
    const Surface scaled(large);
    for (const ConvexWeights weights : kBoth) {
        const Eigen::VectorXcd a = convex_combination_map(surface, on_circle(surface), weights),
                               b = convex_combination_map(scaled, on_circle(surface), weights);
        EXPECT_LT((a - b).cwiseAbs().maxCoeff(), 1e-10);
    }
}

TEST(ConvexCombinationMap, ConvexTargets) {
    const Surface surface(test::jittered_square(6));
    const auto mapped = [&](auto f) { return has_convex_target(surface, test::boundary_values(surface, f)); };
    EXPECT_TRUE(mapped([](Complex z) { return z; })) << "straight at most vertices";
    EXPECT_FALSE(mapped([](Complex z) { return std::conj(z); })) << "clockwise";
    EXPECT_FALSE(mapped([](Complex z) { return z + 0.2 * z * z * z; }));
    BoundaryCondition part = on_circle(surface);
    part.vertices.pop_back();
    part.images.pop_back();
    EXPECT_FALSE(has_convex_target(surface, part));
    BoundaryCondition pinned = on_circle(surface);
    for (int v = 0; v < surface.mesh.vertex_count(); ++v)
        if (!surface.topology.on_boundary[v]) {
            pinned.pin(v, 0);
            break;
        }
    EXPECT_FALSE(has_convex_target(surface, pinned));
    int factorizations = 0;
    EXPECT_FALSE(convex_embedding(surface, pinned, factorizations));
}

}  // namespace beltrami
