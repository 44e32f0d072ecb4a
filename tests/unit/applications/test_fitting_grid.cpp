#include <gtest/gtest.h>

#include <cmath>

#include <beltrami/applications/fitting_grid.h>
#include <beltrami/applications/grid_on_surface.h>
#include <beltrami/applications/reached_corners.h>
#include <beltrami/base/constants.h>
#include <beltrami/base/error.h>
#include <beltrami/generate/round_domains.h>
#include <beltrami/targets/target_mesh.h>
#include <beltrami/teichmuller/extremal_map.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

TargetDomain polygon(const std::vector<Complex>& corners) {
    return target_domain(TargetCurve::polygon(corners));
}

/// The grid on a mesh of the domain itself.
SurfaceGrid filled(const TargetDomain& domain, int cells, GridLines lines = GridLines::automatic) {
    const Surface surface(target_mesh(domain).mesh);
    return grid_on_surface(surface, test::complex_positions(surface.mesh), fitting_grid(domain, cells, lines),
                           {.border = GridOptions::Border::stepped});
}

TEST(FittingGrid, FillsRectanglesHoweverTheyAreTurned) {
    for (const double angle : {0.0, 0.3, 2.0, -1.2}) {
        const Complex turn = std::polar(2.0, angle), at(3, -1);
        const TargetDomain domain =
            polygon({at, at + 1.7 * turn, at + turn * Complex(1.7, 1), at + turn * Complex(0, 1)});
        const SurfaceGrid grid = filled(domain, 17);
        EXPECT_EQ(grid.mesh.face_count(), 170);
        EXPECT_EQ(grid.omitted_cells + grid.trimmed_cells, 0);
        EXPECT_NEAR(grid.quality.mean_skew, 0, 1e-9);
        EXPECT_NEAR(grid.quality.max_aspect, 1, 1e-9);
    }
    // The longer side decides, and no direction is left without a cell.
    const auto tall = std::get<RectangularGrid>(fitting_grid(polygon({0, 1, {1, 4}, {0, 4}}), 2));
    EXPECT_NEAR(tall.spacing, 1, 1e-12);
    EXPECT_NEAR(tall.spacing_up, 2, 1e-12);
}

TEST(FittingGrid, OtherOutlinesGetTheirBox) {
    const auto disk = std::get<RectangularGrid>(fitting_grid(target_domain(TargetCurve::circle({1, 2}, 3)), 6));
    EXPECT_NEAR(std::abs(disk.origin - Complex(-2, -1)), 0, 1e-12);
    EXPECT_NEAR(disk.spacing, 1, 1e-12);
    EXPECT_EQ(disk.angle, 0);
    // A parallelogram is no rectangle.
    const auto slanted = std::get<RectangularGrid>(fitting_grid(polygon({0, 2, {3, 1}, {1, 1}}), 3));
    EXPECT_EQ(slanted.angle, 0);
    EXPECT_NEAR(slanted.spacing, 1, 1e-12);
}

TEST(FittingGrid, RingsGetTheirCircles) {
    const TargetDomain ring = target_domain(TargetCurve::circle({1, 2}, 3), {TargetCurve::circle({1, 2}, 1)});
    const SurfaceGrid grid = filled(ring, 30);
    const int rows = static_cast<int>(std::round(30 * std::log(3.0) / (2 * kPi)));
    EXPECT_EQ(grid.mesh.face_count(), 30 * rows);
    EXPECT_EQ(lines_of(fitting_grid(ring, 30)), GridLines::log_polar);
    EXPECT_EQ(lines_of(fitting_grid(ring, 30, GridLines::rectangular)), GridLines::rectangular);
    const TargetDomain aside = target_domain(TargetCurve::circle(0, 3), {TargetCurve::circle(0.5, 1)});
    EXPECT_EQ(lines_of(fitting_grid(aside, 30)), GridLines::rectangular);
    EXPECT_EQ(std::get<LogPolarGrid>(fitting_grid(aside, 30, GridLines::log_polar)).inner_radius, 3);
    const auto polar =
        std::get<PolarGrid>(fitting_grid(target_domain(TargetCurve::circle(0, 2)), 44, GridLines::polar));
    EXPECT_NEAR(polar.spacing, 2.0 / 7, 1e-12);
}

TEST(FittingGrid, RefusesWhatDoesNotFit) {
    const TargetDomain square = polygon({0, 1, {1, 1}, {0, 1}}), disk = target_domain(TargetCurve::circle(0, 1));
    EXPECT_THROW(fitting_grid(square, 0), Error);
    EXPECT_THROW(fitting_grid(square, 20, GridLines::polar), Error);
    EXPECT_THROW(fitting_grid(square, 20, GridLines::log_polar), Error);
    EXPECT_THROW(fitting_grid(disk, 20, GridLines::log_polar), Error);
    EXPECT_THROW(fitting_grid(disk, 2, GridLines::polar), Error);
}

TEST(ReachedCorners, TheImageHasTheCornersOfItsTarget) {
    const Surface round(disk(12));
    const TargetDomain square = polygon({0, 1, {1, 1}, {0, 1}});
    ExtremalMap onto = extremal_map(round, square);
    const Surface mapped = onto.split ? surface_of(onto.split->mesh, onto.split->metric) : round;
    const auto image_area = [&](const Eigen::VectorXcd& map) {
        double area = 0;
        const auto& loop = mapped.topology.boundary_loops[0];
        for (std::size_t i = 0; i < loop.size(); ++i)
            area += std::imag(std::conj(map[loop[i]]) * map[loop[(i + 1) % loop.size()]]) / 2;
        return area;
    };
    EXPECT_LT(image_area(onto.map), 1 - 1e-4);
    Eigen::VectorXcd map = onto.map;
    EXPECT_EQ(reach_corners(mapped, square, onto.loops, {}, map), 4);
    EXPECT_NEAR(image_area(map), 1, 1e-12);
    EXPECT_TRUE(distortion(mapped.operators, map).flipped.empty());
    EXPECT_EQ(((map - onto.map).array() != 0.0).count(), 4) << "others stay";
    // A marked vertex stays where it is.
    int first = 0;
    while (map[first] == onto.map[first]) ++first;
    const std::vector<Mark> marks{{first, 0, 0}};
    Eigen::VectorXcd held = onto.map;
    EXPECT_EQ(reach_corners(mapped, square, onto.loops, marks, held), 3);
    EXPECT_EQ(held[first], onto.map[first]);
}

}  // namespace
}  // namespace beltrami
