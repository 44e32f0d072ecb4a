#include <gtest/gtest.h>

#include <algorithm>

#include <beltrami/base/error.h>
#include <beltrami/mesh/submesh.h>
#include <beltrami/meshing/fill_holes.h>
#include <beltrami/meshing/planar_domains.h>
#include <beltrami/meshing/polygon_fill.h>
#include <beltrami/plane/polygon.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

Mesh without_faces(const Mesh& mesh, const std::vector<int>& removed) {
    std::vector<int> kept;
    for (int f = 0; f < mesh.face_count(); ++f)
        if (std::find(removed.begin(), removed.end(), f) == removed.end()) kept.push_back(f);
    return keep_faces(mesh, kept).mesh;
}

Mesh lifted(Mesh mesh) {
    Positions points(mesh.vertex_count(), 3);
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        const double x = mesh.positions(v, 0), y = mesh.positions(v, 1);
        points.row(v) << x, y, 0.4 * std::sin(3 * x) * std::cos(2 * y);
    }
    mesh.positions = points;
    return mesh;
}

/// What holds for every fill: the source's part is untouched, one loop is left, both sides of an edge have one length.
Surface check_fill(const Surface& source, const FilledSurface& filled, int outer_loop) {
    EXPECT_EQ(filled.mesh.positions.topLeftCorner(source.mesh.vertex_count(), source.mesh.positions.cols()),
              source.mesh.positions);
    for (int f = 0; f < source.mesh.face_count(); ++f)
        EXPECT_TRUE(std::ranges::equal(filled.mesh.faces[f], source.mesh.faces[f]));
    Surface surface = filled.metric ? Surface(filled.mesh, *filled.metric) : Surface(filled.mesh);
    EXPECT_EQ(surface.topology.boundary_loops.size(), 1u);
    EXPECT_EQ(surface.topology.genus, 0);
    EXPECT_EQ(surface.topology.components, 1);
    EXPECT_EQ(surface.topology.boundary_loops[0], source.topology.boundary_loops[outer_loop]);
    const Positions corners = filled.metric ? *filled.metric : corner_positions(filled.mesh);
    std::vector<double> length(surface.topology.edge_count(), -1);
    for (int f = 0; f < filled.mesh.face_count(); ++f)
        for (int first = filled.mesh.faces.first_corner(f), n = filled.mesh.faces.degree(f), j = 0; j < n; ++j) {
            const double l = (corners.row(first + (j + 1) % n) - corners.row(first + j)).norm();
            double& other = length[surface.topology.corner_edges[first + j]];
            EXPECT_NEAR(l, other >= 0 ? other : l, 1e-12 * (1 + l));
            other = l;
        }
    int next_vertex = source.mesh.vertex_count(), next_face = source.mesh.face_count();
    EXPECT_EQ(filled.fills.size() + 1, source.topology.boundary_loops.size());
    for (const HoleFill& fill : filled.fills) {
        EXPECT_EQ(fill.first_vertex, next_vertex);
        EXPECT_EQ(fill.first_face, next_face);
        next_vertex += fill.vertex_count;
        next_face += fill.face_count;
        // No edge of a fill joins two vertices of the rim but those of the rim.
        for (int f = fill.first_face; f < next_face; ++f) {
            const auto v = filled.mesh.faces[f];
            for (int j = 0; j < 3; ++j) {
                const auto& sides =
                    surface.topology.edge_faces[surface.topology.corner_edges[filled.mesh.faces.first_corner(f) + j]];
                const bool on_rim = v[j] < source.mesh.vertex_count() && v[(j + 1) % 3] < source.mesh.vertex_count();
                EXPECT_TRUE(!on_rim || std::min(sides[0], sides[1]) < source.mesh.face_count());
            }
        }
    }
    EXPECT_EQ(next_vertex, filled.mesh.vertex_count());
    EXPECT_EQ(next_face, filled.mesh.face_count());
    return surface;
}

double loop_area(const Surface& surface, int loop) {
    std::vector<Complex> polygon;
    for (const int v : surface.topology.boundary_loops[loop])
        polygon.emplace_back(surface.mesh.positions(v, 0), surface.mesh.positions(v, 1));
    return signed_area(polygon);
}

TEST(FillHoles, FillsInThePlaneLieInTheHoles) {
    DomainOptions options;
    options.edge_length = 0.1;
    options.hole_edge_length = 0.03;
    const Polygon ell{{0, 0}, {0.5, 0}, {0.5, 0.1}, {0.1, 0.1}, {0.1, 0.4}, {0, 0.4}},
        corner{{-0.6, -0.6}, {-0.5, -0.6}, {-0.6, -0.5}};
    const Polygon outer{{-1, -1}, {1, -1}, {1.2, 0.8}, {-1, 1}};
    Mesh mesh = polygon_domain(outer, {ell, corner}, options);
    for (const double side : {1.0, -1.0}) {  // seen from above and from below
        Mesh turned = mesh;
        turned.positions.col(1) *= side;
        const Surface source(turned);
        const FilledSurface filled = fill_holes(source);
        ASSERT_TRUE(filled.planar);
        const Surface surface = check_fill(source, filled, 0);  // every face has positive area, or this throws
        EXPECT_NEAR(surface.operators.area(), std::abs(loop_area(source, 0)), 1e-12);
    }
}

