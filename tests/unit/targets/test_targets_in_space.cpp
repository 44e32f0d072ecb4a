#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <cmath>
#include <numbers>

#include <beltrami/base/error.h>
#include <beltrami/generate/grids.h>
#include <beltrami/generate/sphere.h>
#include <beltrami/targets/implicit_target.h>
#include <beltrami/targets/mesh_target.h>
#include <beltrami/targets/parametric_target.h>
#include <beltrami/targets/simple_targets.h>
#include <beltrami/targets/slide_curve.h>

namespace beltrami {
namespace {

TEST(SphereTarget, ProjectsFromTheCentreAndCentres) {
    const SphereTarget sphere;
    const Target::Point point = sphere.nearest({0, 3, 4});
    EXPECT_LT((point.position - Eigen::Vector3d(0, 0.6, 0.8)).norm(), 1e-15);
    EXPECT_EQ(point.normal, point.position);
    Positions gathered = octahedral_sphere(2).positions;
    gathered.col(2).array() += 1.5;  // then most of them lie in the north
    const Target::Points points = nearest_points(sphere, gathered);
    EXPECT_GT(positions_of(points).colwise().mean().norm(), 0.5);
    const Target::Points centred =
        sphere.centred(points, Eigen::VectorXd::Ones(static_cast<Eigen::Index>(points.size())));
    EXPECT_LT(positions_of(centred).colwise().mean().norm(), 1e-10);
}

TEST(MeshTarget, GivesThePlaceOfEveryPointAndItsNormal) {
    const Mesh mesh = torus(2, 1, 48, 24, Cells::quads);
    const MeshTarget target(mesh);
    for (const Eigen::Vector3d& wanted : {Eigen::Vector3d(3.2, 0.1, 0.2), Eigen::Vector3d(-1, 1.4, 1.3)}) {
        const Target::Point point = target.nearest(wanted);
        ASSERT_GE(point.place.face, 0);
        Eigen::Vector3d there = Eigen::Vector3d::Zero();
        for (int i = 0; i < 3; ++i) there += point.place.barycentric[i] * mesh.point(point.place.vertices[i]);
        EXPECT_LT((there - point.position).norm(), 1e-14);
        // The normal of the torus at the nearest point of its core circle.
        const Eigen::Vector3d core = 2 * Eigen::Vector3d(wanted.x(), wanted.y(), 0).normalized();
        EXPECT_GT(point.normal.dot((wanted - core).normalized()), 0.999);
        EXPECT_LT((point.position - core).norm(), 1 + 1e-12);
        EXPECT_GT((point.position - core).norm(), 0.98);
    }
}

TEST(MeshTarget, MovesPointsAsTheirMotionSays) {
    const Mesh mesh = torus(2, 1, 12, 6);  // whose faces lie far from the planes across its normals
    const MeshTarget target(mesh);
    const Target::Point point = target.nearest({2.9, 0.35, 0.4});
    const Eigen::Vector3d across = target.across(point), other = Eigen::Vector3d(0.3, 0.2, 0.9).cross(across),
                          along = 1e-3 * other.normalized();
    EXPECT_GT(across.dot(point.normal), 0.5);
    EXPECT_LT((target.retract(point.position + along, point).position - point.position - along).norm(), 1e-12);
    // On edges, where there is no such plane, across the normal.
    EXPECT_EQ(target.across(target.at_vertex(5)), target.at_vertex(5).normal);
}

TEST(MeshTarget, FindsTheNearestPointFromWhereverItBegins) {
    const Mesh mesh = torus(2, 1, 24, 12, Cells::quads);
    const MeshTarget target(mesh);
    for (int v = 0; v < mesh.vertex_count(); v += 5) {
        const Eigen::Vector3d moved = mesh.point(v) + Eigen::Vector3d(0.4, -0.3, 0.2);
        const Target::Point nearest = target.nearest(moved);
        for (const int from : {v, 0, mesh.vertex_count() - 1}) {
            const Target::Point found = target.retract(moved, target.at_vertex(from));
            EXPECT_EQ(found.position, nearest.position);
            EXPECT_EQ(found.place.vertices, nearest.place.vertices);
        }
        EXPECT_EQ(target.retract(moved, Target::Point()).position, nearest.position);
    }
}

TEST(MeshTarget, KeepsItsOwnVertices) {
    const Mesh mesh = icosahedral_sphere(3);
    const MeshTarget target(mesh);
    const Target::Points points = nearest_points(target, mesh.positions);
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        EXPECT_LT((points[v].position - mesh.point(v)).norm(), 1e-15);
        EXPECT_LT((target.at_vertex(v).position - mesh.point(v)).norm(), 1e-15);
        EXPECT_EQ(points[v].place.vertices.size(), 3u);
    }
}

TEST(MeshTarget, RefusesWhatItCannotUse) {
    EXPECT_THROW(MeshTarget(Mesh{}), Error);
    Positions points = Positions::Zero(3, 3);
    points(1, 2) = std::nan("");
    try {
        nearest_points(SphereTarget(), points);
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.cause(), Cause::bad_option);
        EXPECT_EQ(error.indices(), std::vector<int>{1});
    }
}

