#include <beltrami/registration/register_open.h>

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include <beltrami/base/error.h>
#include <beltrami/charts/chart_places.h>
#include <beltrami/generate/grids.h>
#include <beltrami/generate/round_domains.h>
#include <beltrami/registration/nearest_places.h>

#include "support/cause_of.h"

namespace beltrami {
namespace {

/// A square sheet, raised; the same with its vertices moved along it.
Mesh sheet(double moved) {
    Mesh mesh = rectangle(2, 2, 20, 20);
    Positions positions(mesh.vertex_count(), 3);
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        const double x = mesh.positions(v, 0), y = mesh.positions(v, 1);
        const double u = x + moved * x * (2 - x) * std::sin(2 * y);
        positions.row(v) << u, y, 0.3 * std::sin(u) * y;
    }
    mesh.positions = positions;
    return mesh;
}

std::vector<SurfaceLandmark> some_landmarks(const Mesh& target, double weight) {
    std::vector<SurfaceLandmark> landmarks;
    for (const int v : {110, 220, 226, 330}) landmarks.push_back({v, place_of_vertex(target, v), weight});
    return landmarks;
}

TEST(RegisterOpen, LandmarksInsideArePinned) {
    const Surface source(sheet(0)), target(sheet(0.15));
    const double hard = std::numeric_limits<double>::infinity();
    const OpenRegistration found = register_open(source, target, some_landmarks(target.mesh, hard));
    EXPECT_TRUE(found.map.one_to_one());
    EXPECT_GT(found.map.k, 0.01);
    for (const int v : {110, 220, 226, 330})
        EXPECT_LT((found.positions.row(v).transpose() - target.mesh.point(v)).norm(), 1e-12);
    // The boundary stays on the boundary.
    for (const int v : source.topology.boundary_loops[0]) {
        const Eigen::RowVector3d p = found.positions.row(v);
        EXPECT_LT(std::min({p.x(), 2 - p.x(), p.y(), 2 - p.y()}), 1e-9);
    }
}

TEST(RegisterOpen, SoftLandmarksBalance) {
    const Surface source(sheet(0)), target(sheet(0.15));
    double last_k = 1, last_distance = 0;
    for (const double weight : {1e4, 3e1}) {
        const OpenRegistration found = register_open(source, target, some_landmarks(target.mesh, weight));
        EXPECT_TRUE(found.map.one_to_one());
        EXPECT_LT(found.map.k, last_k);
        ASSERT_TRUE(found.largest_distance);
        EXPECT_GT(*found.largest_distance, last_distance);
        last_k = found.map.k;
        last_distance = *found.largest_distance;
    }
}

TEST(RegisterOpen, RefusesWhatCannotBe) {
    const Surface source(sheet(0)), target(sheet(0.15)), tube(cylinder(1, 2, 12, 8));
    EXPECT_EQ(test::cause_of([&] { register_open(source, tube, {}); }), Cause::bad_mesh);
    std::vector<SurfaceLandmark> landmarks{{0, place_of_vertex(target.mesh, 0), 10.0}};
    EXPECT_EQ(test::cause_of([&] { register_open(source, target, landmarks); }), Cause::bad_option);
    landmarks = {{5000, place_of_vertex(target.mesh, 0)}};
    EXPECT_EQ(test::cause_of([&] { register_open(source, target, landmarks); }), Cause::bad_boundary);
    EXPECT_EQ(test::cause_of([&] { place_of_vertex(target.mesh, 10000); }), Cause::bad_boundary);
}

TEST(NearestPlaces, AreOnTheMesh) {
    const Mesh mesh = sheet(0);
    Positions points(2, 3);
    points.row(0) = mesh.positions.row(50);
    points.row(1) = mesh.positions.row(50) + Eigen::RowVector3d(0, -5, 0);
    const std::vector<NearestPlace> found = nearest_places(mesh, points);
    EXPECT_LT(found[0].distance, 1e-15);
    EXPECT_LT((positions_on(mesh, std::array{found[0].place}) - mesh.positions.row(50)).norm(), 1e-15);
    EXPECT_GT(found[1].distance, 3);
    points(0, 0) = std::nan("");
    EXPECT_EQ(test::cause_of([&] { nearest_places(mesh, points); }), Cause::bad_option);
    EXPECT_EQ(test::cause_of([&] { nearest_places(Mesh{}, points); }), Cause::bad_mesh);
}

}  // namespace
}  // namespace beltrami