TEST(FillHoles, ALargePlanarHoleCostsAMultipleOfItsSides) {
    DomainOptions options;
    options.edge_length = 0.05;
    options.hole_edge_length = 0.005;
    const Surface source(circle_domain({}, {{{0.1, 0}, 0.5}}, options));
    const int sides = static_cast<int>(source.topology.boundary_loops[1].size());
    ASSERT_GT(sides, 500);
    const FilledSurface filled = fill_holes(source);
    check_fill(source, filled, 0);
    EXPECT_LT(filled.fills[0].face_count, 8 * sides);
}

TEST(FillHoles, ThreeVerticesAreClosedByOneTriangle) {
    for (const bool in_space : {false, true}) {
        const Mesh flat = without_faces(disk(6), {40});
        const Surface source(in_space ? lifted(flat) : flat);
        const FilledSurface filled = fill_holes(source);
        check_fill(source, filled, 0);
        EXPECT_EQ(filled.fills[0].face_count, 1);
        EXPECT_EQ(filled.fills[0].vertex_count, 0);
    }
}

TEST(FillHoles, HolesInSpaceAnyOfThemLeftOpen) {
    DomainOptions options;
    options.edge_length = 0.1;
    const Surface source(lifted(circle_domain({}, {{{0.4, 0.2}, 0.3}, {{-0.5, 0}, 0.2}, {{0, -0.5}, 0.1}}, options)));
    for (int outer = 0; outer < 4; ++outer) {
        const FilledSurface filled = fill_holes(source, outer);
        EXPECT_FALSE(filled.planar);
        check_fill(source, filled, outer);
        // The harmonic surface over a loop stays in the box of the source.
        for (int c = 0; c < 3; ++c) {
            EXPECT_LE(filled.mesh.positions.col(c).maxCoeff(), source.mesh.positions.col(c).maxCoeff());
            EXPECT_GE(filled.mesh.positions.col(c).minCoeff(), source.mesh.positions.col(c).minCoeff());
        }
    }
    const FilledSurface two = fill_holes(source, std::vector<int>{0, 2});
    ASSERT_EQ(two.fills.size(), 2u);
    EXPECT_EQ(two.fills[0].loop, 1);
    EXPECT_EQ(two.fills[1].loop, 3);
}

TEST(FillHoles, AMetricOfItsOwnIsContinued) {
    // The shapes of the lifted surface for the flat mesh: same lengths, and not planar any more.
    DomainOptions options;
    options.edge_length = 0.15;
    const Mesh flat = circle_domain({}, {{{0.3, 0}, 0.3}, {{-0.4, 0.2}, 0.2}}, options);
    const Surface source(flat, corner_positions(lifted(flat)));
    check_fill(source, fill_holes(source), 0);
    check_fill(source, fill_holes(source, 2), 2);
}

TEST(FillHoles, QuadsStayQuads) {
    Mesh mesh = test::quad_square(8, 0.1);
    const Surface source(without_faces(mesh, {18, 19, 20, 26, 27, 28, 45}));
    const FilledSurface filled = fill_holes(source);
    check_fill(source, filled, 0);
    EXPECT_EQ(filled.mesh.faces.degree(0), 4);
}

TEST(FillHoles, ALoopWithoutAreaIsClosedByACone) {
    // A slit a, b, c of which a–c is one edge below.
    Mesh mesh;
    mesh.positions.resize(7, 3);
    mesh.positions << -1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 2, 1, 0, -2, 1, -3, 0, 0, 3, 0, 0;
    for (const auto& f : {std::array{0, 4, 2}, {0, 1, 3}, {1, 2, 3}, {5, 4, 0}, {5, 0, 3}, {4, 6, 2}, {6, 3, 2}})
        mesh.faces.add({f[0], f[1], f[2]});
    const Surface source(mesh);
    ASSERT_EQ(source.topology.boundary_loops.size(), 2u);
    const FilledSurface filled = fill_holes(source);
    check_fill(source, filled, 0);
    EXPECT_EQ(filled.fills[0].face_count, 3);
}

TEST(FillHoles, RefusesALoopThatIsNotThere) {
    const Surface source(annulus(0.3, 1, 20));
    EXPECT_THROW(fill_holes(source, 2), Error);
    EXPECT_THROW(fill_holes(source, -1), Error);
}

TEST(CyclicPolygon, HasTheSidesAndACircle) {
    const std::vector<double> lengths{1, 0.3, 0.7, 0.9, 0.2};
    const auto corners = cyclic_polygon(lengths);
    ASSERT_EQ(corners.size(), 5u);
    for (int i = 0; i < 5; ++i) {
        EXPECT_NEAR(std::abs(corners[(i + 1) % 5] - corners[i]), lengths[i], 1e-14);
        EXPECT_NEAR(std::abs(corners[i]), std::abs(corners[0]), 1e-15);
    }
    EXPECT_TRUE(cyclic_polygon({1, 0.4, 0.4, 0.4}).empty());  // the centre would lie outside
    EXPECT_TRUE(cyclic_polygon({1, 0.2, 0.3}).empty());       // does not close
}

}  // namespace
}  // namespace beltrami
