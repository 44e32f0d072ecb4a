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
