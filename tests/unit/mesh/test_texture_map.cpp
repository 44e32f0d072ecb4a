#include <gtest/gtest.h>

#include <limits>

#include <beltrami/base/error.h>
#include <beltrami/mesh/texture_map.h>

namespace beltrami {
namespace {

/// Two triangles over a square, one texture point a vertex; a further vertex belongs to no face.
Mesh square() {
    Mesh mesh;
    mesh.positions.resize(5, 3);
    mesh.positions << 0, 0, 1, 1, 0, 1, 1, 1, 1, 0, 1, 1, 9, 9, 9;
    mesh.faces.add({0, 1, 2});
    mesh.faces.add({0, 2, 3});
    mesh.texture.emplace();
    mesh.texture->points.resize(4, 2);
    mesh.texture->points << 0, 0, 2, 0.5, 2.5, 3, -1, 2;
    mesh.texture->corners = {0, 1, 2, 0, 2, 3};
    return mesh;
}

TEST(TextureMap, IsOnePointAVertex) {
    const Eigen::VectorXcd map = texture_map(square());
    ASSERT_EQ(map.size(), 5);
    EXPECT_EQ(map[1], Complex(2, 0.5));
    EXPECT_EQ(map[2], Complex(2.5, 3));
    EXPECT_EQ(map[3], Complex(-1, 2));
    EXPECT_EQ(map[4], Complex(0));
    // Points that are listed twice are no seam.
    Mesh twice = square();
    twice.texture->points.conservativeResize(5, 2);
    twice.texture->points.row(4) = twice.texture->points.row(2);
    twice.texture->corners[4] = 4;
    EXPECT_EQ(texture_map(twice), map);
}

TEST(TextureMap, ChartsEndAtSeams) {
    EXPECT_EQ(texture_charts(square()), (std::vector<std::vector<int>>{{0, 1}}));
    // Points that are listed twice are no seam; those of one edge that lie elsewhere are.
    Mesh twice = square();
    twice.texture->points.conservativeResize(6, 2);
    twice.texture->points.row(4) = twice.texture->points.row(2);
    twice.texture->points.row(5) = twice.texture->points.row(0);
    twice.texture->corners[3] = 5;
    twice.texture->corners[4] = 4;
    EXPECT_EQ(texture_charts(twice).size(), 1U);
    twice.texture->points.bottomRows(2).array() += 1;
    EXPECT_EQ(texture_charts(twice), (std::vector<std::vector<int>>{{0}, {1}}));
}

TEST(TextureMap, NamesTheVertexThatHasNone) {
    const auto refused = [](const Mesh& mesh, const std::vector<int>& vertices) {
        try {
            texture_map(mesh);
            ADD_FAILURE() << "accepted";
        } catch (const Error& error) {
            EXPECT_EQ(error.cause(), Cause::bad_mesh);
            EXPECT_EQ(error.indices(), vertices) << error.what();
        }
    };
    Mesh mesh = square();
    mesh.texture.reset();
    refused(mesh, {});
    mesh = square();
    mesh.texture->corners[4] = 1;  // a seam at vertex 2
    refused(mesh, {2});
    mesh = square();
    mesh.texture->corners[5] = -1;
    refused(mesh, {3});
    mesh = square();
    mesh.texture->points(1, 1) = std::numeric_limits<double>::infinity();
    refused(mesh, {1});
}

}  // namespace
}  // namespace beltrami
