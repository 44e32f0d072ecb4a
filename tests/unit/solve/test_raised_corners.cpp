#include <beltrami/solve/raised_corners.h>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

namespace beltrami {
namespace {

TEST(RaisedCorners, RaiseNeedlesOnly) {
    Mesh mesh;
    mesh.positions.resize(4, 3);
    mesh.positions << 0, 0, 0, 1, 0, 0, 0.4, 1e-5, 0, 0.5, -0.5, 0;
    mesh.faces.add({0, 1, 2});
    mesh.faces.add({1, 0, 3});
    const Surface surface(mesh);
    const Positions corners = raised_corners(surface, 0.02);
    EXPECT_NEAR(corners(2, 0), 0.4, 1e-15);
    EXPECT_NEAR(corners(2, 1), 0.02, 1e-15);
    EXPECT_EQ(corners.row(5), mesh.positions.row(3));
    EXPECT_EQ(corners.row(0), mesh.positions.row(0));
}

}  // namespace
}  // namespace beltrami
