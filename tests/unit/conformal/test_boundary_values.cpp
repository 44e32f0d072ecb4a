#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include <beltrami/conformal/boundary_values.h>
#include <beltrami/mesh/error.h>
#include <beltrami/mesh/polygon.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

constexpr double kTwoPi = 2 * std::numbers::pi;

std::vector<Complex> images_along(const Surface& surface, const BoundaryCondition& boundary) {
    std::vector<Complex> images;
    for (const int v : surface.topology.boundary_loops[0]) {
        const auto at = std::find(boundary.vertices.begin(), boundary.vertices.end(), v);
        images.push_back(boundary.images[at - boundary.vertices.begin()]);
    }
    return images;
}

Cause cause_of(const std::function<void()>& attempt) {
    try {
        attempt();
    } catch (const Error& error) {
        return error.cause();
    }
    return Cause::cancelled;
}

TEST(BoundaryToDisk, FollowsArcLengthFromTheStart) {
    const Surface surface(test::jittered_square(8));
    const auto& loop = surface.topology.boundary_loops[0];
    const BoundaryCondition b = boundary_to_disk(surface, 0.4, {loop[5], BoundarySpeed::arclength});
    EXPECT_EQ(b.vertices[0], loop[5]);
    for (std::size_t i = 0; i < loop.size(); ++i) {  // the square's boundary has equal edges
        const double t = kTwoPi * static_cast<double>(i) / static_cast<double>(loop.size());
        EXPECT_EQ(b.vertices[i], loop[(5 + i) % loop.size()]);
        EXPECT_NEAR(std::abs(b.images[i] - std::polar(1.0, t + 0.4 * std::sin(t))), 0, 1e-12);
    }
}

TEST(BoundaryToDisk, ConformalSpeedOfADiskIsItsAngle) {
    const Surface surface(disk(20));
    const BoundaryCondition b = boundary_to_disk(surface, 0.0, {std::nullopt, BoundarySpeed::conformal});
    for (std::size_t i = 0; i < b.vertices.size(); ++i) {
        const Complex start(surface.mesh.positions(b.vertices[0], 0), surface.mesh.positions(b.vertices[0], 1));
        const Complex z(surface.mesh.positions(b.vertices[i], 0), surface.mesh.positions(b.vertices[i], 1));
        EXPECT_NEAR(std::abs(b.images[i] - z / start), 0, 1e-9);
    }
}

TEST(BoundaryToRectangle, ConformalSpeedOfARectangleIsTheIdentity) {
    const Surface surface(rectangle(2.0, 1.0, 40, 20));
    const std::array<int, 4> corners{0, 40, 41 * 21 - 1, 41 * 20};
    for (const BoundarySpeed speed : {BoundarySpeed::conformal, BoundarySpeed::arclength}) {
        const BoundaryCondition b = boundary_to_rectangle(surface, 2.0, 1.0, corners, {std::nullopt, speed});
        for (std::size_t i = 0; i < b.vertices.size(); ++i)
            EXPECT_NEAR(std::abs(b.images[i] - Complex(surface.mesh.positions(b.vertices[i], 0),
                                                       surface.mesh.positions(b.vertices[i], 1))),
                        0, 1e-9);
    }
}

TEST(BoundaryToRectangle, WithoutCornersKeepsProportionsAndHitsTheCorners) {
    const Surface surface(disk(16));
    const BoundaryCondition b = boundary_to_rectangle(surface, 3.0, 1.0, {}, {});
    for (const Complex corner : {Complex(0, 0), Complex(3, 0), Complex(3, 1), Complex(0, 1)})
        EXPECT_NE(std::find(b.images.begin(), b.images.end(), corner), b.images.end());
    EXPECT_NEAR(signed_area(images_along(surface, b)), 3.0, 1e-12);
}

