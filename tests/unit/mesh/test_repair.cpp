#include <beltrami/mesh/repair.h>

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include <beltrami/base/error.h>
#include <beltrami/base/random.h>
#include <beltrami/generate/grids.h>
#include <beltrami/mesh/topology.h>

namespace beltrami {

namespace {

/// Every face with corners of its own, each moved by up to @p noise.
Mesh soup(const Mesh& mesh, double noise) {
    Random random(5);
    Mesh result;
    result.positions = Positions::Zero(mesh.faces.corner_count(), 3);
    result.positions.leftCols(mesh.positions.cols()) = corner_positions(mesh);
    for (double& x : result.positions.reshaped()) x += noise * random.uniform(-1, 1);
    for (int f = 0; f < mesh.face_count(); ++f) {
        std::vector<int> corners(mesh.faces.degree(f));
        std::iota(corners.begin(), corners.end(), mesh.faces.first_corner(f));
        result.faces.add(corners);
    }
    return result;
}

}  // namespace

TEST(Weld, JoinsASoup) {
    const Mesh whole = rectangle(2, 1, 12, 6);
    for (const double scale : {1e-100, 1.0, 1e100}) {
        Mesh apart = soup(whole, 1e-7);
        apart.positions *= scale;
        EXPECT_EQ(topology(apart).components, whole.face_count());
        const WeldedMesh welded = weld(apart, 1e-5 * scale);
        EXPECT_EQ(welded.mesh.vertex_count(), whole.vertex_count());
        EXPECT_EQ(welded.removed_faces, 0);
        const Topology t = topology(welded.mesh);
        EXPECT_EQ(t.components, 1);
        EXPECT_EQ(t.boundary_loops.size(), 1U);
        for (int v = 0; v < apart.vertex_count(); ++v)
            EXPECT_LE((apart.point(v) - welded.mesh.point(welded.welded[v])).norm(), 1e-5 * scale);
        for (int v = 0; v < welded.mesh.vertex_count(); ++v) {
            EXPECT_EQ(welded.welded[welded.vertices[v]], v);
            EXPECT_EQ(apart.point(welded.vertices[v]), welded.mesh.point(v));
        }
    }
}

TEST(Weld, ZeroJoinsEqualPositionsOnly) {
    Mesh mesh = soup(rectangle(1, 1, 3, 3), 0);
    mesh.positions(0, 0) = std::nextafter(mesh.positions(0, 0), 1);
    mesh.positions(1, 1) = -0.0;
    EXPECT_EQ(weld(mesh, 0).mesh.vertex_count(), 17);
    for (const double wrong : {-1.0, std::nan(""), std::numeric_limits<double>::infinity()})
        EXPECT_THROW(weld(mesh, wrong), Error);
}

TEST(Weld, FacesThatCollapseGo) {
    Mesh mesh;
    mesh.positions.resize(6, 2);
    mesh.positions << 0, 0, 1, 0, 1, 1, 0, 1, 1, 0.001, 2, 0;
    mesh.faces.add({0, 1, 2, 3});
    mesh.faces.add({1, 5, 2, 4});  // loses a corner
    mesh.faces.add({1, 5, 4});     // goes
    mesh.texture = TextureCoordinates{mesh.positions, {0, 1, 2, 3, 1, 5, 2, 4, 1, 5, 4}};
    const WeldedMesh welded = weld(mesh, 0.01);
    ASSERT_EQ(welded.mesh.face_count(), 2);
    EXPECT_EQ(welded.removed_faces, 1);
    EXPECT_EQ(welded.faces, (std::vector{0, 1}));
    EXPECT_EQ(welded.mesh.faces.degree(1), 3);
    EXPECT_EQ(welded.mesh.texture->corners.size(), 7U);
    EXPECT_EQ(welded.mesh.vertex_count(), 5);
}

TEST(Weld, Suggestions) {
    const WeldSuggestion found = suggest_weld(soup(rectangle(1, 1, 8, 8), 1e-7));
    EXPECT_EQ(found.components, 1);
    EXPECT_LE(found.tolerance, 2e-6);
    EXPECT_EQ(suggest_weld(rectangle(1, 1, 8, 8)).tolerance, 0);
}

TEST(Orient, TurnsTheFewer) {
    const Mesh whole = rectangle(1, 1, 6, 6);
    Mesh wrong = whole;
    FaceList faces;
    for (int f = 0; f < whole.face_count(); ++f) {
        const auto v = whole.faces[f];
        if (f % 5 == 3)
            faces.add({v[0], v[2], v[1]});
        else
            faces.add(v);
    }
    wrong.faces = faces;
    wrong.texture = TextureCoordinates{whole.positions, faces.vertices()};
    EXPECT_THROW(topology(wrong), Error);
    const OrientedMesh right = orient(wrong);
    EXPECT_EQ(right.mesh.faces, whole.faces);
    EXPECT_EQ(right.mesh.texture->corners, whole.faces.vertices());
    EXPECT_EQ(right.turned.size(), static_cast<std::size_t>((whole.face_count() + 1) / 5));
    EXPECT_TRUE(orient(whole).turned.empty());
}

}  // namespace beltrami
