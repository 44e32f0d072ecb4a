#include <beltrami/teichmuller/extremal_sphere.h>

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <beltrami/base/error.h>
#include <beltrami/generate/grids.h>
#include <beltrami/generate/sphere.h>
#include <beltrami/sphere/moebius_shift.h>

#include "support/cause_of.h"

namespace beltrami {
namespace {

SphereLandmark moved(const Mesh& mesh, int vertex, const Eigen::Vector3d& by) {
    return {vertex, (mesh.point(vertex) + by).normalized()};
}

TEST(ExtremalSphereMap, IsMoebiusWithFewerThanFourLandmarks) {
    const Mesh mesh = icosahedral_sphere(3);
    const Surface surface(mesh);
    const std::vector<SphereLandmark> all{moved(mesh, 0, {.3, 0, .2}), moved(mesh, 5, {0, .4, 0}),
                                          moved(mesh, 9, {-.2, .3, .1})};
    for (std::size_t count = 0; count <= 3; ++count) {
        const std::vector<SphereLandmark> landmarks(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count));
        const ExtremalSphereMap map = extremal_sphere_map(surface, mesh.positions, landmarks);
        EXPECT_TRUE(map.one_to_one());
        EXPECT_EQ(map.termination, Termination::converged);
        EXPECT_EQ(map.k, 0);
        EXPECT_TRUE(map.differential.zero());
        EXPECT_LT(map.distortion.mean, 0.05);  // chordal faces are not Möbius invariant
        for (const SphereLandmark& landmark : landmarks)
            EXPECT_LT((map.positions.row(landmark.vertex).transpose() - landmark.image).norm(), 1e-12);
    }
}

TEST(ExtremalSphereMap, OfMoebiusImagesIsConformal) {
    const Mesh mesh = icosahedral_sphere(3);
    const Positions images = moebius_shifted(mesh.positions, {.2, -.3, .1});
    std::vector<SphereLandmark> landmarks;
    for (const int v : {0, 3, 5, 8, 40}) landmarks.push_back({v, images.row(v)});
    const ExtremalSphereMap map = extremal_sphere_map(Surface(mesh), mesh.positions, landmarks);
    EXPECT_LT(map.k, 2e-3);
    EXPECT_LT((map.positions - images).rowwise().norm().maxCoeff(), 0.03);  // chordal faces, edges of 0.15
}

TEST(ExtremalSphereMap, ItsDifferentialIsKnownAtAllPlaces) {
    const Mesh mesh = icosahedral_sphere(3);
    const Surface surface(mesh);
    std::vector<SphereLandmark> landmarks;
    for (const int v : {0, 3, 5, 8}) landmarks.push_back(moved(mesh, v, {.1, .05 * v, -.1}));
    const ExtremalSphereMap map = extremal_sphere_map(surface, mesh.positions, landmarks);
    EXPECT_EQ(map.differential.poles, (std::vector<int>{0, 3, 5, 8}));
    // Away from the poles a sample is the mean of three points.
    int compared = 0;
    for (int f = 0; f < mesh.face_count(); f += 7) {
        const auto v = mesh.faces[f];
        std::array<MeshPoint, 3> inside;
        for (int i = 0; i < 3; ++i) {
            inside[i] = {f, {v[0], v[1], v[2]}, {1. / 6, 1. / 6, 1. / 6}};
            inside[i].barycentric[i] = 2. / 3;
        }
        double nearest = 2;
        for (const SphereLandmark& landmark : landmarks)
            nearest = std::min(nearest, (mesh.point(v[0]) - mesh.point(landmark.vertex)).norm());
        if (nearest < 0.7) continue;
        ++compared;
        const Complex there = map.differential.at(surface, inside).mean();
        EXPECT_LT(std::abs(there - map.phi[f]), 1e-10 * std::abs(there));
    }
    EXPECT_GT(compared, 20);
}

TEST(ExtremalSphereMap, GoesOnFromAStart) {
    const Mesh mesh = icosahedral_sphere(3);
    const Surface surface(mesh);
    std::vector<SphereLandmark> landmarks;
    for (const int v : {0, 3, 5, 8, 11}) landmarks.push_back(moved(mesh, v, {.1, .05 * v, -.1}));
    const ExtremalSphereMap map = extremal_sphere_map(surface, mesh.positions, landmarks);
    ExtremalSphereOptions options;
    options.start = map.positions;
    const ExtremalSphereMap again = extremal_sphere_map(surface, mesh.positions, landmarks, options);
    EXPECT_NEAR(again.k, map.k, 1e-5);
    EXPECT_LE(again.iterations, map.iterations);
}

TEST(ExtremalSphereMap, WaypointsChooseAClass) {
    // A landmark is led half around another one, this way or that way: mirror images of each other.
    const Mesh mesh = octahedral_sphere(6);
    const Surface surface(mesh);
    const auto nearest = [&](const Eigen::Vector3d& point) {
        Eigen::Index vertex = 0;
        (mesh.positions.rowwise() - point.normalized().transpose()).rowwise().norm().minCoeff(&vertex);
        return static_cast<int>(vertex);
    };
    const Eigen::Vector3d pole(0, 0, 1);
    const int led = nearest({std::sin(0.7), 0, std::cos(0.7)});
    const auto turned = [&](double angle) { return Eigen::Vector3d(Eigen::AngleAxisd(angle, pole) * mesh.point(led)); };
    std::vector<SphereLandmark> landmarks{{nearest(pole), pole}, {led, turned(std::numbers::pi)}};
    for (int i = 0; i < 6; ++i) {
        const double angle = i * std::numbers::pi / 3;
        const int v = nearest({std::cos(angle), std::sin(angle), -0.5});
        landmarks.push_back({v, mesh.point(v)});
    }
    const auto way = [&](double whole) {
        ExtremalSphereOptions options;
        for (int stop = 1; stop < 8; ++stop) {
            Positions at = Positions::Constant(8, 3, std::numeric_limits<double>::quiet_NaN());
            at.row(1) = turned(whole * stop / 8);
            options.waypoints.push_back(at);
        }
        return extremal_sphere_map(surface, mesh.positions, landmarks, options);
    };
    const ExtremalSphereMap left = way(std::numbers::pi), right = way(-std::numbers::pi);
    EXPECT_TRUE(left.one_to_one());
    EXPECT_TRUE(right.one_to_one());
    EXPECT_GT(left.k, 0.2);
    EXPECT_NEAR(left.k, right.k, 5e-3);
    EXPECT_GT((left.positions - right.positions).rowwise().norm().maxCoeff(), 0.5);
}

TEST(ExtremalSphereMap, RefusesWhatCannotBe) {
    const Mesh mesh = icosahedral_sphere(2);
    const Surface surface(mesh);
    const auto solve = [&](const std::vector<SphereLandmark>& landmarks) {
        return extremal_sphere_map(surface, mesh.positions, landmarks);
    };
    const auto at = [&](int v) { return SphereLandmark{v, mesh.point(v)}; };
    EXPECT_EQ(test::cause_of([&] { solve({at(0), at(1), at(2), at(0)}); }), Cause::bad_boundary);
    EXPECT_EQ(test::cause_of([&] { solve({at(0), at(1), at(2), {3, mesh.point(2)}}); }), Cause::bad_boundary);
    EXPECT_EQ(test::cause_of([&] { solve({{1000, mesh.point(2)}}); }), Cause::bad_boundary);
    EXPECT_EQ(test::cause_of([&] { solve({{1, {0, 0, 0}}}); }), Cause::bad_boundary);
    // Nearer to each other than 1e-3.
    EXPECT_EQ(test::cause_of([&] {
                  solve({at(0), at(1), at(2), {3, mesh.point(2) + Eigen::Vector3d(0, 5e-4, 0)}});
              }),
              Cause::bad_boundary);
    // Images that swap neighbours fold a coarse mesh.
    EXPECT_EQ(test::cause_of([&] {
                  std::vector<SphereLandmark> swapped;
                  for (int v = 0; v < 40; ++v) swapped.push_back({v, mesh.point(v % 2 ? v - 1 : v + 1)});
                  solve(swapped);
              }),
              Cause::bad_boundary);
    const Mesh open = rectangle(1, 1, 4, 4);
    EXPECT_EQ(test::cause_of([&] {
                  Positions points = Positions::Zero(open.vertex_count(), 3);
                  extremal_sphere_map(Surface(open), points, {});
              }),
              Cause::bad_mesh);
    EXPECT_EQ(test::cause_of([&] { extremal_sphere_map(surface, mesh.positions.topRows(3), {}); }), Cause::bad_option);
}

}  // namespace
}  // namespace beltrami
