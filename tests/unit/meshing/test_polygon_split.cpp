#include <beltrami/meshing/polygon_split.h>

#include <cmath>
#include <numbers>
#include <set>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

namespace beltrami {

namespace {

/// Every side of the polygon belongs to one triangle in its own direction, every diagonal to two, both ways.
void expect_fills(int corners, const std::vector<std::array<int, 3>>& triangles) {
    ASSERT_EQ(triangles.size(), static_cast<std::size_t>(corners) - 2);
    std::set<std::pair<int, int>> sides;
    for (const auto& t : triangles)
        for (int i = 0; i < 3; ++i) EXPECT_TRUE(sides.insert({t[i], t[(i + 1) % 3]}).second);
    for (const auto& [a, b] : sides) EXPECT_NE(b == (a + 1) % corners, sides.contains({b, a}));
}

double smallest_area(const Positions& p, const std::vector<std::array<int, 3>>& triangles) {
    double least = 1e300;
    for (const auto& [a, b, c] : triangles) {
        const Eigen::Vector2d u = p.row(b) - p.row(a), v = p.row(c) - p.row(a);
        least = std::min(least, 0.5 * (u.x() * v.y() - u.y() * v.x()));
    }
    return least;
}

/// A comb: teeth that a fan from any corner would leave.
Positions comb(int teeth) {
    Positions p(4 * teeth, 2);
    for (int i = 0; i < teeth; ++i) {
        p.row(2 * i) << 2 * i, 0;
        p.row(2 * i + 1) << 2 * i + 1, 0;
    }
    for (int i = 0; i < teeth; ++i) {
        const double x = 2 * (teeth - i) - 1;
        p.row(2 * teeth + 2 * i) << x, 5;
        p.row(2 * teeth + 2 * i + 1) << x - 1, i + 1 < teeth ? 1 : 5;
    }
    return p;
}

}  // namespace

TEST(PolygonSplit, ReflexCornersTakeNoHarm) {
    for (const int teeth : {2, 3, 20}) {
        const Positions p = comb(teeth);
        const auto triangles = split_polygon(p);
        expect_fills(4 * teeth, triangles);
        EXPECT_GE(smallest_area(p, triangles), 0);
    }
}

TEST(PolygonSplit, DoesNotDependOnPlaceAndScale) {
    const Positions flat = comb(5);
    const auto expected = split_polygon(flat);
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
    for (const double scale : {1e-150, 1.0, 1e150}) {
        Positions p = Positions::Zero(flat.rows(), 3);
        p.leftCols(2) = flat;
        p = (scale * p * turn.transpose()).eval();
        const auto triangles = split_polygon(p);
        expect_fills(20, triangles);
        EXPECT_GE(smallest_area(flat, triangles), 0);
    }
    EXPECT_EQ(split_polygon(flat), expected);
}

TEST(PolygonSplit, StraightCornersOnASide) {
    Positions p(8, 2);
    p << 0, 0, .5, 0, 1, 0, 1, .5, 1, 1, .5, 1, 0, 1, 0, .5;
    const auto triangles = split_polygon(p);
    expect_fills(8, triangles);
    EXPECT_GT(smallest_area(p, triangles), 0.1);
}

TEST(PolygonSplit, WhatMeetsItselfGetsAFan) {
    Positions star(5, 2), line(6, 3), nothing = Positions::Zero(5, 3);
    for (int i = 0; i < 5; ++i) {
        const double t = 4 * std::numbers::pi * i / 5;
        star.row(i) << std::cos(t), std::sin(t);
    }
    for (int i = 0; i < 6; ++i) line.row(i) << i, i, i;
    expect_fills(5, split_polygon(star));
    expect_fills(6, split_polygon(line));
    expect_fills(5, split_polygon(nothing));
    nothing(0, 0) = std::nan("");
    expect_fills(5, split_polygon(nothing));
}

}  // namespace beltrami
