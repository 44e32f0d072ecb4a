#include <beltrami/charts/fold_free_disk.h>

#include <cmath>

#include <gtest/gtest.h>

#include <beltrami/charts/round_disk.h>
#include <beltrami/operators/distortion.h>

#include "support/meshes.h"

namespace beltrami {

namespace {

void expect_round_and_fold_free(const Surface& surface, const FoldFreeDisk& disk) {
    EXPECT_TRUE(disk.fold_free);
    EXPECT_LT(distortion(surface.operators, disk.map).max, 1);
    const auto& loop = surface.topology.boundary_loops[0];
    double turned = 0;
    for (std::size_t i = 0; i < loop.size(); ++i) {
        EXPECT_NEAR(std::abs(disk.map[loop[i]]), 1, 1e-6);
        const double angle = std::arg(disk.map[loop[(i + 1) % loop.size()]] / disk.map[loop[i]]);
        EXPECT_GT(angle, 0);
        turned += angle;
    }
    EXPECT_NEAR(turned, 2 * std::acos(-1.0), 1e-9);
}

}  // namespace

TEST(FoldFreeDisk, AGoodChartStaysAsItIs) {
    const Surface surface(test::jittered_square(8));
    const Chart chart = round_disk_chart(surface);
    const FoldFreeDisk disk = fold_free_disk(surface, chart.vertices);
    EXPECT_FALSE(disk.changed);
    EXPECT_EQ(disk.map, chart.vertices);
    EXPECT_EQ(disk.factorizations, 0);
}

TEST(FoldFreeDisk, FoldsAreOpened) {
    const Surface surface(test::jittered_square(8));
    Eigen::VectorXcd chart = round_disk_chart(surface).vertices;
    for (int v = 0; v < chart.size(); ++v)
        if (!surface.topology.on_boundary[v]) {
            chart[v] += 0.5;
            break;
        }
    const FoldFreeDisk disk = fold_free_disk(surface, chart);
    EXPECT_TRUE(disk.changed);
    EXPECT_TRUE(disk.kept_boundary);
    EXPECT_EQ(disk.moved_boundary, 0);
    expect_round_and_fold_free(surface, disk);
}

TEST(FoldFreeDisk, BoundariesThatRunBackwardsOrNotRound) {
    const Surface surface(test::jittered_square(8));
    const auto& loop = surface.topology.boundary_loops[0];
    const Eigen::VectorXcd good = round_disk_chart(surface).vertices;
    Eigen::VectorXcd backwards = good;
    std::swap(backwards[loop[4]], backwards[loop[5]]);
    const FoldFreeDisk mended = fold_free_disk(surface, backwards);
    EXPECT_EQ(mended.moved_boundary, 1);
    expect_round_and_fold_free(surface, mended);
    for (const Eigen::VectorXcd& chart :
         {Eigen::VectorXcd(good.conjugate()), Eigen::VectorXcd(good.cwiseProduct(good)), Eigen::VectorXcd(0 * good)}) {
        const FoldFreeDisk again = fold_free_disk(surface, chart);
        EXPECT_FALSE(again.kept_boundary);
        if (chart.squaredNorm() > 0) expect_round_and_fold_free(surface, again);
    }
}

/// The chart for differentials: as it is where it is good, else with a rim in order and nothing turned over that
/// counts.
TEST(FoldFreeDisk, ChartsAreOpenedWhereTheyFold) {
    const Surface surface(test::jittered_square(8));
    const auto& loop = surface.topology.boundary_loops[0];
    const Chart good = round_disk_chart(surface);
    EXPECT_EQ(with_folds_opened(surface, good).vertices, good.vertices);
    Eigen::VectorXcd backwards = good.vertices;
    std::swap(backwards[loop[4]], backwards[loop[5]]);
    for (const Eigen::VectorXcd& folded :
         {backwards, Eigen::VectorXcd(0.5 * good.vertices.cwiseProduct(good.vertices))}) {
        const Chart opened = with_folds_opened(surface, make_chart(surface, folded, false));
        double turned = 0;
        for (std::size_t i = 0; i < loop.size(); ++i) {
            EXPECT_NEAR(std::abs(opened.vertices[loop[i]]), 1, 1e-9);
            const double angle = std::arg(opened.vertices[loop[(i + 1) % loop.size()]] / opened.vertices[loop[i]]);
            EXPECT_GT(angle, 0);
            turned += angle;
        }
        EXPECT_NEAR(turned, 2 * std::acos(-1.0), 1e-9);
        EXPECT_TRUE(distortion(surface.operators, opened.vertices).flipped.empty());
        EXPECT_LT(unseen_part(surface, opened), 1e-4);
    }
}

TEST(FoldFreeDisk, NoVertexInside) {
    Mesh mesh;
    mesh.positions.resize(5, 2);
    mesh.positions << 0, 0, 0.5, -1e-6, 1, 0, 0, 1, 1, 1;
    mesh.faces.add({0, 1, 2});
    mesh.faces.add({0, 2, 4});
    mesh.faces.add({0, 4, 3});
    const Surface surface(mesh);
    expect_round_and_fold_free(surface, fold_free_disk(surface, round_disk_chart(surface).vertices));
}

}  // namespace beltrami
