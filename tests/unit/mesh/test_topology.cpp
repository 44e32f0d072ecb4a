#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <numeric>
#include <set>

#include <beltrami/base/error.h>
#include <beltrami/base/random.h>
#include <beltrami/generate/double_torus.h>
#include <beltrami/generate/grids.h>
#include <beltrami/generate/round_domains.h>
#include <beltrami/generate/sphere.h>
#include <beltrami/mesh/topology.h>
#include <beltrami/meshing/planar_domains.h>

namespace beltrami {
namespace {

/// Removes some faces of a mesh, keeping every vertex.
Mesh without_faces(const Mesh& mesh, const std::set<int>& removed) {
    Mesh result = mesh;
    result.faces = {};
    for (int f = 0; f < mesh.face_count(); ++f) {
        if (!removed.contains(f)) result.faces.add(mesh.faces[f]);
    }
    return result;
}

TEST(Topology, SingleTriangle) {
    Mesh mesh;
    mesh.positions.resize(3, 2);
    mesh.positions << 0, 0, 1, 0, 0, 1;
    mesh.faces.add({2, 0, 1});
    const Topology topo = topology(mesh);
    const std::vector<std::array<int, 2>> edges{{0, 1}, {0, 2}, {1, 2}};
    EXPECT_EQ(topo.edges, edges);
    const std::vector<std::array<int, 2>> faces{{0, -1}, {-1, 0}, {0, -1}};  // 2→0 runs against its edge
    EXPECT_EQ(topo.edge_faces, faces);
    EXPECT_EQ(topo.corner_edges, (std::vector<int>{1, 0, 2}));
    EXPECT_EQ(topo.boundary_loops, (std::vector<std::vector<int>>{{0, 1, 2}}));
    EXPECT_NEAR(topo.loop_lengths[0], 2.0 + std::sqrt(2.0), 1e-15);
    EXPECT_EQ(topo.euler_characteristic, 1);
    EXPECT_EQ(topo.components, 1);
    EXPECT_EQ(topo.genus, 0);
}

TEST(Topology, EmptyMesh) {
    const Topology topo = topology(Mesh{});
    EXPECT_EQ(topo.edge_count(), 0);
    EXPECT_EQ(topo.components, 0);
    EXPECT_EQ(topo.genus, 0);
}

TEST(Topology, EdgesKnowTheirFacesAndCorners) {
    for (const Cells cells : {Cells::triangles, Cells::quads}) {
        const Mesh mesh = cylinder(1, 1, 7, 3, cells);
        const Topology topo = topology(mesh);
        EXPECT_TRUE(std::is_sorted(topo.edges.begin(), topo.edges.end()));
        std::vector<int> seen(topo.edge_count(), 0);
        for (int f = 0; f < mesh.face_count(); ++f) {
            const std::span<const int> v = mesh.faces[f];
            for (int i = 0; i < mesh.faces.degree(f); ++i) {
                const int from = v[i], to = v[(i + 1) % v.size()];
                const int e = topo.corner_edges[mesh.faces.first_corner(f) + i];
                EXPECT_EQ(topo.edges[e], (std::array{std::min(from, to), std::max(from, to)}));
                EXPECT_EQ(topo.edge_faces[e][from < to ? 0 : 1], f);
                ++seen[e];
            }
        }
        for (int e = 0; e < topo.edge_count(); ++e) {
            EXPECT_EQ(seen[e], (topo.edge_faces[e][0] >= 0) + (topo.edge_faces[e][1] >= 0));
        }
    }
}

TEST(Topology, LoopsKeepFacesOnTheLeftAndStartAtTheirSmallestVertex) {
    const Mesh mesh = circle_domain({}, {{{0.4, 0.0}, 0.2}, {{-0.4, 0.1}, 0.3}}, {.edge_length = 0.1});
    const Topology topo = topology(mesh);
    ASSERT_EQ(topo.boundary_loops.size(), 3u);
    for (std::size_t k = 0; k < 3; ++k) {
        const std::vector<int>& loop = topo.boundary_loops[k];
        EXPECT_EQ(loop[0], *std::min_element(loop.begin(), loop.end()));
        double twice_area = 0.0, length = 0.0;
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const Eigen::Vector3d a = mesh.point(loop[i]), b = mesh.point(loop[(i + 1) % loop.size()]);
            twice_area += a.x() * b.y() - a.y() * b.x();
            length += (b - a).norm();
            EXPECT_TRUE(topo.on_boundary[loop[i]]);
        }
        EXPECT_EQ(twice_area > 0.0, k == 0);  // the outer loop runs counter-clockwise, holes clockwise
        EXPECT_NEAR(topo.loop_lengths[k], length, 1e-12);
    }
    EXPECT_NEAR(topo.loop_lengths[0], 2.0 * std::numbers::pi, 0.02);
    EXPECT_LT(topo.boundary_loops[1][0], topo.boundary_loops[2][0]);
}

TEST(Topology, OuterLoopInThePlaneEnclosesMostAreaEvenIfAHoleHasALongerBoundary) {
    // The hole is a comb whose outline is much longer than the square.
    Polygon comb;
    for (int i = 0; i < 12; ++i) {
        comb.emplace_back(0.1 + 0.065 * i, 0.1);
        comb.emplace_back(0.1 + 0.065 * i + 0.01, 0.9);
    }
    comb.emplace_back(0.9, 0.05);
    comb.emplace_back(0.1, 0.05);
    const Topology topo = topology(polygon_domain({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {comb}, {.edge_length = 0.2}));
    ASSERT_EQ(topo.boundary_loops.size(), 2u);
    EXPECT_NEAR(topo.loop_lengths[0], 4.0, 1e-12);
    EXPECT_GT(topo.loop_lengths[1], 10.0);
}

TEST(Topology, OuterLoopInSpaceIsTheLongest) {
    Mesh mesh = cylinder(1, 2, 12, 4);
    for (int v = 0; v < mesh.vertex_count(); ++v) mesh.positions.row(v).head<2>() *= 1.0 + mesh.positions(v, 2);
    const Topology topo = topology(mesh);
    ASSERT_EQ(topo.boundary_loops.size(), 2u);
    EXPECT_EQ(mesh.positions(topo.boundary_loops[0][0], 2), 2.0);
    EXPECT_GT(topo.loop_lengths[0], topo.loop_lengths[1]);
}

struct Shape {
    const char* name;
    Mesh mesh;
    int euler, genus, loops;
};

std::vector<Shape> shapes() {
    return {
        {"disk", disk(5), 1, 0, 1},
        {"annulus", annulus(0.3, 1, 12), 0, 0, 2},
        {"three holes", circle_domain({}, {{{0.5, 0}, 0.2}, {{-0.5, 0}, 0.2}, {{0, 0.5}, 0.2}}, {.edge_length = 0.2}),
         -2, 0, 4},
        {"rectangle", rectangle(1, 2, 3, 5), 1, 0, 1},
        {"quad rectangle", rectangle(1, 2, 3, 5, Cells::quads), 1, 0, 1},
        {"cylinder", cylinder(1, 1, 8, 3), 0, 0, 2},
        {"quad cylinder", cylinder(1, 1, 8, 3, Cells::quads), 0, 0, 2},
        {"icosahedral sphere", icosahedral_sphere(2), 2, 0, 0},
        {"octahedral sphere", octahedral_sphere(2), 2, 0, 0},
        {"torus", torus(2, 1, 9, 7), 0, 1, 0},
        {"quad torus", torus(2, 1, 9, 7, Cells::quads), 0, 1, 0},
        {"double torus", double_torus(0.2), -2, 2, 0},
        {"torus with a hole", without_faces(torus(2, 1, 9, 7), {17}), -1, 1, 1},
        {"double torus with two holes", without_faces(double_torus(0.2), {0, 500}), -4, 2, 2},
    };
}

TEST(Topology, EulerCharacteristicGenusAndLoopsOfEveryGenerator) {
    for (const Shape& shape : shapes()) {
        SCOPED_TRACE(shape.name);
        const Topology topo = topology(shape.mesh);
        EXPECT_EQ(topo.euler_characteristic, shape.euler);
        EXPECT_EQ(topo.genus, shape.genus);
        EXPECT_EQ(static_cast<int>(topo.boundary_loops.size()), shape.loops);
        EXPECT_EQ(topo.components, 1);
    }
}

TEST(Topology, RenumberingChangesNamesOnly) {
    for (const Shape& shape : shapes()) {
        SCOPED_TRACE(shape.name);
        const Mesh& mesh = shape.mesh;
        Random random(7);
        std::vector<int> name(mesh.vertex_count()), order(mesh.face_count());
        std::iota(name.begin(), name.end(), 0);
        std::iota(order.begin(), order.end(), 0);
        for (std::size_t i = name.size(); i > 1; --i) std::swap(name[i - 1], name[random.next() % i]);
        for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.next() % i]);
        Mesh renamed;
        renamed.positions.resize(mesh.positions.rows(), mesh.positions.cols());
        for (int v = 0; v < mesh.vertex_count(); ++v) renamed.positions.row(name[v]) = mesh.positions.row(v);
        for (const int f : order) {
            std::vector<int> corners;
            for (const int v : mesh.faces[f]) corners.push_back(name[v]);
            std::rotate(corners.begin(), corners.begin() + static_cast<long>(random.next() % corners.size()),
                        corners.end());
            renamed.faces.add(corners);
        }
        const Topology before = topology(mesh), after = topology(renamed);
        EXPECT_EQ(after.edge_count(), before.edge_count());
        EXPECT_EQ(after.euler_characteristic, before.euler_characteristic);
        EXPECT_EQ(after.genus, before.genus);
        ASSERT_EQ(after.boundary_loops.size(), before.boundary_loops.size());
        // Every old loop, renamed and turned to its smallest vertex, is a new loop.
        std::set<std::vector<int>> loops(after.boundary_loops.begin(), after.boundary_loops.end());
        for (std::size_t k = 0; k < before.boundary_loops.size(); ++k) {
            std::vector<int> loop;
            for (const int v : before.boundary_loops[k]) loop.push_back(name[v]);
            std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end()), loop.end());
            EXPECT_TRUE(loops.contains(loop));
            if (k == 0 && is_planar(mesh)) {
                EXPECT_EQ(loop, after.boundary_loops[0]);
            }
        }
    }
}