TEST(BoundaryToPolygon, KeepsEveryCornerAndTheOrder) {
    const Surface surface(disk(20));
    const std::vector<Complex> l{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
    for (const BoundarySpeed speed : {BoundarySpeed::conformal, BoundarySpeed::arclength}) {
        const BoundaryCondition b = boundary_to_polygon(surface, l, {std::nullopt, speed});
        for (const Complex corner : l) EXPECT_NE(std::find(b.images.begin(), b.images.end(), corner), b.images.end());
        EXPECT_EQ(b.images[0], l[0]);
        const std::vector<Complex> images = images_along(surface, b);
        EXPECT_NO_THROW(require_simple_polygon(images));
        EXPECT_NEAR(signed_area(images), 3.0, 1e-12);
    }
}

TEST(BoundaryToPolygon, ConformalSpeedOfARegularPolygonKeepsItsSymmetry) {
    const Surface surface(disk(24));  // 144 boundary vertices
    std::vector<Complex> hexagon;
    for (int i = 0; i < 6; ++i) hexagon.push_back(std::polar(1.0, kTwoPi * i / 6));
    const BoundaryCondition b = boundary_to_polygon(surface, hexagon, {std::nullopt, BoundarySpeed::conformal});
    for (std::size_t i = 0; i < 144; ++i)
        EXPECT_NEAR(std::abs(b.images[(i + 24) % 144] - b.images[i] * std::polar(1.0, kTwoPi / 6)), 0, 2e-2);
    // Near a corner of angle 2π/3 the speed vanishes like s^{2/3 − 1 + …}: slower than in the middle of a side.
    EXPECT_GT(std::abs(b.images[1] - b.images[0]), std::abs(b.images[12] - b.images[11]));
}

TEST(BoundaryValues, ImpossibleOnesAreRefused) {
    const Surface surface(disk(5));
    EXPECT_EQ(cause_of([&] { boundary_to_disk(surface, 1.0); }), Cause::bad_option);
    EXPECT_EQ(cause_of([&] { boundary_to_disk(surface, 0, {0, BoundarySpeed::arclength}); }), Cause::bad_boundary);
    EXPECT_EQ(cause_of([&] { boundary_to_rectangle(surface, 1, 0, {}); }), Cause::bad_option);
    const auto& l = surface.topology.boundary_loops[0];
    EXPECT_EQ(cause_of([&] {
                  boundary_to_rectangle(surface, 1, 1, std::array{l[0], l[9], l[5], l[12]});
              }),
              Cause::bad_boundary);
    EXPECT_EQ(cause_of([&] {
                  boundary_to_rectangle(surface, 1, 1, std::array{0, l[9], l[5], l[12]});
              }),
              Cause::bad_boundary);
    EXPECT_EQ(
        cause_of([&] {
            boundary_to_rectangle(surface, 1, 1, std::array{l[0], l[2], l[5], l[12]}, {l[1], BoundarySpeed::arclength});
        }),
        Cause::bad_option);
    EXPECT_EQ(cause_of([&] { boundary_to_polygon(surface, {{0, 0}, {1, 0}}); }), Cause::bad_boundary);
}

TEST(SimplePolygon, MeetingEdgesAreNamed) {
    const auto edges_of = [](const std::vector<Complex>& polygon) {
        try {
            require_simple_polygon(polygon);
        } catch (const Error& error) {
            return error.indices();
        }
        return std::vector<int>{-1};
    };
    EXPECT_EQ(edges_of({{0, 0}, {1, 0}, {1, 1}, {0, 1}}), std::vector<int>{-1});
    EXPECT_EQ(edges_of({{0, 0}, {2, 2}, {2, 0}, {0, 3}}), (std::vector<int>{0, 2}));
    EXPECT_EQ(edges_of({{0, 0}, {1, 0}, {1, 0}, {0, 1}}), (std::vector<int>{1, 2}));
    EXPECT_EQ(edges_of({{0, 0}, {3, 0}, {3, 3}, {2, 0}, {1, 2}}).size(), 2u);  // a corner on another edge
    EXPECT_EQ(edges_of({{0, 0}, {2, 0}, {1, 0}, {1, 1}}).size(), 2u);          // turning straight back
    EXPECT_TRUE(edges_of({{0, 0}, {0, 1}, {1, 0}}).empty());                   // clockwise
}

}  // namespace
}  // namespace beltrami
