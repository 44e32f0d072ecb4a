#include <gtest/gtest.h>

#include <beltrami/generate/grids.h>
#include <beltrami/generate/sphere.h>
#include <beltrami/mesh/mesh.h>

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

}  // namespace
}  // namespace beltrami
