#include <beltrami/charts/vertex_source.h>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <beltrami/charts/chart.h>
#include <beltrami/charts/round_disk.h>
#include <beltrami/operators/distortion.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

double mean_mu(const Surface& surface, const Eigen::VectorXcd& g) {
    return mu_statistics(beltrami_coefficient(surface.operators, g), surface.operators.weights).mean;
}

TEST(VertexSource, IsTheIdentityOfTheRoundDisk) {
    const Surface source(disk(20));
    int factorizations = 0;
    const auto g = disk_map_by_vertex_source(source, &factorizations);
    ASSERT_TRUE(g);
    EXPECT_EQ(factorizations, 1);
    const Complex turn = test::complex_positions(source.mesh)[1'000] / (*g)[1'000];
    EXPECT_NEAR(std::abs(turn), 1, 0.01);
    for (int v = 0; v < source.mesh.vertex_count(); ++v)
        EXPECT_LT(std::abs((*g)[v] * turn / std::abs(turn) - test::complex_positions(source.mesh)[v]), 0.02);
}

TEST(VertexSource, ConvergesOnASurface) {
    int factorizations = 0;
    double last = 1;
    for (const int triangles : {500, 2'000, 8'000}) {
        const Surface source(test::bump(triangles));
        const auto g = disk_map_by_vertex_source(source, &factorizations);
        ASSERT_TRUE(g);
        EXPECT_TRUE(distortion(source.operators, *g).flipped.empty());
        const double error = mean_mu(source, *g);
        EXPECT_LT(error, 0.65 * last);
        last = error;
    }
}

/// Quads are as good as their triangles.
TEST(VertexSource, TakesQuads) {
    int factorizations = 0;
    const Surface quads(test::quad_disk(20)), triangles(disk(20));
    const auto g = disk_map_by_vertex_source(quads, &factorizations),
               same = disk_map_by_vertex_source(triangles, &factorizations);
    ASSERT_TRUE(g && same);
    EXPECT_TRUE(distortion(quads.operators, *g).flipped.empty());
    EXPECT_LT(mean_mu(quads, *g), mean_mu(triangles, *same));
}

/// A finger: the tip of a long strip is seen from its middle under an angle of e^{-π·length}.
TEST(VertexSource, RimRunsForwardWhereItIsCrowded) {
    constexpr int across = 4, along = 60;
    Mesh mesh = rectangle(along / static_cast<double>(across), 1, along, across);
    const Surface source(std::move(mesh));
    int factorizations = 0;
    const auto g = disk_map_by_vertex_source(source, &factorizations);
    ASSERT_TRUE(g);
    const auto& rim = source.topology.boundary_loops[0];
    double least = 1, turned = 0;
    for (std::size_t i = 0; i < rim.size(); ++i) {
        const Complex a = (*g)[rim[i]], b = (*g)[rim[(i + 1) % rim.size()]];
        const double step = std::imag(b * std::conj(a));
        EXPECT_GE(step, 0);
        least = std::min(least, std::abs(b - a));
        turned += std::arg(b / a);
    }
    EXPECT_NEAR(turned, 2 * std::numbers::pi, 1e-9);
    EXPECT_LT(least, 1e-8);
    const Chart chart = make_chart(source, *g, false);
    EXPECT_LT(unseen_part(source, chart), 1e-4);
}

TEST(VertexSource, ASurfaceWithoutInnerVerticesHasNone) {
    Mesh mesh;
    mesh.positions.resize(4, 2);
    mesh.positions << 0, 0, 1, 0, 1, 1, 0, 1;
    mesh.faces.add({0, 1, 2});
    mesh.faces.add({0, 2, 3});
    int factorizations = 0;
    EXPECT_FALSE(disk_map_by_vertex_source(Surface(std::move(mesh)), &factorizations));
}

}  // namespace
}  // namespace beltrami