TEST(Topology, ComponentsAndUnreferencedVertices) {
    // A sphere and a torus side by side, and one vertex that belongs to neither.
    const Mesh a = icosahedral_sphere(1), b = torus(2, 1, 6, 5);
    Mesh both;
    both.positions.resize(a.vertex_count() + 1 + b.vertex_count(), 3);
    both.positions << a.positions, Positions::Zero(1, 3), b.positions;
    for (int f = 0; f < a.face_count(); ++f) both.faces.add(a.faces[f]);
    for (int f = 0; f < b.face_count(); ++f) {
        std::vector<int> corners;
        for (const int v : b.faces[f]) corners.push_back(v + a.vertex_count() + 1);
        both.faces.add(corners);
    }
    const Topology topo = topology(both);
    EXPECT_EQ(topo.components, 2);
    EXPECT_EQ(topo.euler_characteristic, 2);
    EXPECT_EQ(topo.genus, 1);
}

TEST(Topology, RefusesWithTheOffendingIndices) {
    Mesh fan;  // three faces at the edge 0-1
    fan.positions = Positions::Random(5, 3);
    fan.faces.add({0, 1, 2});
    fan.faces.add({1, 0, 3});
    fan.faces.add({0, 1, 4});
    try {
        topology(fan);
        FAIL() << "accepted a non-manifold edge";
    } catch (const Error& error) {
        EXPECT_EQ(error.cause(), Cause::bad_mesh);
        EXPECT_EQ(error.indices(), (std::vector<int>{0, 1}));
    }
    Mesh bow;  // two triangles that touch in vertex 2
    bow.positions = Positions::Random(5, 3);
    bow.faces.add({0, 1, 2});
    bow.faces.add({2, 3, 4});
    try {
        topology(bow);
        FAIL() << "accepted a non-manifold vertex";
    } catch (const Error& error) {
        EXPECT_EQ(error.indices(), (std::vector<int>{2}));
    }
    Mesh turned = rectangle(1, 1, 3, 3, Cells::quads);
    Mesh wrong = turned;
    wrong.faces = {};
    for (int f = 0; f < 9; ++f) {
        std::vector<int> corners(turned.faces[f].begin(), turned.faces[f].end());
        if (f == 4) std::reverse(corners.begin(), corners.end());
        wrong.faces.add(corners);
    }
    try {
        topology(wrong);
        FAIL() << "accepted a reversed face";
    } catch (const Error& error) {
        EXPECT_EQ(error.indices(), (std::vector<int>{4}));
    }
    Mesh outside = rectangle(1, 1, 1, 1);
    outside.faces.add({0, 1, 4});
    EXPECT_THROW(topology(outside), Error);
    Mesh negative = rectangle(1, 1, 1, 1);
    negative.faces.add({0, 1, -1});
    EXPECT_THROW(topology(negative), Error);
}

}  // namespace
}  // namespace beltrami
