#include <gtest/gtest.h>

#include <beltrami/locate/corner_weights.h>

namespace beltrami {
namespace {

TEST(CornerWeights, AreInTheOrderOfTheFace) {
    Mesh mesh;
    mesh.positions.resize(5, 2);
    mesh.positions << 0, 0, 1, 0, 1, 1, 0, 1, 2, 0;
    mesh.faces.add({0, 1, 2, 3});
    mesh.faces.add({1, 4, 2});
    const MeshPoint in_quad{0, {2, 3, 0}, {0.5, 0.2, 0.3}}, in_triangle{1, {4, 2, 1}, {0.1, 0.2, 0.7}};
    EXPECT_EQ(corner_weights(mesh, in_quad), (std::vector<double>{0.3, 0, 0.5, 0.2}));
    EXPECT_EQ(corner_weights(mesh, in_triangle), (std::vector<double>{0.7, 0.1, 0.2}));
}

}  // namespace
}  // namespace beltrami
