// Extremal maps of the sphere with landmarks, in closed form.
#include <gtest/gtest.h>

#include <cmath>
#include <ostream>

#include <Eigen/Geometry>

#include "problems/sphere_landmarks.h"

namespace beltrami {
namespace {

ExtremalSphereMap solved(const bench::SphereLandmarks& problem) {
    return extremal_sphere_map(Surface(problem.mesh), problem.mesh.positions, problem.landmarks);
}

void expect_sound(const ExtremalSphereMap& map, const bench::SphereLandmarks& problem) {
    EXPECT_TRUE(map.one_to_one());
    EXPECT_EQ(map.termination, Termination::converged);
    for (const SphereLandmark& landmark : problem.landmarks)
        EXPECT_LT((map.positions.row(landmark.vertex).transpose() - landmark.image).norm(), 1e-15);
    EXPECT_EQ(map.dimension, static_cast<int>(problem.landmarks.size()) - 3);
    EXPECT_LE(map.K_lower, map.K);
    EXPECT_LE(map.K, map.K_max);
}

/// What the error of k and the deviation of |μ| weighted by |φ| may be at 2048 and 8192 faces.
struct Known {
    const char* name;
    double k;
    bench::SphereLandmarks (*problem)(int levels);
    double error[2], deviation[2];
};
void PrintTo(const Known& known, std::ostream* out) {
    *out << known.name;
}

class SphereOracle : public testing::TestWithParam<Known> {};

TEST_P(SphereOracle, HasTheKnownK) {
    const Known& known = GetParam();
    for (int level = 4; level <= 5; ++level) {
        const bench::SphereLandmarks problem = known.problem(level);
        EXPECT_NEAR(problem.exact_k, known.k, 6e-6);
        const ExtremalSphereMap map = solved(problem);
        expect_sound(map, problem);
        EXPECT_LE(std::abs(map.k - problem.exact_k), known.error[level - 4]) << known.name << " " << level;
        EXPECT_LE(map.weighted_deviation, known.deviation[level - 4]) << known.name << " " << level;
    }
}

using bench::eight_landmarks;
using bench::four_landmarks;

INSTANTIATE_TEST_SUITE_P(
    Landmarks, SphereOracle,
    testing::Values(
        Known{"four_small", .05934, [](int l) { return four_landmarks(l, 1); }, {1e-6, 3e-7}, {.016, .0084}},
        Known{"four", .23220, [](int l) { return four_landmarks(l, 2); }, {2e-5, 9e-6}, {.0415, .0233}},
        Known{"four_large", .05748, [](int l) { return four_landmarks(l, 4); }, {1e-6, 3e-7}, {.0357, .0207}},
        Known{"eight_small",
              .13144,
              [](int l) {
                  return eight_landmarks(l, {.6, 1.5, .3}, {.7, 1.3, .55});
              },
              {7e-6, 6e-7},
              {.0108, .0070}},
        Known{"eight",
              .27385,
              [](int l) {
                  return eight_landmarks(l, {.6, 1.5, .3}, {.8, 1.2, .9});
              },
              {4e-5, 2.4e-5},
              {.0232, .0147}},
        Known{"eight_large",
              .38514,
              [](int l) {
                  return eight_landmarks(l, {.6, 1.5, .2}, {.9, 1.1, 1.0});
              },
              {1.7e-4, 8e-5},
              {.0328, .0213}}),
    [](const auto& test) { return std::string(test.param.name); });

TEST(SphereLandmarks, TheInverseHasTheSameK) {
    const bench::TwoRings here{.6, 1.5, .3}, there{.8, 1.2, .9};
    const ExtremalSphereMap map = solved(eight_landmarks(5, here, there)),
                            back = solved(eight_landmarks(5, there, here));
    EXPECT_NEAR(map.k, back.k, 3e-4);
}

TEST(SphereLandmarks, TurningAndRenumberingChangesNothing) {
    const bench::SphereLandmarks problem = eight_landmarks(3, {.6, 1.5, .3}, {.7, 1.3, .55});
    const double k = solved(problem).k;
    bench::SphereLandmarks turned = problem;
    const Eigen::Matrix3d rotation = Eigen::AngleAxisd(2.0, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
    turned.mesh.positions *= rotation.transpose();
    EXPECT_NEAR(solved(turned).k, k, 1e-7);  // the images have stayed
    for (SphereLandmark& landmark : turned.landmarks) landmark.image = rotation * landmark.image;
    EXPECT_NEAR(solved(turned).k, k, 1e-7);
    // Vertices and faces in reverse order, corners turned, landmarks in reverse order.
    bench::SphereLandmarks renumbered = problem;
    const int last = problem.mesh.vertex_count() - 1;
    renumbered.mesh.positions = problem.mesh.positions.colwise().reverse();
    renumbered.mesh.faces = {};
    for (int f = problem.mesh.face_count() - 1; f >= 0; --f) {
        const auto v = problem.mesh.faces[f];
        renumbered.mesh.faces.add({last - v[1], last - v[2], last - v[0]});
    }
    renumbered.landmarks.assign(problem.landmarks.rbegin(), problem.landmarks.rend());
    for (SphereLandmark& landmark : renumbered.landmarks) landmark.vertex = last - landmark.vertex;
    EXPECT_NEAR(solved(renumbered).k, k, 2e-6);
}

}  // namespace
}  // namespace beltrami
