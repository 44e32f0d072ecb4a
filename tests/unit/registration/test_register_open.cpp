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
#include "support/registration.h"

namespace beltrami {
namespace {

/// 20×20 cells.
Mesh sheet(double moved) {
    return test::raised_sheet(20, moved);
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

TEST(RegisterOpen, TheInverseHasAboutTheSameK) {
    const Surface source(sheet(0)), target(test::raised_sheet(23, 0.15)), tube(cylinder(1, 2, 24, 12)),
        wider(cylinder(1.5, 2.2, 30, 10));
    std::vector<SurfaceLandmark> landmarks;
    for (const auto& [a, b] : {std::array{110, 150}, {220, 290}, {226, 300}, {330, 440}})
        landmarks.push_back({a, place_of_vertex(target.mesh, b)});
    const OpenRegistration found = register_open(source, target, landmarks);
    ASSERT_TRUE(found.inverse_k);
    EXPECT_GT(found.map.k, 0.02);
    EXPECT_NEAR(*found.inverse_k, found.map.k, 0.1 * found.map.k);
    const OpenRegistration ring = register_open(tube, wider, {});
    ASSERT_TRUE(ring.inverse_k);
    EXPECT_NEAR(*ring.inverse_k, ring.map.k, 0.01);
    OpenRegistrationOptions without;
    without.check_inverse = false;
    EXPECT_FALSE(register_open(tube, wider, {}, without).inverse_k);
}

TEST(RegisterOpen, AStartLeadsToTheSameMap) {
    const Surface source(sheet(0)), target(sheet(0.15));
    const std::vector<SurfaceLandmark> landmarks = some_landmarks(target.mesh, std::numeric_limits<double>::infinity());
    const OpenRegistration first = register_open(source, target, landmarks);
    OpenRegistrationOptions again;
    again.start = first.places;
    EXPECT_NEAR(register_open(source, target, landmarks, again).map.k, first.map.k, 1e-3);
    again.start.pop_back();
    EXPECT_EQ(test::cause_of([&] { register_open(source, target, landmarks, again); }), Cause::bad_option);
}

TEST(RegisterOpen, ALandmarkOnTheBoundaryStaysThere) {
    const Surface sheet(test::raised_sheet(20, 0));
    // Its place is inside: it goes to the boundary beside that, and the warning says so.
    const OpenRegistration found = register_open(sheet, sheet, test::landmarks_between(sheet.mesh, {{10, 220}}));
    const Eigen::RowVector3d p = found.positions.row(10);
    EXPECT_LT(std::min({p.x(), 2 - p.x(), p.y(), 2 - p.y()}), 1e-9);
    ASSERT_FALSE(found.warnings.empty());
    EXPECT_EQ(found.warnings[0].kind, WarningKind::marks);
}

TEST(RegisterOpen, WaysChooseTheClass) {
    // 220 stays in the middle of the sheet, the other goes around it on one side, on the other, or not at all.
    const Surface sheet(test::raised_sheet(20, 0));
    const auto place = [&](int v) { return place_of_vertex(sheet.mesh, v); };
    const std::vector<SurfaceLandmark> landmarks =
        test::landmarks_between(sheet.mesh, {{220, 220}, {217, 223}, {110, 110}, {330, 330}});
    OpenRegistrationOptions above, below;
    above.waypoints = {{1, 217, place(220 + 3 * 21)}};
    below.waypoints = {{1, 217, place(220 - 3 * 21)}};
    const OpenRegistration first = register_open(sheet, sheet, landmarks, above),
                           second = register_open(sheet, sheet, landmarks, below);
    for (const OpenRegistration* found : {&first, &second}) {
        EXPECT_TRUE(found->map.one_to_one());
        EXPECT_GT(found->map.k, 0.2) << found->map.K_lower << " " << found->map.K;
        EXPECT_LT((found->positions.row(217).transpose() - sheet.mesh.point(223)).norm(), 1e-12);
    }
    // The landmark's left neighbours come by on different sides.
    EXPECT_GT((first.positions.row(218) - second.positions.row(218)).norm(), 0.01);
    // Straight ways are no other class than none.
    const std::vector<SurfaceLandmark> near =
        test::landmarks_between(sheet.mesh, {{220, 220}, {217, 238}, {110, 110}, {330, 330}});
    OpenRegistrationOptions straight;
    straight.waypoints = {{1, 110, place(110)}};
    EXPECT_NEAR(register_open(sheet, sheet, near, straight).map.k, register_open(sheet, sheet, near).map.k, 1e-4);
    // Impossible ways.
    straight.start = first.places;
    EXPECT_EQ(test::cause_of([&] { register_open(sheet, sheet, near, straight); }), Cause::bad_option);
    OpenRegistrationOptions into;
    into.waypoints = {{1, 217, place(220)}};  // where another one is
    EXPECT_EQ(test::cause_of([&] { register_open(sheet, sheet, landmarks, into); }), Cause::bad_boundary);
    into.waypoints = {{1, 5, place(220)}};
    EXPECT_EQ(test::cause_of([&] { register_open(sheet, sheet, landmarks, into); }), Cause::bad_option);
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
