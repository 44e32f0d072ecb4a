#include <beltrami/targets/curve_on_target.h>

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <beltrami/base/error.h>
#include <beltrami/targets/implicit_target.h>
#include <beltrami/targets/parametric_target.h>
#include <beltrami/targets/simple_targets.h>

#include "support/cause_of.h"

namespace beltrami {
namespace {

double length_of(const Target::Points& way) {
    double length = 0;
    for (std::size_t i = 1; i < way.size(); ++i) length += (way[i].position - way[i - 1].position).norm();
    return length;
}

TEST(StraightWay, IsAnArcOfAGreatCircleOrALine) {
    const SphereTarget sphere;
    const Target::Point a = sphere.nearest({1, 0.2, -0.3}), b = sphere.nearest({-0.7, 1, 0.5});
    const Target::Points way = straight_way(sphere, a, b);
    ASSERT_EQ(way.size(), 65u);
    const Eigen::Vector3d normal = a.position.cross(b.position).normalized();
    const double angle = std::acos(a.position.dot(b.position));
    for (std::size_t i = 0; i < way.size(); ++i) {
        EXPECT_LT(std::abs(way[i].position.dot(normal)), 1e-12);
        EXPECT_NEAR(std::acos(std::min(1.0, a.position.dot(way[i].position))), angle * static_cast<double>(i) / 64,
                    1e-7);
    }
    const PlaneTarget plane;
    for (const Target::Point& p : straight_way(plane, plane.nearest({0, 0, 0}), plane.nearest({2, 1, 0})))
        EXPECT_LT(std::abs(p.position.x() - 2 * p.position.y()), 1e-12);
}

TEST(StraightWay, IsAHelixOnACylinderToSecondOrder) {
    const ParametricTarget cylinder = cylinder_target(1, 3);
    const Target::Point a = cylinder.nearest({1, 0, 0.5}), b = cylinder.nearest({0, 1, 2});
    const double exact = std::hypot(std::numbers::pi / 2, 1.5);
    double before = 0;
    for (const int pieces : {8, 16, 32}) {
        const double error = exact - length_of(straight_way(cylinder, a, b, pieces));
        EXPECT_GT(error, 0);  // chords
        if (before > 0) {
            EXPECT_NEAR(std::log2(before / error), 2, 0.1);
        }
        before = error;
    }
}

TEST(StraightWay, OnAnEllipsoidIsNoLongerThanItsNeighbours) {
    const ImplicitTarget ellipsoid = ellipsoid_target({1, 1.5, 0.7});
    const Target::Point a = ellipsoid.nearest({1, 0.3, 0.2}), b = ellipsoid.nearest({-0.2, 1.4, 0.3});
    const Target::Points way = straight_way(ellipsoid, a, b, 32);
    const double least = length_of(way);
    for (const double by : {-0.02, 0.02}) {
        Target::Points moved = way;
        for (std::size_t i = 1; i + 1 < way.size(); ++i) {
            const Eigen::Vector3d across = way[i].normal.cross(way[i + 1].position - way[i - 1].position).normalized();
            const double part = std::sin(std::numbers::pi * static_cast<double>(i) / 32);
            moved[i] = ellipsoid.nearest(way[i].position + by * part * across);
        }
        EXPECT_GT(length_of(moved), least);
    }
}

TEST(StraightWay, BetweenOppositePointsIsRefused) {
    const SphereTarget sphere;
    EXPECT_EQ(test::cause_of([&] {
                  straight_way(sphere, sphere.nearest({0, 0, 1}), sphere.nearest({0, 0, -1}));
              }),
              Cause::bad_boundary);
}

TEST(CurveOnTarget, LiesOnTheTargetAndTouchesIt) {
    const SphereTarget sphere;
    Positions corners(3, 3);
    corners << 1, 0, 0, 0, 1, 0, 0, 0, 1;
    const CurveOnTarget curve(sphere, corners, true);
    EXPECT_TRUE(curve.closed());
    for (double s = 0.1; s < curve.length(); s += 0.3) {
        const Eigen::Vector3d p = curve.point(s);
        EXPECT_NEAR(p.norm(), 1, 1e-14);
        EXPECT_NEAR(curve.tangent(s).dot(p), 0, 1e-14);
        EXPECT_NEAR(curve.tangent(s).norm(), 1, 1e-14);
        const double h = 1e-6;
        EXPECT_GT((curve.point(s + h) - p).normalized().dot(curve.tangent(s)), 1 - 1e-6);
    }
}

}  // namespace
}  // namespace beltrami
