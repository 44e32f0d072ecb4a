#include <beltrami/base/constants.h>
#include <beltrami/teichmuller/boundary_slack.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include <beltrami/base/error.h>
#include <beltrami/charts/boundary_values.h>
#include <beltrami/charts/round_disk.h>
#include <beltrami/generate/sphere.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/teichmuller/extremal_map.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

/// The round disk, which is its own chart.
struct Disk {
    Surface source;
    Chart chart;
    explicit Disk(int rings) : source(disk(rings)), chart(round_disk_chart(source)) {}
    const std::vector<int>& rim() const { return source.topology.boundary_loops[0]; }
    /// The rim's angles t of equal edges go to e^{i t(θ)}.
    template <class Map>
    BoundaryCondition values(Map&& image) const {
        BoundaryCondition boundary;
        for (std::size_t i = 0; i < rim().size(); ++i)
            boundary.pin(rim()[i], image(2 * kPi * static_cast<double>(i) / static_cast<double>(rim().size()),
                                         static_cast<int>(i)));
        return boundary;
    }
};

Complex on_circle(double angle) {
    return std::polar(1.0, angle);
}

TEST(BoundarySlack, EnergyIsTheHalfNorm) {
    const Disk disk(80);
    // u = log dt/dθ ≈ ε cos mθ has E = π² m ε².
    for (const int m : {1, 3, 8}) {
        const double epsilon = 0.01;
        const BoundaryCondition boundary =
            disk.values([&](double t, int) { return on_circle(t + epsilon / m * std::sin(m * t)); });
        const SlackBoundary result = slacken(disk.source, disk.chart, boundary, 0.01);
        EXPECT_NEAR(result.energy_before / (kPi * kPi * m * epsilon * epsilon), 1, 0.03) << m;
        EXPECT_LT(result.energy_after, result.energy_before);
    }
}

/// Noise of a fifth of an edge goes; points stay on the circle, in their order, within their slack.
TEST(BoundarySlack, PlantedNoiseIsTakenOut) {
    const Disk disk(21);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> noise(-0.2, 0.2);
    const double edge = 2 * kPi / static_cast<double>(disk.rim().size());
    const auto smooth = [](double t) { return t + 0.3 * std::sin(t); };
    const BoundaryCondition clean = disk.values([&](double t, int) { return on_circle(smooth(t)); });
    const BoundaryCondition noisy =
        disk.values([&](double t, int) { return on_circle(smooth(t + edge * noise(random))); });
    const double before = slacken(disk.source, disk.chart, clean, 0.01).energy_before;
    const SlackBoundary result = slacken(disk.source, disk.chart, noisy, 0.25);
    EXPECT_GT(energy_of_blocks(disk.source, disk.chart, clean), 0.95);
    EXPECT_LT(energy_of_blocks(disk.source, disk.chart, noisy), 0.3);
    EXPECT_GT(energy_of_blocks(disk.source, disk.chart, result.boundary), 0.9);
    EXPECT_GT(result.energy_before, 5 * before);
    EXPECT_LT(result.energy_after, 1.05 * before);
    EXPECT_LE(result.largest_move, 0.25 * (1 + 1e-6));
    double turned = 0;
    for (std::size_t i = 0; i < disk.rim().size(); ++i) {
        const Complex image = result.boundary.images[i], next = result.boundary.images[(i + 1) % disk.rim().size()];
        EXPECT_NEAR(std::abs(image), 1, 1e-12);
        EXPECT_GT(std::arg(next / image), 0);
        turned += std::arg(next / image);
    }
    EXPECT_NEAR(turned, 2 * kPi, 1e-9);
}

