#include <beltrami/registration/register_spheres.h>

#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include <beltrami/base/error.h>
#include <beltrami/charts/chart_places.h>
#include <beltrami/generate/grids.h>
#include <beltrami/generate/sphere.h>
#include <beltrami/registration/overlay.h>
#include <beltrami/registration/sphere_locator.h>
#include <beltrami/registration/transfer.h>

#include "support/cause_of.h"

namespace beltrami {
namespace {

Mesh bumpy(int levels, double phase) {
    Mesh mesh = icosahedral_sphere(levels);
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        const Eigen::Vector3d p = mesh.point(v);
        mesh.positions.row(v) *= 1 + 0.2 * std::sin(3 * p.x() + phase) + 0.1 * p.y();
    }
    return mesh;
}

std::vector<SurfaceLandmark> landmarks_between(const Mesh& target, const std::vector<std::array<int, 2>>& pairs) {
    std::vector<SurfaceLandmark> landmarks;
    for (const auto& [a, b] : pairs) landmarks.push_back({a, place_of_vertex(target, b)});
    return landmarks;
}

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
    const Mesh mesh = bumpy(3, 0.4);
    const Surface surface(mesh);
    const SphereRegistration found =
        register_spheres(surface, surface, landmarks_between(mesh, {{0, 0}, {1, 1}, {2, 2}, {3, 3}, {7, 7}}));
    EXPECT_LT(found.map.k, 1e-4);
    EXPECT_LT((found.positions - mesh.positions).rowwise().norm().maxCoeff(), 5e-3);  // edges of 0.3
    EXPECT_TRUE(found.in_space.flipped.empty());
    EXPECT_TRUE(found.unresolved.empty());
}

TEST(RegisterSpheres, MeetsLandmarksAndKnowsItsInverse) {
    const Surface source(bumpy(4, 0)), target(bumpy(4, 1));
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
    const Surface source(bumpy(3, 0)), target(bumpy(3, 1));
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
    const Surface ball(bumpy(2, 0)), ring(torus(2, 1, 12, 8));
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

TEST(SurfaceCorrespondence, ComesBackToWhereItBegan) {
    const Surface source(bumpy(3, 0)), target(bumpy(4, 1));
    const SphereRegistration found =
        register_spheres(source, target, landmarks_between(target.mesh, {{0, 0}, {1, 1}, {2, 2}, {3, 3}, {4, 4}}));
    const SurfaceCorrespondence map(source.mesh, target.mesh, found.target_sphere.positions, found.places);
    std::vector<MeshPoint> places;
    for (int f = 0; f < source.mesh.face_count(); f += 5) {
        const auto v = source.mesh.faces[f];
        places.push_back({f, {v[0], v[1], v[2]}, {0.2, 0.3, 0.5}});
    }
    const std::vector<MeshPoint> again = map.back(map.forward(places));
    EXPECT_LT((positions_on(source.mesh, again) - positions_on(source.mesh, places)).rowwise().norm().maxCoeff(), 1e-9);
    // Constants stay, and a vertex that is a landmark keeps its value.
    Positions values(source.mesh.vertex_count(), 2);
    values.col(0).setConstant(3);
    for (int v = 0; v < values.rows(); ++v) values(v, 1) = v;
    const Positions there = transferred_vertex_values(map, values);
    EXPECT_LT((there.col(0).array() - 3).abs().maxCoeff(), 1e-12);
    EXPECT_NEAR(there(3, 1), 3, 1e-6);
    Positions areas = Positions::Ones(target.mesh.face_count(), 1);
    EXPECT_LT((transferred_face_values(map, areas, TransferWay::to_source).array() - 1).abs().maxCoeff(), 1e-12);
    // Exactly: integrals of values over the parts of faces are the same on both sides.
    const Overlay both = overlay(map);
    Eigen::VectorXd of_source = Eigen::VectorXd::Zero(source.mesh.face_count()),
                    of_target = Eigen::VectorXd::Zero(target.mesh.face_count());
    for (const Overlay::Piece& piece : both.pieces) {
        of_source[piece.source_face] += piece.part_of_source;
        of_target[piece.target_face] += piece.part_of_target;
    }
    EXPECT_LT((of_source.array() - 1).abs().maxCoeff(), 1e-9);
    EXPECT_LT((of_target.array() - 1).abs().maxCoeff(), 1e-9);
    Positions numbers(source.mesh.face_count(), 1);
    for (int f = 0; f < numbers.rows(); ++f) numbers(f, 0) = f;
    const Positions means = transferred_face_values(map, numbers);
    double whole = 0, expected = 0;
    for (int f = 0; f < target.mesh.face_count(); ++f) whole += means(f, 0) * face_vector_area(target.mesh, f).norm();
    for (const Overlay::Piece& piece : both.pieces)
        expected += piece.source_face * piece.part_of_target * face_vector_area(target.mesh, piece.target_face).norm();
    EXPECT_NEAR(whole, expected, 1e-9 * expected);
    EXPECT_EQ(test::cause_of([&] { transferred_vertex_values(map, values.topRows(3)); }), Cause::bad_option);
    EXPECT_EQ(test::cause_of([&] { transferred_texture(map); }), Cause::bad_mesh);
    // Places that swap two vertices flip faces.
    std::vector<MeshPoint> swapped = found.places;
    std::swap(swapped[20], swapped[25]);
    EXPECT_EQ(test::cause_of(
                  [&] { SurfaceCorrespondence(source.mesh, target.mesh, found.target_sphere.positions, swapped); }),
              Cause::bad_mesh);
}

TEST(Overlay, OfSurfacesWithoutCommonVerticesIsASphere) {
    const Surface source(bumpy(2, 0)), target(bumpy(3, 1));
    const SphereRegistration found = register_spheres(source, target, {});
    const Overlay both =
        overlay(SurfaceCorrespondence(source.mesh, target.mesh, found.target_sphere.positions, found.places));
    std::set<std::array<int, 2>> sides;
    for (const Overlay::Piece& piece : both.pieces)
        for (std::size_t i = 0; i < piece.corners.size(); ++i) {
            const int a = piece.corners[i], b = piece.corners[(i + 1) % piece.corners.size()];
            sides.insert({std::min(a, b), std::max(a, b)});
        }
    EXPECT_EQ(both.corners.size() + both.pieces.size(), sides.size() + 2);
    EXPECT_GT(both.pieces.size(), 2U * static_cast<std::size_t>(target.mesh.face_count()));
    // Corners are the same points on both.
    const SurfaceCorrespondence map(source.mesh, target.mesh, found.target_sphere.positions, found.places);
    std::vector<MeshPoint> here, there;
    for (const Overlay::Corner& corner : both.corners) {
        here.push_back(corner.on_source);
        there.push_back(corner.on_target);
    }
    EXPECT_LT(
        (positions_on(target.mesh, map.forward(here)) - positions_on(target.mesh, there)).rowwise().norm().maxCoeff(),
        1e-9);
}

}  // namespace
}  // namespace beltrami
