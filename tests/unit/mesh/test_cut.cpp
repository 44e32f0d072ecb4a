#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <beltrami/base/error.h>
#include <beltrami/generate/grids.h>
#include <beltrami/generate/round_domains.h>
#include <beltrami/generate/sphere.h>
#include <beltrami/mesh/cut.h>
#include <beltrami/mesh/diagnosis.h>
#include <beltrami/mesh/topology.h>

namespace beltrami {
namespace {

double area(const Mesh& mesh) {
    double sum = 0.0;
    for (int f = 0; f < mesh.face_count(); ++f) sum += face_vector_area(mesh, f).norm();
    return sum;
}

/// What every cut must satisfy.
void expect_consistent(const Mesh& whole, const CutMesh& cut, const HalfSpace& kept) {
    ASSERT_EQ(static_cast<int>(cut.vertices.size()), cut.mesh.vertex_count());
    ASSERT_EQ(static_cast<int>(cut.edges.size()), cut.mesh.vertex_count());
    ASSERT_EQ(static_cast<int>(cut.faces.size()), cut.mesh.face_count());
    int last = -1;
    bool new_ones = false;
    for (int v = 0; v < cut.mesh.vertex_count(); ++v) {
        const double height = kept.normal.normalized().dot(cut.mesh.point(v)) - kept.offset / kept.normal.norm();
        EXPECT_GE(height, -1e-11);
        if (cut.vertices[v] >= 0) {
            EXPECT_FALSE(new_ones);  // old ones first
            EXPECT_GT(cut.vertices[v], last);
            last = cut.vertices[v];
            EXPECT_EQ(cut.mesh.point(v), whole.point(cut.vertices[v]));
            EXPECT_EQ(cut.edges[v], (std::array{-1, -1}));
        } else {
            new_ones = true;
            EXPECT_NEAR(height, 0.0, 1e-12);
            const Eigen::Vector3d a = whole.point(cut.edges[v][0]), b = whole.point(cut.edges[v][1]);
            EXPECT_NEAR((a - cut.mesh.point(v)).norm() + (cut.mesh.point(v) - b).norm(), (a - b).norm(), 1e-12);
        }
    }
    for (const Finding& warning : require_sound(cut.mesh)) {
        EXPECT_EQ(warning.defect, Defect::sliver_face);  // a plane close to a vertex
    }
}

TEST(Cut, SphereAtGeneralHeight) {
    const Mesh sphere = icosahedral_sphere(4);
    const HalfSpace kept{{0.1, 0.2, 2.0}, 0.613};
    const CutMesh cut = cut_by_plane(sphere, kept);
    expect_consistent(sphere, cut, kept);
    const Topology topo = topology(cut.mesh);
    EXPECT_EQ(topo.genus, 0);
    EXPECT_EQ(topo.boundary_loops.size(), 1u);
    const double height = 1.0 - 0.613 / kept.normal.norm();
    EXPECT_NEAR(area(cut.mesh), 2.0 * std::numbers::pi * height, 0.02);
    const CutMesh other = cut_by_plane(sphere, {-kept.normal, -kept.offset});
    EXPECT_NEAR(area(cut.mesh) + area(other.mesh), area(sphere), 1e-12);
}

TEST(Cut, PlaneThroughVerticesMakesNoNewOnes) {
    const Mesh sphere = octahedral_sphere(3);  // the equator is made of edges
    const HalfSpace kept = HalfSpace::through({5, 5, 0}, {0, 0, 3});
    const CutMesh cut = cut_by_plane(sphere, kept);
    expect_consistent(sphere, cut, kept);
    EXPECT_EQ(cut.mesh.face_count(), sphere.face_count() / 2);
    EXPECT_EQ(std::count(cut.vertices.begin(), cut.vertices.end(), -1), 0);
    EXPECT_EQ(topology(cut.mesh).boundary_loops[0].size(), 32u);
}

TEST(Cut, VerticesWithinRoundingOfThePlaneCountAsOnIt) {
    Mesh sphere = octahedral_sphere(3);
    for (int v = 0; v < sphere.vertex_count(); ++v) {
        if (sphere.positions(v, 2) == 0.0) sphere.positions(v, 2) = v % 2 ? 1e-13 : -1e-13;
    }
    const CutMesh cut = cut_by_plane(sphere, {{0, 0, 1}, 0.0});
    EXPECT_EQ(cut.mesh.face_count(), sphere.face_count() / 2);
    EXPECT_EQ(std::count(cut.vertices.begin(), cut.vertices.end(), -1), 0);
}

TEST(Cut, TorusAcrossGivesTwoLoops) {
    const Mesh whole = torus(2, 0.7, 40, 20);
    const HalfSpace across{{0, 0.3, 1}, 0.123};
    const CutMesh ring = cut_by_plane(whole, across);
    expect_consistent(whole, ring, across);
    const HalfSpace along{{1, 0.01, 0}, 0.037};
    const CutMesh half = cut_by_plane(whole, along);
    expect_consistent(whole, half, along);
    const Topology topo = topology(half.mesh);
    EXPECT_EQ(topo.boundary_loops.size(), 2u);
    EXPECT_EQ(topo.euler_characteristic, 0);
    EXPECT_EQ(topo.genus, 0);
}

TEST(Cut, CrossingQuadsAreTriangulatedOthersStayQuads) {
    const Mesh grid = rectangle(4, 4, 4, 4, Cells::quads);
    const HalfSpace kept{{1, 0, 0}, 1.5};
    const CutMesh cut = cut_by_plane(grid, kept);
    expect_consistent(grid, cut, kept);
    int quads = 0;
    for (int f = 0; f < cut.mesh.face_count(); ++f) quads += cut.mesh.faces.degree(f) == 4;
    EXPECT_EQ(quads, 8);
    EXPECT_NEAR(area(cut.mesh), 10.0, 1e-14);
    EXPECT_EQ(topology(cut.mesh).euler_characteristic, 1);
}

TEST(Cut, KeepsAllOrNothing) {
    const Mesh mesh = disk(3);
    EXPECT_EQ(cut_by_plane(mesh, {{1, 0, 0}, -5}).mesh.faces, mesh.faces);
    const CutMesh nothing = cut_by_plane(mesh, {{1, 0, 0}, 5});
    EXPECT_EQ(nothing.mesh.face_count(), 0);
    EXPECT_EQ(nothing.mesh.vertex_count(), 0);
    EXPECT_EQ(cut_by_plane(Mesh{}, {{1, 0, 0}, 0}).mesh.face_count(), 0);
}

TEST(Cut, TextureIsInterpolated) {
    Mesh mesh = rectangle(1, 1, 3, 3);
    mesh.texture = TextureCoordinates{2.0 * mesh.positions, mesh.faces.vertices()};
    const CutMesh cut = cut_by_plane(mesh, {{1, 0.3, 0}, 0.5});
    ASSERT_TRUE(cut.mesh.texture);
    ASSERT_EQ(static_cast<int>(cut.mesh.texture->corners.size()), cut.mesh.faces.corner_count());
    EXPECT_EQ(cut.mesh.texture->points.rows(), cut.mesh.vertex_count());
    for (int c = 0; c < cut.mesh.faces.corner_count(); ++c) {
        const auto texture = cut.mesh.texture->points.row(cut.mesh.texture->corners[c]);
        EXPECT_LT((texture - 2.0 * cut.mesh.positions.row(cut.mesh.faces.vertices()[c])).norm(), 1e-14);
    }
}

TEST(Cut, RefusesImpossiblePlanes) {
    EXPECT_THROW(cut_by_plane(disk(2), {{0, 0, 0}, 1}), Error);
    EXPECT_THROW(cut_by_plane(disk(2), {{NAN, 0, 0}, 1}), Error);
    EXPECT_THROW(cut_by_plane(disk(2), {{1, 0, 0}, INFINITY}), Error);
}

TEST(Submesh, LargestComponentAcrossEdges) {
    // A large and a small grid that touch in one vertex.
    Mesh mesh = rectangle(3, 3, 3, 3, Cells::quads);
    const int n = mesh.vertex_count();
    mesh.positions.conservativeResize(n + 4, 2);
    mesh.positions.bottomRows(4) << 9, 9, 4, 3, 4, 4, 3, 4;
    mesh.faces.add({n - 1, n + 1, n + 2, n + 3});
    const Submesh part = largest_component(mesh);
    EXPECT_EQ(part.mesh.face_count(), 9);
    EXPECT_EQ(part.mesh.vertex_count(), 16);
    for (int v = 0; v < 16; ++v) EXPECT_EQ(part.vertices[v], v);
    EXPECT_TRUE(diagnose(part.mesh).empty());

    const Submesh used = remove_unreferenced(mesh);
    EXPECT_EQ(used.mesh.vertex_count(), n + 3);
    EXPECT_EQ(used.vertices[n], n + 1);
    EXPECT_EQ(used.mesh.faces[9][1], n);
    EXPECT_EQ(largest_component(Mesh{}).mesh.face_count(), 0);
}

}  // namespace
}  // namespace beltrami
