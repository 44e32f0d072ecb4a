#include <beltrami/flow/extremal_flow.h>

#include <cmath>

#include <gtest/gtest.h>

#include <beltrami/base/error.h>
#include <beltrami/flow/surface_flow.h>
#include <beltrami/generate/round_domains.h>
#include <beltrami/targets/simple_targets.h>

#include "problems/sphere_landmarks.h"
#include "support/cause_of.h"

namespace beltrami {
namespace {

/// The unit disk onto itself, the circle |z| = 1/2 sliding along |z| = .6. The extremal map is z|z|^(1/K − 1) in the
/// ring outside and conformal inside; its K is the ratio of the two rings' moduli.
struct CircleInDisk {
    Surface source;
    PlaneTarget plane;
    TargetConstraints constraints;
    TargetMap start;

    static double exact_k() { return k_of(std::log(0.5) / std::log(0.6)); }

    explicit CircleInDisk(int rings) : source(disk(rings)) {
        std::vector<int> inner;
        Positions to = Positions::Zero(source.mesh.vertex_count(), 3);
        for (int v = 0; v < source.mesh.vertex_count(); ++v) {
            const Eigen::Vector3d z = source.mesh.point(v);
            const double r = z.norm();
            if (std::abs(r - 0.5) < 1e-9) inner.push_back(v);
            if (r > 0) to.row(v) = z.transpose() / r * (r <= 0.5 ? 1.2 * r : 1 - 0.8 * (1 - r));
        }
        std::vector<int> rim = source.topology.boundary_loops[0];
        constraints.fixed = {0, rim.back()};  // neither slides around
        rim.pop_back();
        constraints.slide(rim, std::make_shared<LevelCircle>(1, 0));
        constraints.slide(inner, std::make_shared<LevelCircle>(0.6, 0));
        start = target_map(source, plane, constraints, to);
    }
};

TEST(ExtremalFlow, FindsKOfACircleThatSlides) {
    double last = 0;
    for (const int rings : {12, 24}) {
        const CircleInDisk problem(rings);
        const ExtremalFlowMap found = extremal_flow(problem.source, problem.plane, problem.constraints, problem.start);
        const double error = std::abs(found.k - CircleInDisk::exact_k());
        EXPECT_LE(found.K_lower, found.K);
        EXPECT_LT(error, 0.012) << rings;
        if (last > 0) {
            EXPECT_LT(error, 0.7 * last);
        }
        last = error;
        // The least squares map is farther off.
        const SurfaceFlowMap even =
            least_lp_map(problem.source, problem.plane, {2, {}}, problem.constraints, problem.start);
        EXPECT_LT(found.standard_deviation, 0.03);
        const Distortion of_found =
            distortion(problem.source.operators, positions_of(found.map.points), normals_of(found.map.points));
        EXPECT_GT(even.distortion.max, of_found.max);
        // φ is 0 where the map is conformal: weights there fall to the floor.
        double inside = 0;
        for (int s = 0; s < problem.source.operators.sample_count(); ++s) {
            const auto corners = problem.source.mesh.faces[problem.source.operators.faces[s]];
            double r = 0;
            for (const int v : corners) r = std::max(r, problem.source.mesh.point(v).norm());
            if (r < 0.4) inside += found.weights[s];
        }
        EXPECT_LT(inside, 0.1 * 0.16 * problem.source.operators.area());
    }
}

TEST(ExtremalFlow, FindsKOfLandmarksWithoutTheirDifferentials) {
    const bench::SphereLandmarks problem = bench::eight_landmarks(4, {.6, 1.5, .3}, {.8, 1.2, .9});
    const Surface source(problem.mesh);
    ExtremalSphereOptions once;
    once.max_iterations = 1;
    const Positions start = extremal_sphere_map(source, problem.mesh.positions, problem.landmarks, once).start;
    const SphereTarget sphere;
    TargetConstraints constraints;
    for (const SphereLandmark& landmark : problem.landmarks) constraints.fixed.push_back(landmark.vertex);
    const TargetMap from = target_map(source, sphere, constraints, start);
    const ExtremalFlowMap found = extremal_flow(source, sphere, constraints, from);
    EXPECT_NEAR(found.k, problem.exact_k, 0.01);
    EXPECT_LT(found.standard_deviation, 0.05);
}

TEST(ExtremalFlow, RefusesWhatIsNoStart) {
    const CircleInDisk problem(6);
    TargetMap wrong = problem.start;
    wrong.points.pop_back();
    EXPECT_EQ(test::cause_of([&] { extremal_flow(problem.source, problem.plane, problem.constraints, wrong); }),
              Cause::bad_option);
    TargetMap folded = problem.start;
    std::swap(folded.points[1].position, folded.points[4].position);
    EXPECT_EQ(test::cause_of([&] { extremal_flow(problem.source, problem.plane, problem.constraints, folded); }),
              Cause::bad_option);
    ExtremalFlowOptions options;
    options.max_iterations = 0;
    EXPECT_EQ(test::cause_of(
                  [&] { extremal_flow(problem.source, problem.plane, problem.constraints, problem.start, options); }),
              Cause::bad_option);
    options.max_iterations = 5;
    options.progress = [](int, double) { return false; };
    EXPECT_EQ(test::cause_of(
                  [&] { extremal_flow(problem.source, problem.plane, problem.constraints, problem.start, options); }),
              Cause::cancelled);
}

}  // namespace
}  // namespace beltrami
