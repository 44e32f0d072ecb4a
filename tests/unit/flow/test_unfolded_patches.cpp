#include <beltrami/flow/unfolded_patches.h>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <beltrami/flow/averaged_patches.h>
#include <beltrami/flow/surface_flow.h>
#include <beltrami/generate/grids.h>
#include <beltrami/generate/sphere.h>
#include <beltrami/solve/target_step.h>
#include <beltrami/targets/parametric_target.h>
#include <beltrami/targets/simple_targets.h>

namespace beltrami {
namespace {

TEST(UnfoldFlippedPatches, OpensWhatMeansDoNotBesideVerticesThatStay) {
    // The vertex 20 of a grid is held far across its neighbours, so that the rim of its star is no convex polygon.
    const Surface source(rectangle(1, 1, 10, 10));
    const PlaneTarget plane;
    TargetMap map = target_map(source, plane, {}, source.mesh.positions);
    std::vector<char> held(map.points.size(), 0);
    const int pulled = 11 * 5 + 5;
    held[pulled] = 1;
    map.points[pulled].position += Eigen::Vector3d(0.27, 0.13, 0);
    const Eigen::Vector3d wanted = map.points[pulled].position;
    const int before = flipped_samples(source.operators, map);
    ASSERT_GT(before, 2);
    EXPECT_EQ(unfold_flipped_patches(source, plane, held, map), 0);
    EXPECT_EQ(flipped_samples(source.operators, map), 0);
    EXPECT_EQ(map.points[pulled].position, wanted);
    for (const int v : source.topology.boundary_loops[0])
        EXPECT_EQ(map.points[v].position, Eigen::Vector3d(source.mesh.point(v)));
}

TEST(UnfoldFlippedPatches, AlongCurvedTargets) {
    const Surface source(icosahedral_sphere(4));
    const SphereTarget sphere;
    const ParametricTarget torus = torus_target(2, 1);
    for (const double by : {0.2, 0.5}) {
        TargetMap map = target_map(source, sphere, {}, source.mesh.positions);
        std::vector<char> held(map.points.size(), 0);
        held[100] = 1;
        map.points[100] = sphere.nearest(map.points[100].position + by * map.points[100].normal.unitOrthogonal());
        ASSERT_GT(flipped_samples(source.operators, map), 0);
        EXPECT_EQ(unfold_flipped_patches(source, sphere, held, map), 0);
        for (const Target::Point& point : map.points) EXPECT_NEAR(point.position.norm(), 1, 1e-12);
    }
    const Surface around(beltrami::torus(2, 1, 48, 24));
    TargetMap map = target_map(around, torus, {}, around.mesh.positions);
    std::vector<char> held(map.points.size(), 0);
    held[500] = 1;
    map.points[500] = torus.nearest(map.points[500].position + 0.5 * map.points[500].normal.unitOrthogonal());
    ASSERT_GT(flipped_samples(around.operators, map), 0);
    EXPECT_EQ(unfold_flipped_patches(around, torus, held, map), 0);
}

TEST(UnfoldFlippedPatches, LeavesWhatIsForced) {
    // A face whose three vertices stay, turned over: its flip stays, and no other comes.
    const Surface source(rectangle(1, 1, 6, 6));
    const PlaneTarget plane;
    TargetMap map = target_map(source, plane, {}, source.mesh.positions);
    std::vector<char> held(map.points.size(), 0);
    const auto face = source.mesh.faces[30];
    for (const int v : face) held[v] = 1;
    std::swap(map.points[face[0]].position, map.points[face[1]].position);
    const int before = flipped_samples(source.operators, map);
    const int left = unfold_flipped_patches(source, plane, held, map);
    EXPECT_GE(left, 1);
    EXPECT_LE(left, before);
    EXPECT_EQ(flipped_samples(source.operators, map), left);
    // A flow from there does not call it converged.
    TargetConstraints constraints;
    constraints.fixed.assign(face.begin(), face.end());
    const SurfaceFlowMap flow =
        surface_flow(source, plane, Eigen::VectorXcd::Zero(source.operators.sample_count()), constraints, map);
    EXPECT_FALSE(flow.distortion.flipped.empty());
    EXPECT_NE(flow.termination, Termination::converged);
    EXPECT_FALSE(flow.warnings.empty());
}

}  // namespace
}  // namespace beltrami
