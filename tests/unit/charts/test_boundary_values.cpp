#include <gtest/gtest.h>

#include <algorithm>

#include <beltrami/base/constants.h>
#include <beltrami/base/error.h>
#include <beltrami/charts/boundary_values.h>
#include <beltrami/meshing/planar_domains.h>
#include <beltrami/plane/polygon.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

std::vector<Complex> images_along(const Surface& surface, const BoundaryCondition& boundary, int loop = 0) {
    std::vector<Complex> images;
    for (const int v : surface.topology.boundary_loops[loop]) {
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
        const double t = kTurn * static_cast<double>(i) / static_cast<double>(loop.size());
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
    for (int i = 0; i < 6; ++i) hexagon.push_back(std::polar(1.0, kTurn * i / 6));
    const BoundaryCondition b = boundary_to_polygon(surface, hexagon, {std::nullopt, BoundarySpeed::conformal});
    for (std::size_t i = 0; i < 144; ++i)
        EXPECT_NEAR(std::abs(b.images[(i + 24) % 144] - b.images[i] * std::polar(1.0, kTurn / 6)), 0, 2e-2);
    // Near a corner of angle 2π/3 the speed vanishes like s^{2/3 − 1 + …}: slower than in the middle of a side.
    EXPECT_GT(std::abs(b.images[1] - b.images[0]), std::abs(b.images[12] - b.images[11]));
}

/// A disk with five notches: at their mouths the conformal map squeezes several vertices into one place.
Mesh notched_disk() {
    Polygon outline;
    const double pitch = kTurn / 5, half = std::asin(0.03);
    const auto add = [&](double r, double t) { outline.emplace_back(r * std::cos(t), r * std::sin(t)); };
    for (int n = 0; n < 5; ++n) {
        add(1, n * pitch - half);
        add(0.45, n * pitch);
        for (int i = 0; i < 20; ++i) add(1, n * pitch + half + (pitch - 2 * half) * i / 20);
    }
    DomainOptions options;
    options.edge_length = 0.04;
    options.corner_edge_length = 0.02;
    return polygon_domain(outline, {}, options);
}

TEST(BoundaryToDisk, ConformalSpeedNeverRunsBackwards) {
    const Surface surface(notched_disk());
    const auto& loop = surface.topology.boundary_loops[0];
    for (const std::size_t at : {std::size_t{0}, std::size_t{1}, std::size_t{2}, loop.size() - 1, loop.size() / 2}) {
        const BoundaryCondition b = boundary_to_disk(surface, 0.0, {loop[at], BoundarySpeed::conformal});
        double sum = 0;
        for (std::size_t i = 0; i < b.images.size(); ++i) {
            const double step = std::arg(b.images[(i + 1) % b.images.size()] / b.images[i]);
            EXPECT_GT(step, 0) << "vertex " << b.vertices[i] << ", start " << loop[at];
            sum += step;
        }
        EXPECT_NEAR(sum, kTurn, 1e-9);
    }
}

TEST(BoundaryToDisk, ConformalSpeedDoesNotDependOnTheStart) {
    const Surface surface(notched_disk());
    const auto& loop = surface.topology.boundary_loops[0];
    const auto first = images_along(surface, boundary_to_disk(surface, 0.0, {loop[0], BoundarySpeed::conformal}));
    const auto second = images_along(surface, boundary_to_disk(surface, 0.0, {loop[7], BoundarySpeed::conformal}));
    for (std::size_t i = 0; i < loop.size(); ++i) EXPECT_NEAR(std::abs(first[i] / first[7] - second[i]), 0, 1e-9);
}

TEST(BoundaryToDisk, ConformalSpeedWithHolesIsThatOfTheDomain) {
    // A disk with holes is its own canonical domain; turned inside out, its image under r/z for the hole around 0.
    const Surface surface(circle_domain({}, {{{0, 0}, 0.3}, {{0.6, 0}, 0.1}}));
    const auto z = [&](int v) { return Complex(surface.mesh.positions(v, 0), surface.mesh.positions(v, 1)); };
    int inner = 1;
    if (surface.topology.loop_lengths[1] < surface.topology.loop_lengths[2]) inner = 2;
    for (const int loop : {0, inner}) {
        const BoundaryCondition b = boundary_to_disk(surface, 0.0, {std::nullopt, BoundarySpeed::conformal, loop});
        const auto images = images_along(surface, b, loop);
        EXPECT_GT(signed_area(images), 3);
        // Up to a Möbius map of the disk, by which the chart is centred: cross ratios agree.
        const auto cross_ratio = [](Complex a, Complex p, Complex c, Complex d) {
            return (a - c) * (p - d) / ((a - d) * (p - c));
        };
        const std::size_t n = images.size();
        const auto& at = surface.topology.boundary_loops[loop];
        for (std::size_t i = 1; i + 2 < n; ++i) {
            if (i == n / 3) continue;
            EXPECT_NEAR(std::abs(cross_ratio(images[0], images[i], images[n / 3], images[n - 1]) /
                                     cross_ratio(z(at[0]), z(at[i]), z(at[n / 3]), z(at[n - 1])) -
                                 1.0),
                        0, 1e-9)
                << i << " of " << n;
        }
    }
}

TEST(BoundaryToRectangle, OfAnyLoop) {
    const Surface surface(circle_domain({}, {{{0, 0}, 0.3}}));
    BoundaryPlacement placement;
    placement.loop = 1;
    for (const BoundarySpeed speed : {BoundarySpeed::arclength, BoundarySpeed::conformal}) {
        placement.speed = speed;
        const BoundaryCondition b = boundary_to_rectangle(surface, 2, 1, {}, placement);
        EXPECT_NEAR(signed_area(images_along(surface, b, 1)), 2.0, 1e-12);
        for (const Complex corner : {Complex(0, 0), Complex(2, 0), Complex(2, 1), Complex(0, 1)})
            EXPECT_LT(std::abs(*std::min_element(
                                   b.images.begin(), b.images.end(),
                                   [&](Complex p, Complex q) { return std::abs(p - corner) < std::abs(q - corner); }) -
                               corner),
                      1e-12);
    }
    const std::vector<Complex> triangle{{0, 0}, {3, 0}, {0, 3}};
    placement.speed = BoundarySpeed::conformal;
    EXPECT_NEAR(signed_area(images_along(surface, boundary_to_polygon(surface, triangle, placement), 1)), 4.5, 1e-12);
}

TEST(HoleToCircle, RunsClockwiseByArcLength) {
    const Surface surface(circle_domain({}, {{{0.1, 0.2}, 0.3}}));
    const auto& loop = surface.topology.boundary_loops[1];
    const BoundaryCondition b = hole_to_circle(surface, 1, {2, 1}, 0.5, 0.7);
    ASSERT_EQ(b.vertices, loop);
    const double total = surface.topology.loop_lengths[1];
    double arc = 0;
    for (std::size_t i = 0; i < loop.size(); ++i) {
        EXPECT_NEAR(std::abs(b.images[i] - Complex(2, 1) - std::polar(0.5, 0.7 - kTurn * arc / total)), 0, 1e-12);
        arc += surface.boundary_edge_lengths[1][i];
    }
    EXPECT_LT(signed_area(images_along(surface, b, 1)), 0);
    EXPECT_EQ(cause_of([&] { hole_to_circle(surface, 2, 0, 1); }), Cause::bad_option);
    EXPECT_EQ(cause_of([&] { hole_to_circle(surface, -1, 0, 1); }), Cause::bad_option);
    EXPECT_EQ(cause_of([&] { hole_to_circle(surface, 1, 0, 0); }), Cause::bad_option);
    EXPECT_EQ(cause_of([&] { hole_to_circle(surface, 1, std::nan(""), 1); }), Cause::bad_option);
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
    EXPECT_EQ(cause_of([&] {
                  boundary_to_disk(surface, 0, {std::nullopt, BoundarySpeed::arclength, 1});
              }),
              Cause::bad_option);
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
