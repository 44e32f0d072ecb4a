#include <gtest/gtest.h>

#include <beltrami/base/error.h>
#include <beltrami/generate/grids.h>
#include <beltrami/generate/sphere.h>
#include <beltrami/mesh/mesh.h>
#include <beltrami/mesh/planar.h>

#include "support/cause_of.h"

namespace beltrami {
namespace {

TEST(Mesh, PlanarIsTwoCoordinatesOrEveryZZero) {
    Mesh mesh = rectangle(1, 1, 2, 2);
    EXPECT_TRUE(is_planar(mesh));
    mesh.positions.conservativeResize(Eigen::NoChange, 3);
    mesh.positions.col(2).setZero();
    EXPECT_TRUE(is_planar(mesh));
    mesh.positions(3, 2) = 1e-300;
    EXPECT_FALSE(is_planar(mesh));
}

TEST(Mesh, VectorAreaOfQuadFarFromTheOrigin) {
    Mesh mesh = rectangle(3, 2, 1, 1, Cells::quads);
    mesh.positions.array() += 1e8;
    EXPECT_EQ(face_vector_area(mesh, 0), Eigen::Vector3d(0, 0, 6));
}

TEST(Mesh, NormalsOfASpherePointOutwards) {
    const Mesh mesh = icosahedral_sphere(3, 2.0);
    const Positions normals = vertex_normals(mesh);
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        EXPECT_NEAR(normals.row(v).norm(), 1.0, 1e-14);
        EXPECT_GT(normals.row(v).dot(mesh.positions.row(v)) / 2.0, 0.999);
    }
}

TEST(Mesh, NormalOfCancellingFacesIsZero) {
    Mesh mesh;
    mesh.positions.resize(3, 3);
    mesh.positions << 0, 0, 0, 1, 0, 0, 0, 1, 0;
    mesh.faces.add({0, 1, 2});
    mesh.faces.add({0, 2, 1});
    EXPECT_EQ(vertex_normals(mesh), Positions::Zero(3, 3));
}

TEST(Mesh, MatricesOfTrianglesAndQuadsComeAndGo) {
    Eigen::MatrixXd V(5, 3);
    V << 0, 0, 0, 1, 0, 0, 1, 1, 0.5, 0, 1, 0, 2, 0.5, 1;
    Eigen::MatrixXi F(2, 4);
    F << 0, 1, 2, 3, 1, 4, 2, -1;
    const Mesh mixed = mesh_from(V, F);
    EXPECT_EQ(mixed.positions, V);
    EXPECT_EQ(mixed.face_count(), 2);
    EXPECT_EQ(std::vector(mixed.faces[0].begin(), mixed.faces[0].end()), (std::vector{0, 1, 2, 3}));
    EXPECT_EQ(std::vector(mixed.faces[1].begin(), mixed.faces[1].end()), (std::vector{1, 4, 2}));
    EXPECT_FALSE(mixed.texture);
    EXPECT_EQ(face_matrix(mixed), F);

    F.row(0) << 0, 1, 2, -1;
    const Mesh triangles = mesh_from(V.leftCols(2), F);
    EXPECT_EQ(triangles.positions, V.leftCols(2));
    EXPECT_EQ(face_matrix(triangles), F.leftCols(3));
    EXPECT_EQ(mesh_from(V, F.leftCols(3)).faces, triangles.faces);

    const Mesh none = mesh_from(V, Eigen::MatrixXi(0, 3));
    EXPECT_EQ(none.face_count(), 0);
    EXPECT_EQ(face_matrix(none).cols(), 3);
    EXPECT_EQ(face_matrix(none).rows(), 0);
}

TEST(Mesh, MatricesOfOtherShapesAreRefused) {
    const Eigen::MatrixXd V = Eigen::MatrixXd::Zero(5, 3);
    const Eigen::MatrixXi F = Eigen::MatrixXi::Zero(2, 3);
    for (const int columns : {0, 1, 4}) {
        EXPECT_EQ(test::cause_of([&] { mesh_from(Eigen::MatrixXd::Zero(5, columns), F); }), Cause::bad_mesh);
    }
    for (const int columns : {0, 2, 5}) {
        EXPECT_EQ(test::cause_of([&] { mesh_from(V, Eigen::MatrixXi::Zero(2, columns)); }), Cause::bad_mesh);
    }
    Mesh pentagon;
    pentagon.positions = V;
    pentagon.faces.add({0, 1, 2});
    pentagon.faces.add({0, 1, 2, 3, 4});
    EXPECT_EQ(test::cause_of([&] { face_matrix(pentagon); }), Cause::bad_mesh);
}

TEST(Mesh, CornerPositionsFollowTheFaces) {
    const Mesh mesh = rectangle(3, 2, 2, 1, Cells::quads);
    const Positions corners = corner_positions(mesh);
    ASSERT_EQ(corners.rows(), 8);
    ASSERT_EQ(corners.cols(), mesh.positions.cols());
    for (int f = 0; f < 2; ++f) {
        for (int i = 0; i < 4; ++i) EXPECT_EQ(corners.row(4 * f + i), mesh.positions.row(mesh.faces[f][i]));
    }
}

TEST(Planar, ClockwiseFacesAreSeenFromBelow) {
    Mesh mesh = rectangle(1, 2, 2, 2, Cells::quads);
    EXPECT_FALSE(seen_from_below(mesh));
    Eigen::VectorXcd z = planar_coordinates(mesh);
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        EXPECT_EQ(z[v], Complex(mesh.positions(v, 0), mesh.positions(v, 1)));
    }
    FaceList reversed;
    for (int f = 0; f < mesh.face_count(); ++f) {
        reversed.add({mesh.faces[f][3], mesh.faces[f][2], mesh.faces[f][1], mesh.faces[f][0]});
    }
    mesh.faces = reversed;
    mesh.positions.conservativeResize(Eigen::NoChange, 3);
    mesh.positions.col(2).setZero();
    EXPECT_TRUE(seen_from_below(mesh));
    EXPECT_EQ(planar_coordinates(mesh), z.conjugate());

    mesh.faces = {};
    EXPECT_FALSE(seen_from_below(mesh));
    EXPECT_EQ(planar_coordinates(mesh), z);
}

}  // namespace
}  // namespace beltrami
