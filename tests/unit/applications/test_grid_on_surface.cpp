#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include <beltrami/applications/grid_on_surface.h>
#include <beltrami/base/constants.h>
#include <beltrami/base/error.h>
#include <beltrami/charts/boundary_values.h>
#include <beltrami/charts/round_disk.h>
#include <beltrami/io/read_mesh.h>
#include <beltrami/mesh/diagnosis.h>
#include <beltrami/meshing/planar_domains.h>

#include "support/meshes.h"
#include "support/real_mesh.h"

namespace beltrami {
namespace {

double area_of(const Mesh& mesh) {
    double area = 0;
    for (int f = 0; f < mesh.face_count(); ++f) area += face_vector_area(mesh, f).norm();
    return area;
}

/// What holds for every grid: a manifold, nothing folded, every vertex where its parent's image is.
void expect_sound(const SurfaceGrid& grid, const Surface& source, const Eigen::VectorXcd& map) {
    EXPECT_NO_THROW(require_sound(grid.mesh));
    EXPECT_TRUE(grid.quality.folded.empty());
    ASSERT_EQ(grid.parents.size(), static_cast<std::size_t>(grid.mesh.vertex_count()));
    ASSERT_EQ(grid.cells.size(), static_cast<std::size_t>(grid.mesh.face_count()));
    const double size = map.cwiseAbs().maxCoeff();
    for (int v = 0; v < grid.mesh.vertex_count(); ++v) {
        EXPECT_LT(std::abs(grid.parents[v].interpolate(map) - grid.parameter[v]), 1e-11 * size);
        Eigen::RowVectorXd place = Eigen::RowVectorXd::Zero(source.mesh.positions.cols());
        for (int k = 0; k < 3; ++k) {
            EXPECT_GE(grid.parents[v].barycentric[k], -1e-11);
            place += grid.parents[v].barycentric[k] * source.mesh.positions.row(grid.parents[v].vertices[k]);
        }
        EXPECT_LT((place - grid.mesh.positions.row(v)).norm(), 1e-14 * size);
    }
    for (int f = 0; f < grid.mesh.face_count(); ++f) {
        EXPECT_LE(grid.mesh.faces[f].size(), 4u);
        double area = 0;  // in the plane
        const auto v = grid.mesh.faces[f];
        for (std::size_t k = 0; k < v.size(); ++k)
            area += std::imag(std::conj(grid.parameter[v[k]]) * grid.parameter[v[(k + 1) % v.size()]]) / 2;
        EXPECT_GT(area, 0);
    }
}

TEST(GridOnSurface, FillsARectangleExactly) {
    const Surface source(polygon_domain({{0, 0}, {2, 0}, {2, 1}, {0, 1}}));
    const Eigen::VectorXcd map = test::complex_positions(source.mesh);
    for (const auto border : {GridOptions::Border::trimmed, GridOptions::Border::stepped}) {
        const SurfaceGrid grid = grid_on_surface(source, map, RectangularGrid{.spacing = 0.1}, {.border = border});
        expect_sound(grid, source, map);
        EXPECT_EQ(grid.whole_cells, 200);
        EXPECT_EQ(grid.trimmed_cells, 0);
        EXPECT_EQ(grid.omitted_cells, 0);
        EXPECT_EQ(grid.mesh.vertex_count(), 21 * 11);
        EXPECT_NEAR(grid.quality.min_angle, kPi / 2, 1e-12);
        EXPECT_NEAR(grid.quality.max_angle, kPi / 2, 1e-12);
        EXPECT_NEAR(grid.quality.mean_skew, 0, 1e-12);
        EXPECT_NEAR(grid.quality.max_aspect, 1, 1e-12);
        EXPECT_NEAR(grid.quality.area_ratio, 1, 1e-12);
        EXPECT_EQ(std::count(grid.on_border.begin(), grid.on_border.end(), 1), 60);
        EXPECT_EQ(grid.cells.front(), (std::array{0, 0}));
        EXPECT_EQ(grid.cells.back(), (std::array{19, 9}));
    }
}

TEST(GridOnSurface, TrimmedCellsCoverTheDomain) {
    DomainOptions fine{.edge_length = 0.02};
    const Surface source(circle_domain({{0, 0}, 1}, {{{0.4, 0.1}, 0.2}, {{-0.4, -0.2}, 0.25}}, fine));
    const Eigen::VectorXcd map = test::complex_positions(source.mesh);
    const double whole = area_of(source.mesh);
    double last = 0;
    for (const double spacing : {0.1, 0.05, 0.025}) {
        const RectangularGrid lines{.spacing = spacing, .origin = {0.013, 0.007}, .angle = 0.3};
        const SurfaceGrid grid = grid_on_surface(source, map, lines);
        expect_sound(grid, source, map);
        EXPECT_GT(grid.trimmed_cells, 0);
        EXPECT_EQ(grid.omitted_cells, 0);
        EXPECT_GT(grid.quality.min_angle, 0.15);
        const Topology topo = topology(grid.mesh);
        EXPECT_EQ(topo.boundary_loops.size(), 3u);
        EXPECT_EQ(topo.components, 1);
        const double missing = std::abs(area_of(grid.mesh) - whole);
        EXPECT_LT(missing, 0.7 * spacing * spacing);
        const SurfaceGrid steps = grid_on_surface(source, map, lines, {.border = GridOptions::Border::stepped});
        expect_sound(steps, source, map);
        EXPECT_EQ(steps.whole_cells, grid.whole_cells);
        for (int f = 0; f < steps.mesh.face_count(); ++f) EXPECT_EQ(steps.mesh.faces[f].size(), 4u);
        if (last > 0) {
            EXPECT_LT(missing, 0.5 * last);
        }
        last = missing;
    }
}

TEST(GridOnSurface, CirclesOfAnAnnulusAreKept) {
    const Surface source(annulus(0.3, 1, 96));
    const Eigen::VectorXcd map = test::complex_positions(source.mesh);
    const SurfaceGrid grid =
        grid_on_surface(source, map, LogPolarGrid{.inner_radius = 0.3, .outer_radius = 1, .sectors = 36});
    expect_sound(grid, source, map);
    // log(1/.3)·36/2π = 6.898…: 7 rings.
    EXPECT_EQ(grid.whole_cells, 7 * 36);
    EXPECT_EQ(grid.trimmed_cells, 0);
    EXPECT_EQ(grid.mesh.vertex_count(), 8 * 36);
    const double factor = std::pow(1 / 0.3, 1.0 / 7);
    EXPECT_NEAR(grid.quality.area_ratio, std::pow(factor, 12), 0.25);
    EXPECT_LT(grid.quality.max_aspect, 1.25);
    EXPECT_EQ(topology(grid.mesh).euler_characteristic, 0);
    const auto inside = [&] { grid_on_surface(source, map, LogPolarGrid{.centre = 0.5, .inner_radius = 0.1}); };
    EXPECT_THROW(inside(), Error);
}

TEST(GridOnSurface, PolarGridHasTrianglesAtItsCentre) {
    const Surface source(disk(24));
    const Eigen::VectorXcd map = test::complex_positions(source.mesh);
    const SurfaceGrid grid = grid_on_surface(source, map, PolarGrid{.spacing = 0.125, .sectors = 24});
    expect_sound(grid, source, map);
    EXPECT_EQ(grid.mesh.vertex_count(), 1 + 8 * 24);
    EXPECT_EQ(grid.whole_cells, 8 * 24);
    int triangles = 0;
    for (int f = 0; f < grid.mesh.face_count(); ++f) triangles += grid.mesh.faces[f].size() == 3;
    EXPECT_EQ(triangles, 24);
    EXPECT_NEAR(grid.quality.mean_skew, kPi / 24, 1e-3) << "chords against the rays; triangles do not count";
    // Around another centre, the circles are cut.
    const SurfaceGrid other = grid_on_surface(source, map, PolarGrid{.centre = {0.7, 0.4}, .spacing = 0.07});
    expect_sound(other, source, map);
    EXPECT_GT(other.trimmed_cells, 10);
    EXPECT_EQ(topology(other.mesh).euler_characteristic, 1);
}

/// A half sphere with its stereographic image, the unit disk.
std::pair<Surface, Eigen::VectorXcd> half_sphere(int rings) {
    Mesh mesh = disk(rings);
    const Eigen::VectorXcd map = test::complex_positions(mesh);
    mesh.positions.resize(map.size(), 3);
    for (int v = 0; v < map.size(); ++v) {
        const double r = std::norm(map[v]);
        mesh.positions.row(v) << 2 * map[v].real() / (1 + r), 2 * map[v].imag() / (1 + r), (r - 1) / (1 + r);
    }
    return {Surface(mesh), map};
}

TEST(GridOnSurface, ConformalGridOnASphereIsNearlySquare) {
    double last = 0;
    for (const int rings : {16, 32, 64}) {
        const auto [source, map] = half_sphere(rings);
        const SurfaceGrid grid = grid_on_surface(source, map, RectangularGrid{.spacing = 1.6 / rings},
                                                 {.border = GridOptions::Border::stepped, .snap = 0});
        expect_sound(grid, source, map);
        double off = 0;  // of the sphere
        for (int v = 0; v < grid.mesh.vertex_count(); ++v) off = std::max(off, 1 - grid.mesh.point(v).norm());
        EXPECT_LT(off, 1.0 / (rings * rings));
        const double skew = std::max(grid.quality.max_angle - kPi / 2, kPi / 2 - grid.quality.min_angle);
        if (last > 0) {
            EXPECT_LT(skew, 0.75 * last);
        }
        last = skew;
    }
    EXPECT_LT(last, 0.15);
    const auto [source, map] = half_sphere(48);
    const SurfaceGrid trimmed = grid_on_surface(source, map, RectangularGrid{.spacing = 0.07});
    expect_sound(trimmed, source, map);
    EXPECT_NEAR(area_of(trimmed.mesh), 2 * kPi, 0.02);
}

TEST(GridOnSurface, MovesWithTheImage) {
    const auto [source, map] = half_sphere(24);
    const Complex turn = std::polar(1e3, 0.8), shift(2e3, -5e3);
    const Eigen::VectorXcd moved = (turn * map).array() + shift;
    const SurfaceGrid a = grid_on_surface(source, map, RectangularGrid{.spacing = 0.09, .origin = {0.01, 0.02}});
    const SurfaceGrid b = grid_on_surface(
        source, moved, RectangularGrid{.spacing = 90, .origin = turn * Complex(0.01, 0.02) + shift, .angle = 0.8});
    ASSERT_TRUE(a.mesh.faces == b.mesh.faces);
    EXPECT_LT((a.mesh.positions - b.mesh.positions).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(GridOnSurface, QuadsAndMeshesSeenFromBelow) {
    const Surface quads(test::square(12, 0.2, [](int, int) { return true; }));
    const Eigen::VectorXcd map = test::complex_positions(quads.mesh);
    const SurfaceGrid grid = grid_on_surface(quads, map, RectangularGrid{.spacing = 1.0 / 7});
    expect_sound(grid, quads, map);
    EXPECT_EQ(grid.whole_cells, 49);
    Mesh below = quads.mesh;
    below.positions.col(1) *= -1;
    const Surface mirrored(below);
    const SurfaceGrid same = grid_on_surface(mirrored, map, RectangularGrid{.spacing = 1.0 / 7});
    expect_sound(same, mirrored, map);
    EXPECT_TRUE(same.mesh.faces == grid.mesh.faces);
}

TEST(GridOnSurface, HolesSmallerThanACellAreLeftOut) {
    DomainOptions fine{.edge_length = 0.05};
    const Surface source(circle_domain({{0, 0}, 1}, {{{0.25, 0.25}, 0.03}}, fine));
    const Eigen::VectorXcd map = test::complex_positions(source.mesh);
    const SurfaceGrid grid = grid_on_surface(source, map, RectangularGrid{.spacing = 0.5 / 3});
    expect_sound(grid, source, map);
    EXPECT_EQ(grid.omitted_cells, 1);
    EXPECT_EQ(topology(grid.mesh).boundary_loops.size(), 2u);
}

TEST(GridOnSurface, RefusesFoldsAndImpossibleGrids) {
    const Surface source(disk(8));
    Eigen::VectorXcd map = test::complex_positions(source.mesh);
    const auto cause = [&](const PlaneGrid& grid, GridOptions options = {}) {
        try {
            grid_on_surface(source, map, grid, options);
        } catch (const Error& error) {
            return error.cause();
        }
        return Cause::cancelled;
    };
    EXPECT_EQ(cause(RectangularGrid{.spacing = 0}), Cause::bad_option);
    EXPECT_EQ(cause(RectangularGrid{.spacing = std::nan("")}), Cause::bad_option);
    EXPECT_EQ(cause(RectangularGrid{.spacing = 1e-6}), Cause::bad_option);
    EXPECT_EQ(cause(RectangularGrid{.spacing = 0.1, .origin = {1e300, 0}}), Cause::bad_option);
    EXPECT_EQ(cause(RectangularGrid{.spacing = 100, .origin = {50, 50}}), Cause::bad_option) << "no cell inside";
    EXPECT_EQ(cause(PolarGrid{.sectors = 2}), Cause::bad_option);
    EXPECT_EQ(cause(LogPolarGrid{.inner_radius = 2, .outer_radius = 1}), Cause::bad_option);
    EXPECT_EQ(cause(LogPolarGrid{.centre = 0}), Cause::bad_option);
    EXPECT_EQ(cause(RectangularGrid{}, {.snap = 0.5}), Cause::bad_option);
    map[0] = {3, 0};
    EXPECT_EQ(cause(RectangularGrid{}), Cause::bad_mesh);
    map = map.conjugate().eval();
    EXPECT_EQ(cause(RectangularGrid{}), Cause::bad_mesh);
    map.conservativeResize(3);
    EXPECT_EQ(cause(RectangularGrid{}), Cause::bad_option);
}

TEST(GridOnSurface, RealScan) {
    const std::filesystem::path path = test::real_mesh("human_face.obj");
    if (path.empty()) GTEST_SKIP() << "no human_face.obj in BELTRAMI_TEST_MESHES";
    const Surface face(read_mesh(path).mesh);
    const Eigen::VectorXcd map = round_disk_chart(face).vertices;
    const SurfaceGrid coarse = grid_on_surface(face, map, RectangularGrid{.spacing = 0.05});
    EXPECT_NO_THROW(require_sound(coarse.mesh));
    EXPECT_GT(coarse.whole_cells, 1000);
    EXPECT_TRUE(coarse.quality.folded.empty());
    EXPECT_GT(coarse.quality.min_angle, 0.2);
    // The scan is rough: the finer the grid, the more of the relief it follows, and few cells turn over on its creases.
    const SurfaceGrid fine = grid_on_surface(face, map, RectangularGrid{.spacing = 0.0125});
    EXPECT_NO_THROW(require_sound(fine.mesh));
    EXPECT_LT(fine.quality.folded.size(), 1e-3 * fine.mesh.face_count());
    const double area = area_of(face.mesh);
    EXPECT_LT(area_of(coarse.mesh), area);
    EXPECT_LT(area - area_of(fine.mesh), 0.5 * (area - area_of(coarse.mesh)));
}

}  // namespace
}  // namespace beltrami
