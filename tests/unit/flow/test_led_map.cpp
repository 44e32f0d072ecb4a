#include <beltrami/flow/led_map.h>

#include <cmath>

#include <gtest/gtest.h>

#include <beltrami/base/error.h>
#include <beltrami/flow/surface_flow.h>
#include <beltrami/generate/grids.h>
#include <beltrami/generate/sphere.h>
#include <beltrami/targets/simple_targets.h>

#include "support/cause_of.h"

namespace beltrami {
namespace {

/// Vertices on a meridian are led to one that is bent by up to so much.
struct Bend {
    Surface source{icosahedral_sphere(4)};
    SphereTarget sphere;
    TargetConstraints constraints;
    TargetMap from, to;

    explicit Bend(double by) {
        Positions wanted = source.mesh.positions;
        for (int v = 0; v < source.mesh.vertex_count(); ++v) {
            const Eigen::Vector3d x = source.mesh.point(v);
            if (std::abs(x.y()) > 0.04 || x.x() < 0 || std::abs(x.z()) > 0.9) continue;
            constraints.fixed.push_back(v);
            const double angle = by * std::sin(3 * x.z()) + x.y();
            wanted.row(v) << std::sqrt(1 - x.z() * x.z()) * std::cos(angle),
                std::sqrt(1 - x.z() * x.z()) * std::sin(angle), x.z();
        }
        from = target_map(source, sphere, {}, source.mesh.positions);
        to = target_map(source, sphere, constraints, wanted);
    }
};

TEST(LedMap, TakesHeldVerticesToTheirPlacesWithoutFolds) {
    for (const double by : {0.05, 0.5}) {
        const Bend bend(by);
        ASSERT_GT(bend.constraints.fixed.size(), 10u);
        if (by > 0.1) {  // at once it folds
            TargetMap at_once = bend.from;
            for (const int v : bend.constraints.fixed) at_once.points[v] = bend.to.points[v];
            EXPECT_FALSE(distortion(bend.source.operators, positions_of(at_once.points), normals_of(at_once.points))
                             .flipped.empty());
        }
        const LedMap led = led_map(bend.source, bend.sphere, bend.constraints, bend.from, bend.to);
        EXPECT_TRUE(led.arrived);
        EXPECT_EQ(led.flips, 0);
        for (const int v : bend.constraints.fixed) EXPECT_EQ(led.map.points[v].position, bend.to.points[v].position);
        EXPECT_TRUE(distortion(bend.source.operators, positions_of(led.map.points), normals_of(led.map.points))
                        .flipped.empty());
    }
}

TEST(LedMap, SaysWhenItDoesNotArrive) {
    // Two vertices cannot change places with all others around them held.
    const Surface source(rectangle(1, 1, 4, 4));
    const PlaneTarget plane;
    TargetConstraints constraints;
    for (int v = 1; v < source.mesh.vertex_count(); ++v) constraints.fixed.push_back(v);
    Positions wanted = source.mesh.positions;
    wanted.row(12).swap(wanted.row(13));
    const TargetMap from = target_map(source, plane, {}, source.mesh.positions),
                    to = target_map(source, plane, constraints, wanted);
    const LedMap led = led_map(source, plane, constraints, from, to);
    EXPECT_FALSE(led.arrived);
    EXPECT_GT(led.flips, 0);
    for (const int v : constraints.fixed) EXPECT_EQ(led.map.points[v].position, to.points[v].position);
}

TEST(LedMap, RefusesMapsOfOtherSources) {
    const Surface source(rectangle(1, 1, 4, 4));
    const PlaneTarget plane;
    const TargetMap map = target_map(source, plane, {}, source.mesh.positions);
    TargetMap other = map;
    other.points.pop_back();
    EXPECT_EQ(test::cause_of([&] { led_map(source, plane, {}, other, map); }), Cause::bad_option);
}

}  // namespace
}  // namespace beltrami
