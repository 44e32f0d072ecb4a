#include <array>

#include <gtest/gtest.h>

#include <beltrami/meshing/face_split.h>
#include <beltrami/operators/face_areas.h>

namespace beltrami {
namespace {

/// A triangle, a quad, a folded quad and a pentagon side by side in space, with one texture point per corner.
Mesh assorted() {
    Mesh mesh;
    mesh.positions.resize(13, 3);
    mesh.positions << 0, 0, 0, 1, 0, 0, 0, 1, 0,  // triangle
        2, 0, 0, 3, 0, 0.1, 3, 1, 0, 2, 1, 0,     // quad
        4, 0, 0, 5, 0, 0, 4.1, 0.1, 0,            // with 4, 1 a quad that turns in deeply
        4, 1, 0, 6, 0, 0, 6, 1, 0.5;
    mesh.faces.add({0, 1, 2});
    mesh.faces.add({3, 4, 5, 6});
    mesh.faces.add({7, 8, 9, 10});
    mesh.faces.add({8, 11, 12, 10, 9});
    TextureCoordinates texture;
    texture.points.resize(16, 2);
    for (int c = 0; c < 16; ++c) {
        texture.points.row(c) << c, -c;
        texture.corners.push_back(c);
    }
    mesh.texture = texture;
    return mesh;
}

TEST(FaceSplit, CutsLargeFacesOnly) {
    const Mesh mesh = assorted();
    const SplitMesh split = split_large_faces(mesh);
    EXPECT_EQ(split.faces, (std::vector{0, 1, 2, 3, 3, 3}));
    EXPECT_EQ(split.cut, std::vector{3});
    EXPECT_EQ(split.mesh.positions, mesh.positions);
    EXPECT_EQ(split.mesh.faces.degree(2), 4);
    // The texture point of a corner stays with its vertex.
    ASSERT_EQ(split.mesh.texture->corners.size(), split.mesh.faces.vertices().size());
    for (std::size_t c = 0; c < split.mesh.texture->corners.size(); ++c)
        EXPECT_EQ(mesh.faces.vertices()[split.mesh.texture->corners[c]], split.mesh.faces.vertices()[c]);
}

TEST(FaceSplit, CutsQuadsThatFoldToo) {
    const Mesh mesh = assorted();
    EXPECT_EQ(faces_without_area(split_large_faces(mesh).mesh), std::vector{2});
    const SplitMesh split = split_unusable_faces(mesh);
    EXPECT_EQ(split.faces, (std::vector{0, 1, 2, 2, 3, 3, 3}));
    EXPECT_EQ(split.cut, (std::vector{2, 3}));
    EXPECT_TRUE(faces_without_area(split.mesh).empty());
    // Both halves of the folded quad have its orientation.
    for (const int f : {2, 3}) EXPECT_GT(face_vector_area(split.mesh, f).z(), 0);
    const SplitMesh again = split_unusable_faces(split.mesh);
    EXPECT_TRUE(again.cut.empty());
    EXPECT_EQ(again.mesh.faces, split.mesh.faces);
}

}  // namespace
}  // namespace beltrami