TEST(ParametricTarget, FindsTheNearestPointAgain) {
    const ParametricTarget targets[] = {torus_target(2, 1), first_modified_torus(), second_modified_torus(),
                                        cylinder_target(1, 2)};
    for (const ParametricTarget& target : targets)
        for (double u = 0.03; u < 1; u += 0.19)
            for (double v = 0.05; v < 1; v += 0.23) {
                const Target::Point point = target.at(u, v);
                const Target::Point found = target.nearest(point.position + 0.02 * point.normal);
                EXPECT_LT((found.position - point.position).norm(), 1e-7);
                const Target::Point back = target.retract(point.position + 0.02 * point.normal, target.at(u, v + 0.02));
                EXPECT_LT((back.position - point.position).norm(), 1e-7);
                EXPECT_LT((back.parameters - point.parameters).norm(), 1e-6);
            }
    EXPECT_TRUE(torus_target(2, 1).boundary().empty());
    EXPECT_EQ(cylinder_target(1, 2).boundary().size(), 2u);
    EXPECT_THROW(torus_target(1, 2), Error);
}

TEST(ParametricTarget, HasTheNormalAndTheDerivativesOfItsSurface) {
    const ParametricTarget targets[] = {torus_target(2, 1), first_modified_torus(), second_modified_torus()};
    const double h = 1e-6;
    for (const ParametricTarget& target : targets) {
        const auto difference = [&](double du, double dv) {
            return Eigen::Vector3d(target.at(0.3 + du, 0.6 + dv).position - target.at(0.3 - du, 0.6 - dv).position);
        };
        const Eigen::Vector3d normal = difference(h, 0).cross(difference(0, h)).normalized();
        EXPECT_LT((normal - target.at(0.3, 0.6).normal).norm(), 1e-8);
    }
}

TEST(ImplicitTarget, ProjectsToAnEllipsoid) {
    const ImplicitTarget target = ellipsoid_target({1, 1, 3});
    const Eigen::Vector3d on(0.6 * std::sin(0.7), 0.6 * std::cos(0.7), 3 * 0.8);
    const Eigen::Vector3d normal = Eigen::Vector3d(on.x(), on.y(), on.z() / 9).normalized();
    const Target::Point found = target.nearest(on + 0.1 * normal);
    EXPECT_LT((found.position - on).norm(), 1e-7);
    EXPECT_LT((found.normal - normal).norm(), 1e-7);
    EXPECT_THROW(ellipsoid_target({1, 0, 1}), Error);
}

TEST(PolylineCurve, RunsByArcLength) {
    Positions square(4, 3);
    square << 0, 0, 1, 2, 0, 1, 2, 2, 1, 0, 2, 1;
    const PolylineCurve closed(square, true), open(square, false);
    EXPECT_DOUBLE_EQ(closed.length(), 8);
    EXPECT_DOUBLE_EQ(open.length(), 6);
    EXPECT_LT((closed.point(7) - Eigen::Vector3d(0, 1, 1)).norm(), 1e-15);
    EXPECT_LT((closed.point(-1) - Eigen::Vector3d(0, 1, 1)).norm(), 1e-15);
    EXPECT_LT((open.point(-1) - Eigen::Vector3d(0, 0, 1)).norm(), 1e-15);
    EXPECT_LT((open.point(9) - Eigen::Vector3d(0, 2, 1)).norm(), 1e-15);
    EXPECT_LT((closed.tangent(3) - Eigen::Vector3d(0, 1, 0)).norm(), 1e-15);
    EXPECT_LT((closed.tangent(2) - Eigen::Vector3d(1, 1, 0).normalized()).norm(), 1e-15);
    EXPECT_LT((closed.tangent(0) - Eigen::Vector3d(1, -1, 0).normalized()).norm(), 1e-15);
    EXPECT_LT((open.tangent(6) - Eigen::Vector3d(-1, 0, 0)).norm(), 1e-15);
    EXPECT_NEAR(closed.nearest({-0.1, 0.5, 3}), 7.5, 1e-15);
    for (double s = 0.1; s < 8; s += 0.3) EXPECT_NEAR(closed.nearest(closed.point(s)), s, 1e-14);
}

TEST(LevelCircle, RunsByArcLength) {
    const LevelCircle circle(2, 1);
    EXPECT_NEAR(circle.length(), 4 * std::numbers::pi, 1e-12);
    EXPECT_NEAR(circle.nearest({0, -3, 7}), 3 * std::numbers::pi, 1e-12);
    EXPECT_LT((circle.point(std::numbers::pi) - Eigen::Vector3d(0, 2, 1)).norm(), 1e-14);
    EXPECT_LT((circle.tangent(std::numbers::pi) - Eigen::Vector3d(-1, 0, 0)).norm(), 1e-14);
}

TEST(PolylineCurve, RefusesPointsThatCoincide) {
    Positions points = Positions::Zero(3, 3);
    points(2, 0) = 1;
    EXPECT_THROW(PolylineCurve(points, false), Error);
    EXPECT_THROW(PolylineCurve(points.topRows(1), false), Error);
}

TEST(PlanarSlideCurve, IsTheCurveOfTheDomain) {
    const PlanarSlideCurve circle(TargetCurve::circle(0, 2));
    EXPECT_NEAR(circle.length(), 4 * std::numbers::pi, 1e-12);
    EXPECT_LT((circle.point(std::numbers::pi) - Eigen::Vector3d(0, 2, 0)).norm(), 1e-14);
    EXPECT_LT((circle.tangent(0) - Eigen::Vector3d(0, 1, 0)).norm(), 1e-14);
    EXPECT_NEAR(circle.nearest({0, 5, 0}), std::numbers::pi, 1e-12);
}

}  // namespace
}  // namespace beltrami
