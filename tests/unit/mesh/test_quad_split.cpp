#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <beltrami/mesh/quad_split.h>

namespace beltrami {
namespace {

using Corners = std::array<Eigen::Vector3d, 4>;
using Halves = std::array<std::array<int, 3>, 2>;

const Halves kFirst = {{{0, 1, 2}, {0, 2, 3}}};
const Halves kSecond = {{{1, 2, 3}, {1, 3, 0}}};

Corners plane(double x0, double y0, double x1, double y1, double x2, double y2, double x3, double y3) {
    return {Eigen::Vector3d(x0, y0, 0), Eigen::Vector3d(x1, y1, 0), Eigen::Vector3d(x2, y2, 0),
            Eigen::Vector3d(x3, y3, 0)};
}

TEST(QuadSplit, AlongTheShorterDiagonal) {
    EXPECT_EQ(split_quad(plane(0, 0, 1, 0, 1, 1, 0, 1)), kFirst) << "of equals, the first";
    EXPECT_EQ(split_quad(plane(0, 0, 1, 0, 2, 1, 1, 1)), kSecond);
    EXPECT_EQ(split_quad(plane(0, 0, 1, 0, 0, 1, -1, 1)), kFirst);
}

TEST(QuadSplit, InsideWhereACornerIsReflex) {
    const Corners dart = plane(0, 0, 1, -0.3, 0.4, 0, 1, 0.3);  // 1-3 is longer than 0-2
    EXPECT_EQ(split_quad(dart), kFirst);
    const Corners wide = plane(0, 0, 1, -0.1, 0.9, 0, 1, 0.1);  // 1-3 is shorter and lies outside
    EXPECT_EQ(split_quad(wide), kFirst);
    EXPECT_EQ(split_quad({wide[3], wide[0], wide[1], wide[2]}), kSecond);
}

TEST(QuadSplit, DependsOnTheShapeOnly) {
    const Eigen::Matrix3d turn = Eigen::Quaterniond(0.3, 0.5, -0.7, 0.4).normalized().toRotationMatrix();
    for (const double scale : {1e-200, 1.0, 1e200}) {
        Corners wide = plane(0, 0, 1, -0.1, 0.9, 0, 1, 0.1);
        Corners slanted = plane(0, 0, 1, 0, 2, 1, 1, 1);
        for (auto* quad : {&wide, &slanted})
            for (Eigen::Vector3d& p : *quad) p = scale * (turn * p + Eigen::Vector3d(1, 2, 3));
        EXPECT_EQ(split_quad(wide), kFirst);
        EXPECT_EQ(split_quad(slanted), kSecond);
    }
}

TEST(QuadSplit, OfAPointIsSomeSplit) {
    EXPECT_EQ(split_quad(plane(1, 1, 1, 1, 1, 1, 1, 1)), kFirst);
}

TEST(QuadSplit, InThePlaneAlongTheDiagonalInside) {
    const Halves first = {{{0, 1, 2}, {2, 3, 0}}}, second = {{{1, 2, 3}, {3, 0, 1}}};
    EXPECT_EQ(split_inside({Complex(0, 0), {1, 0}, {2, 1}, {1, 1}}), first) << "both do, however long they are";
    const std::array<Complex, 4> dart{Complex(0, 0), {1, -0.3}, {0.4, 0}, {1, 0.3}};
    EXPECT_EQ(split_inside(dart), first);
    EXPECT_EQ(split_inside({dart[3], dart[0], dart[1], dart[2]}), second);
}

}  // namespace
}  // namespace beltrami
