#include <beltrami/registration/register_spheres.h>

#include <cmath>

#include <gtest/gtest.h>

#include <beltrami/base/error.h>
#include <beltrami/generate/grids.h>
#include <beltrami/generate/sphere.h>
#include <beltrami/registration/sphere_locator.h>

#include "support/cause_of.h"
#include "support/registration.h"

namespace beltrami {
namespace {

using test::bumpy_ball;
using test::landmarks_between;

TEST(SphereLocator, FindsWhatItsPlacesAre) {
    const Mesh mesh = icosahedral_sphere(3);
    const SphereLocator locator(mesh.faces, mesh.positions);
    for (int f = 0; f < mesh.face_count(); f += 3) {
        const auto v = mesh.faces[f];
        const MeshPoint place{f, {v[0], v[1], v[2]}, {0.5, 0.3, 0.2}};
        const MeshPoint found = locator.locate(sphere_place(mesh.positions, place));
        EXPECT_EQ(found.face, f);
        for (int i = 0; i < 3; ++i) {
            EXPECT_EQ(found.vertices[i], place.vertices[i]);
            EXPECT_NEAR(found.barycentric[i], place.barycentric[i], 1e-12);
        }
    }
    // Vertices belong to several faces: any will do.
    const std::vector<MeshPoint> places = locator.locate(mesh.positions);
    for (int v = 0; v < mesh.vertex_count(); ++v)
        EXPECT_LT((sphere_place(mesh.positions, places[v]) - mesh.point(v)).norm(), 1e-12);
}

TEST(RegisterSpheres, OfASurfaceOntoItselfIsTheIdentity) {
    const Mesh mesh = bumpy_ball(3, 0.4);
    const Surface surface(mesh);
    const SphereRegistration found =
        register_spheres(surface, surface, landmarks_between(mesh, {{0, 0}, {1, 1}, {2, 2}, {3, 3}, {7, 7}}));
    EXPECT_LT(found.map.k, 1e-4);
    EXPECT_LT((found.positions - mesh.positions).rowwise().norm().maxCoeff(), 5e-3);  // edges of 0.3
    EXPECT_TRUE(found.in_space.flipped.empty());
    EXPECT_TRUE(found.unresolved.empty());
}

TEST(RegisterSpheres, MeetsLandmarksAndKnowsItsInverse) {
    const Surface source(bumpy_ball(4, 0)), target(bumpy_ball(4, 1));
    const Mesh ball = icosahedral_sphere(4);
    int beside = 0;
    while (std::abs((ball.point(beside) - ball.point(4)).norm() - 0.2) > 0.05) ++beside;
    const std::vector<std::array<int, 2>> pairs{{0, 0}, {1, 1}, {2, 2}, {3, 3}, {4, beside}, {7, 7}};
    std::vector<std::array<int, 2>> reversed;
    for (const auto& [a, b] : pairs) reversed.push_back({b, a});
    const SphereRegistration there = register_spheres(source, target, landmarks_between(target.mesh, pairs)),
                             back = register_spheres(target, source, landmarks_between(source.mesh, reversed));
    EXPECT_TRUE(there.map.one_to_one());
    for (const auto& [a, b] : pairs)
        EXPECT_LT((there.positions.row(a).transpose() - target.mesh.point(b)).norm(), 1e-14);
    EXPECT_GT(there.map.k, 0.02);
    EXPECT_NEAR(there.map.k, back.map.k, 4e-3);
    ASSERT_TRUE(there.inverse_k);
    EXPECT_NEAR(*there.inverse_k, back.map.k, 2e-3);
}

TEST(RegisterSpheres, SoftLandmarksBalance) {
    const Surface source(bumpy_ball(3, 0)), target(bumpy_ball(3, 1));
    std::vector<SurfaceLandmark> landmarks =
        landmarks_between(target.mesh, {{0, 0}, {1, 1}, {2, 2}, {3, 3}, {4, 60}, {7, 7}});
    const double hard = register_spheres(source, target, landmarks).map.k;
    double last_k = hard, last_distance = 0;
    for (const double weight : {1e3, 1e1}) {
        landmarks[4].weight = weight;
        const SphereRegistration soft = register_spheres(source, target, landmarks);
        EXPECT_TRUE(soft.map.one_to_one());
        EXPECT_LT(soft.map.k, last_k);
        ASSERT_TRUE(soft.largest_distance);
        EXPECT_GT(*soft.largest_distance, last_distance);
        last_k = soft.map.k;
        last_distance = *soft.largest_distance;
    }
    EXPECT_LT(last_k, 0.9 * hard);
}

TEST(RegisterSpheres, NamesTheSurfaceThatCannotBe) {
    const Surface ball(bumpy_ball(2, 0)), ring(torus(2, 1, 12, 8));
    EXPECT_EQ(test::cause_of([&] { register_spheres(ball, ring, {}); }), Cause::bad_mesh);
    try {
        register_spheres(ball, ring, {});
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("the target: the surface has genus 1"), std::string::npos);
    }
    RegistrationOptions options;
    options.waypoints = {{1, 3, place_of_vertex(ball.mesh, 3)}};
    EXPECT_EQ(test::cause_of([&] { register_spheres(ball, ball, {}, options); }), Cause::bad_option);
}

TEST(RegisterSpheres, RefusesALandmarkInsideALimb) {
    // A ball with a spike: half of its length is a speck on the sphere.
    Mesh mesh = icosahedral_sphere(4);
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        const Eigen::Vector3d p = mesh.point(v);
        const double off = std::hypot(p.x(), p.y());
        if (p.z() > 0 && off < 0.3) mesh.positions(v, 2) += 3 * std::pow(1 - off / 0.3, 1.5);
    }
    const Surface surface(mesh);
    int tip = 0;
    for (int v = 0; v < mesh.vertex_count(); ++v)
        if (mesh.positions(v, 2) > mesh.positions(tip, 2)) tip = v;
    try {
        register_spheres(surface, surface, landmarks_between(mesh, {{0, 0}, {1, 1}, {2, 2}, {3, 3}, {tip, tip}}));
        ADD_FAILURE();
    } catch (const Error& error) {
        EXPECT_EQ(error.cause(), Cause::bad_boundary);
        EXPECT_NE(std::string(error.what()).find("thin limb"), std::string::npos) << error.what();
    }
}

}  // namespace
}  // namespace beltrami