TEST(BoundarySlack, MoreSlackLeavesLessEnergy) {
    const Disk disk(12);
    const BoundaryCondition boundary =
        disk.values([](double t, int i) { return on_circle(t + 0.4 * std::sin(t) + (i % 2 ? 0.01 : -0.01)); });
    double last = std::numeric_limits<double>::infinity();
    for (const double slack : {0.1, 0.25, 0.5, 1.0, 2.0}) {
        const SlackBoundary result = slacken(disk.source, disk.chart, boundary, slack);
        EXPECT_LT(result.energy_after, last);
        EXPECT_LE(result.largest_move, slack * (1 + 1e-6));
        last = result.energy_after;
    }
}

TEST(BoundarySlack, CornersOfAPolygonStayWhereTheyAre) {
    const Surface source(test::bump(2'000));
    const Chart chart = round_disk_chart(source);
    const BoundaryCondition boundary = boundary_to_rectangle(source, 2, 1, std::nullopt);
    const SlackBoundary result = slacken(source, chart, boundary, 0.5);
    int corners = 0, moved = 0;
    for (std::size_t i = 0; i < boundary.images.size(); ++i) {
        const Complex z = boundary.images[i], w = result.boundary.images[i];
        const auto on_side = [](Complex p) {
            return std::min({std::abs(p.real()), std::abs(p.real() - 2), std::abs(p.imag()), std::abs(p.imag() - 1)});
        };
        EXPECT_LT(on_side(w), 1e-12);
        moved += z != w;
        if ((z.real() == 0 || z.real() == 2) && (z.imag() == 0 || z.imag() == 1)) {
            ++corners;
            EXPECT_EQ(z, w);
        }
    }
    EXPECT_EQ(corners, 4);
    EXPECT_GT(moved, 10);
}

/// A tooth that the chart turns back costs no more than itself.
TEST(BoundarySlack, AnEdgeThatRunsBackwardsIsTakenFromItsNeighbours) {
    Disk disk(21);
    const BoundaryCondition boundary = disk.values([](double t, int) { return on_circle(t + 0.2 * std::sin(t)); });
    std::swap(disk.chart.vertices[disk.rim()[5]], disk.chart.vertices[disk.rim()[6]]);
    const SlackBoundary found = slacken(disk.source, disk.chart, boundary, 0.5);
    EXPECT_LE(found.energy_after, found.energy_before);
    EXPECT_LE(found.largest_move, 0.5 * (1 + 1e-6));
    // All stay in their order.
    double before = -1;
    for (const Complex image : found.boundary.images) {
        const double angle = std::arg(image / found.boundary.images[0]);
        const double turn = angle < -1e-9 ? angle + 2 * kPi : angle;
        EXPECT_GT(turn, before);
        before = turn;
    }
}

TEST(BoundarySlack, ChartThatRunsBackwardsIsRefused) {
    const Disk disk(4);
    Chart chart = disk.chart;
    for (const std::size_t i : {3, 9, 15}) std::swap(chart.vertices[disk.rim()[i]], chart.vertices[disk.rim()[i + 1]]);
    const BoundaryCondition boundary = disk.values([](double t, int) { return on_circle(t); });
    EXPECT_THROW(slacken(disk.source, chart, boundary, 0.5), Error);
}

/// With slack the extremal map of noisy values has nearly the K of the clean ones; without, its price is told.
TEST(BoundarySlack, ExtremalMapSaysWhatNoiseCosts) {
    Mesh mesh = test::bump(4'000);
    const Surface source(std::move(mesh));
    const Chart chart = round_disk_chart(source);
    const auto& rim = source.topology.boundary_loops[0];
    std::mt19937 random(5);
    std::uniform_real_distribution<double> noise(-0.2, 0.2);
    BoundaryCondition clean, noisy;
    for (std::size_t i = 0; i < rim.size(); ++i) {
        const double t = std::arg(chart.vertices[rim[i]]), edge = 2 * kPi / static_cast<double>(rim.size());
        const double moved = t + edge * noise(random);
        clean.pin(rim[i], on_circle(t + 0.15 * std::sin(t)));
        noisy.pin(rim[i], on_circle(moved + 0.15 * std::sin(moved)));
    }
    ExtremalOptions in_plane;
    in_plane.chart_metric = true;
    const ExtremalMap smooth = extremal_map(source, clean, in_plane), rough = extremal_map(source, noisy, in_plane);
    EXPECT_FALSE(smooth.noise);
    ASSERT_TRUE(rough.noise);
    EXPECT_LT(rough.noise->energy_ratio, 0.6);
    EXPECT_GT(rough.K - 1, 1.2 * (smooth.K - 1));
    ExtremalOptions options;
    options.slack = 0.5;
    const ExtremalMap slack = extremal_map(source, noisy, options);
    ASSERT_TRUE(slack.slack);
    EXPECT_LE(slack.slack->largest_move, 0.5 * (1 + 1e-6));
    EXPECT_LT(slack.K - 1, 1.1 * (smooth.K - 1));
    EXPECT_NEAR(slack.slack->K_without, rough.K, 0.01 * rough.K);
    EXPECT_NEAR(rough.noise->K, slack.K, 0.01 * slack.K);
}

/// A sphere without the faces around a vertex: on its rim of few edges every vertex turns the image as corners do. With
/// enough slack the boundary values are the chart's own, and the map is conformal.
TEST(BoundarySlack, OfASmallOpeningLeavesTheChartItself) {
    const Mesh sphere = icosahedral_sphere(4);
    Mesh open{sphere.positions, {}, {}};
    for (int f = 0; f < sphere.face_count(); ++f)
        if (std::ranges::find(sphere.faces[f], 700) == sphere.faces[f].end()) open.faces.add(sphere.faces[f]);
    const Surface source(std::move(open));
    ASSERT_LE(source.topology.boundary_loops[0].size(), 6U);
    ExtremalOptions options;
    options.slack = 1;
    const BoundaryCondition boundary = boundary_to_disk(source, 0.5);
    const ExtremalMap loose = extremal_map(source, boundary, options), tight = extremal_map(source, boundary);
    ASSERT_TRUE(loose.slack);
    EXPECT_LT(loose.slack->energy_after, 1e-6 * loose.slack->energy_before);
    EXPECT_TRUE(loose.one_to_one());
    const Distortion of_chart = distortion(source.operators, round_disk_chart(source).vertices);
    EXPECT_NEAR(loose.distortion.mean, of_chart.mean, 0.02 * of_chart.mean);
    EXPECT_GT(tight.distortion.mean, 2 * loose.distortion.mean);
}

/// Edges of 1e-13 of the chart beside others: their weights keep their digits.
TEST(BoundarySlack, OfARimThatCrowds) {
    Disk disk(21);
    std::vector<double> angle(disk.rim().size() + 1, 0);
    for (std::size_t i = 0; i < disk.rim().size(); ++i) {
        const double depth = std::min(std::abs(static_cast<double>(i) - 60.0), 30.0) / 30;
        angle[i + 1] = angle[i] + std::pow(1e-13, 1 - depth);
    }
    for (std::size_t i = 0; i < disk.rim().size(); ++i)
        disk.chart.vertices[disk.rim()[i]] = on_circle(2 * kPi * angle[i] / angle.back());
    const BoundaryCondition boundary = disk.values([](double t, int) { return on_circle(t); });
    const SlackBoundary found = slacken(disk.source, disk.chart, boundary, 0.5);
    EXPECT_TRUE(std::isfinite(found.energy_before));
    EXPECT_LT(found.energy_after, found.energy_before);
    EXPECT_LE(found.largest_move, 0.5 * (1 + 1e-6));
}

TEST(BoundarySlack, IsForDisksOnly) {
    const Surface ring(annulus(0.5, 1, 40));
    const BoundaryCondition boundary = test::boundary_values(ring, [](Complex z) { return z; });
    ExtremalOptions options;
    options.slack = 0.5;
    EXPECT_THROW(extremal_map(ring, boundary, options), Error);
    options.slack = -1;
    EXPECT_THROW(options.validate(), Error);
}

}  // namespace
}  // namespace beltrami
