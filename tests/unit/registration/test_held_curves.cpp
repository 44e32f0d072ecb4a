#include <beltrami/registration/held_curves.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <beltrami/base/error.h>
#include <beltrami/flow/led_map.h>
#include <beltrami/flow/surface_flow.h>
#include <beltrami/generate/grids.h>
#include <beltrami/generate/sphere.h>
#include <beltrami/operators/frames.h>
#include <beltrami/registration/surface_landmarks.h>
#include <beltrami/targets/mesh_target.h>
#include <beltrami/targets/simple_targets.h>

#include "support/cause_of.h"

namespace beltrami {
namespace {

CurveThrough through(const Mesh& mesh, const std::vector<int>& vertices, bool closed = false) {
    CurveThrough curve{{}, closed};
    for (const int v : vertices) curve.points.push_back(place_of_vertex(mesh, v));
    return curve;
}

int nearest(const Mesh& mesh, const Eigen::Vector3d& to) {
    int best = 0;
    for (int v = 1; v < mesh.vertex_count(); ++v)
        if ((mesh.point(v) - to).norm() < (mesh.point(best) - to).norm()) best = v;
    return best;
}

/// A curve of the sphere that is led to an arc of a great circle.
TEST(HeldCurves, GoToGreatCirclesAndSlideThere) {
    const Surface source(icosahedral_sphere(4));
    const SphereTarget sphere;
    double energies[2];
    for (const bool slides : {true, false}) {
        const std::vector<int> points{nearest(source.mesh, {.9, 0, .4}), nearest(source.mesh, {.7, .6, .6}),
                                      nearest(source.mesh, {0, .9, .3})};
        CurveOnto curve{through(source.mesh, points), {}, slides};
        for (const Eigen::Vector3d& p : {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(1, .3, 0), Eigen::Vector3d(0, 1, 0)})
            curve.target.push_back(sphere.nearest(p));
        HeldCurves held = held_curves(source.mesh, sphere, std::array{curve}, source.mesh.positions);
        EXPECT_EQ(held.constraints.sliding.empty(), !slides);
        const Surface divided(held.source.mesh);
        const LedMap led = led_map(divided, sphere, held.constraints, {nearest_points(sphere, held.start), {}},
                                   target_map(divided, sphere, held.constraints, held.wanted));
        ASSERT_TRUE(led.arrived);
        ASSERT_EQ(led.flips, 0);
        const SurfaceFlowMap flow = least_lp_map(divided, sphere, {2, {}}, held.constraints, led.map);
        EXPECT_TRUE(flow.distortion.flipped.empty());
        for (const int v : held.source.curves[0].vertices) {
            const Eigen::Vector3d p = flow.map.points[v].position;
            EXPECT_LT(std::abs(p.z()), 1e-12);
            EXPECT_GT(std::min(p.x(), p.y()), -1e-12);
        }
        energies[slides ? 0 : 1] = flow.history.back().energy;
        const auto& given = held.source.curves[0];
        EXPECT_LT((flow.map.points[given.vertices.back()].position - Eigen::Vector3d::UnitY()).norm(), 1e-12);
        if (!slides) {
            EXPECT_LT((flow.map.points[given.vertices[given.given[1]]].position - curve.target[1].position).norm(),
                      1e-12);
        }
    }
    EXPECT_LT(energies[0], energies[1]);
}

TEST(HeldCurves, OfAMeshFollowItsGeodesics) {
    const Surface source(torus(2, 1, 32, 16));
    const MeshTarget target(torus(2, 1, 48, 24));
    CurveOnto curve{through(source.mesh, {nearest(source.mesh, {3, 0, 0}), nearest(source.mesh, {0, 3, 0})}), {}, true};
    curve.target = {target.nearest({2, 0, 1}), target.nearest({0, 2, 1})};
    const HeldCurves held = held_curves(source.mesh, target, std::array{curve}, source.mesh.positions);
    const auto& chain = held.source.curves[0];
    EXPECT_LT((held.wanted.row(chain.vertices.front()) - Eigen::RowVector3d(2, 0, 1)).norm(), 1e-9);
    for (const int v : chain.vertices) {
        const Eigen::Vector3d p = held.wanted.row(v);
        EXPECT_LT((target.nearest(p).position - p).norm(), 1e-12);
    }
    // The source's own vertices stay.
    for (int v = 0; v < source.mesh.vertex_count(); ++v) EXPECT_EQ(held.start.row(v), source.mesh.positions.row(v));
}

/// A coefficient that is constant in the plane stays so however faces are divided and framed.
TEST(HeldCurves, CoefficientsPassToDividedFaces) {
    for (const Cells cells : {Cells::triangles, Cells::quads}) {
        Mesh mesh = rectangle(2, 1, 12, 6, cells);
        Positions tilted(mesh.vertex_count(), 3);
        for (int v = 0; v < mesh.vertex_count(); ++v)
            tilted.row(v) << mesh.positions(v, 0), .6 * mesh.positions(v, 1), .8 * mesh.positions(v, 1);
        const Surface flat(mesh);
        mesh.positions = tilted;
        const Surface source(mesh);
        const Complex wanted(0.3, -0.2);
        const auto along_edges = [&](const Mesh& of, int face) {  // the frame of the plane to that of the first edge
            const Eigen::Vector3d edge = of.point(of.faces[face][1]) - of.point(of.faces[face][0]);
            return wanted *
                   std::polar(1.0, -2 * std::atan2(std::hypot(edge.y(), edge.z()) * (edge.y() < 0 ? -1 : 1), edge.x()));
        };
        Eigen::VectorXcd mu(source.operators.sample_count());
        const Eigen::VectorXcd directions = first_edge_directions(source);
        for (int s = 0; s < mu.size(); ++s)
            mu[s] = along_edges(source.mesh, source.operators.faces[s]) * directions[s] * directions[s];
        const MeshWithCurves divided = mesh_with_curves(source.mesh, std::array{through(source.mesh, {8, 81})});
        ASSERT_GT(divided.mesh.face_count(), source.mesh.face_count());
        const Surface with_curves(divided.mesh);
        const Eigen::VectorXcd passed = mu_along_curves(source, divided, with_curves, mu);
        const Eigen::VectorXcd there = first_edge_directions(with_curves);
        for (int s = 0; s < passed.size(); ++s) {
            const Complex expected =
                along_edges(with_curves.mesh, with_curves.operators.faces[s]) * there[s] * there[s];
            EXPECT_LT(std::abs(passed[s] - expected), 1e-12);
        }
    }
}

TEST(HeldCurves, RefuseWhatCannotBe) {
    const Surface source(icosahedral_sphere(2));
    const SphereTarget sphere;
    const CurveThrough curve = through(source.mesh, {0, 5});
    const auto cause = [&](const std::vector<CurveOnto>& curves, const Positions& start) {
        return test::cause_of([&] { held_curves(source.mesh, sphere, curves, start); });
    };
    const Target::Point a = sphere.nearest({1, 0, 0}), b = sphere.nearest({0, 1, 0}), c = sphere.nearest({-1, 0, 0});
    const Positions& start = source.mesh.positions;
    EXPECT_EQ(cause({{curve, {a}}}, start), Cause::bad_boundary);                      // fewer points
    EXPECT_EQ(cause({{curve, {a, a}}}, start), Cause::bad_boundary);                   // that coincide
    EXPECT_EQ(cause({{curve, {a, c}}}, start), Cause::bad_boundary);                   // opposite to each other
    EXPECT_EQ(cause({{curve, {a, b}}, {curve, {b, c}}}, start), Cause::bad_boundary);  // that touch
    EXPECT_EQ(cause({{curve, {a, b}}}, start.topRows(3)), Cause::bad_option);
}

}  // namespace
}  // namespace beltrami
