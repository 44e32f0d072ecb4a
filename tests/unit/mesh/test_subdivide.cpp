#include <gtest/gtest.h>

#include <algorithm>

#include <beltrami/base/error.h>
#include <beltrami/generate/double_torus.h>
#include <beltrami/generate/grids.h>
#include <beltrami/generate/round_domains.h>
#include <beltrami/mesh/subdivide.h>
#include <beltrami/mesh/topology.h>

namespace beltrami {
namespace {

double total_area(const Mesh& mesh) {
    double area = 0.0;
    for (int f = 0; f < mesh.face_count(); ++f) area += face_vector_area(mesh, f).z();
    return area;
}

TEST(Subdivide, KeepsOldVerticesTopologyAndArea) {
    Mesh mixed;  // a quad and a triangle
    mixed.positions.resize(5, 2);
    mixed.positions << 0, 0, 1, 0, 1, 1, 0, 1, 2, 0.5;
    mixed.faces.add({0, 1, 2, 3});
    mixed.faces.add({1, 4, 2});
    for (const Mesh& mesh : {disk(4), rectangle(1, 1, 3, 2, Cells::quads), mixed, annulus(0.2, 1, 7)}) {
        const Topology before = topology(mesh);
        const SubdividedMesh result = midpoint_subdivide(mesh);
        const Topology after = topology(result.mesh);
        EXPECT_EQ(result.mesh.face_count(), 4 * mesh.face_count());
        EXPECT_EQ(result.mesh.positions.topRows(mesh.vertex_count()), mesh.positions);
        EXPECT_EQ(after.euler_characteristic, before.euler_characteristic);
        EXPECT_EQ(after.boundary_loops.size(), before.boundary_loops.size());
        EXPECT_NEAR(total_area(result.mesh), total_area(mesh), 1e-14);
        for (int f = 0; f < result.mesh.face_count(); ++f) {
            EXPECT_EQ(result.face_parents[f], f / 4);
            EXPECT_EQ(result.mesh.faces.degree(f), mesh.faces.degree(f / 4));
            EXPECT_GT(face_vector_area(result.mesh, f).z(), 0.0);
        }
        ASSERT_EQ(static_cast<int>(result.parents.size()), result.mesh.vertex_count() - mesh.vertex_count());
        for (int e = 0; e < before.edge_count(); ++e) {
            EXPECT_EQ(result.parents[e], (std::array{before.edges[e][0], before.edges[e][1], -1, -1}));
        }
        for (std::size_t i = 0; i < result.parents.size(); ++i) {
            Eigen::RowVectorXd mean = Eigen::RowVectorXd::Zero(2);
            int count = 0;
            for (const int parent : result.parents[i]) {
                if (parent < 0) continue;
                mean += mesh.positions.row(parent);
                ++count;
            }
            EXPECT_LT((mean / count - result.mesh.positions.row(mesh.vertex_count() + static_cast<int>(i))).norm(),
                      1e-15);
        }
    }
    EXPECT_EQ(topology(midpoint_subdivide(double_torus(0.25)).mesh).genus, 2);
}

TEST(Subdivide, TextureSeamsStaySeams) {
    // Two triangles; the texture is cut along their common edge, and one corner of the second has none.
    Mesh mesh;
    mesh.positions.resize(4, 2);
    mesh.positions << 0, 0, 1, 0, 1, 1, 0, 1;
    mesh.faces.add({0, 1, 2});
    mesh.faces.add({0, 2, 3});
    Positions points(6, 2);
    points << 0, 0, 1, 0, 1, 1, 5, 5, 6, 6, 5, 6;
    mesh.texture = TextureCoordinates{points, {0, 1, 2, 3, 4, 5}};
    const Mesh fine = midpoint_subdivide(mesh).mesh;
    ASSERT_TRUE(fine.texture);
    EXPECT_EQ(fine.texture->points.rows(), 12);  // 3 corners and 3 midpoints on either side
    ASSERT_EQ(fine.texture->corners.size(), static_cast<std::size_t>(fine.faces.corner_count()));
    for (int f = 0; f < fine.face_count(); ++f) {
        for (int i = 0; i < 3; ++i) {
            const int corner = fine.faces.first_corner(f) + i;
            const Eigen::RowVector2d p = fine.positions.row(fine.faces[f][i]);
            const Eigen::RowVector2d expected = p + Eigen::RowVector2d::Constant(f < 4 ? 0.0 : 5.0);
            EXPECT_EQ(Eigen::RowVector2d(fine.texture->points.row(fine.texture->corners[corner])), expected);
        }
    }
    mesh.texture->corners[5] = -1;
    const Mesh holed = midpoint_subdivide(mesh).mesh;
    EXPECT_EQ(holed.texture->points.rows(), 6 + 3 + 1);  // point 5 is kept though unused; two midpoints are lost
    EXPECT_EQ(std::count(holed.texture->corners.begin(), holed.texture->corners.end(), -1), 7);
    for (const int index : holed.texture->corners) EXPECT_LT(index, 10);
}

TEST(Subdivide, RefusesFacesOfMissingVertices) {
    Mesh mesh = rectangle(1, 1, 1, 1);
    mesh.faces.add({0, 1, 9});
    EXPECT_THROW(midpoint_subdivide(mesh), Error);
}

}  // namespace
}  // namespace beltrami
