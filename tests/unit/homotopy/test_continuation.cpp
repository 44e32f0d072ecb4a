#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <beltrami/base/constants.h>
#include <beltrami/base/error.h>
#include <beltrami/homotopy/continuation.h>
#include <beltrami/homotopy/homotopy.h>
#include <beltrami/meshing/planar_domains.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/plane/inside_polygon.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

/// The unit disk with holes of radius 0.12 around ±0.4; loop_at(±1) is the loop of the hole there.
struct TwoHoles {
    Mesh mesh;
    Surface surface;
    Eigen::VectorXcd z;
    TwoHoles()
        : mesh(circle_domain({}, {Circle{{-0.4, 0}, 0.12}, Circle{{0.4, 0}, 0.12}}, options())),
          surface(mesh),
          z(test::complex_positions(mesh)) {}
    static DomainOptions options() {
        DomainOptions options;
        options.edge_length = 0.1;
        options.hole_edge_length = 0.035;
        return options;
    }
    int loop_at(int side) const { return z[surface.topology.boundary_loops[1][0]].real() * side > 0 ? 1 : 2; }
    /// Every hole moved to the other one's place, the outer loop as it is.
    BoundaryCondition exchanged() const {
        return test::boundary_values(surface, [](Complex p) {
            return std::abs(p) > 0.99 ? p : p.real() > 0 ? p - 0.8 : p + 0.8;
        });
    }
};

std::vector<Complex> images_of(const BoundaryCondition& boundary, const std::vector<int>& loop) {
    std::vector<Complex> result;
    for (const int v : loop)
        result.push_back(boundary.images[std::find(boundary.vertices.begin(), boundary.vertices.end(), v) -
                                         boundary.vertices.begin()]);
    return result;
}

TEST(Continuation, EndsWithWhatIsPrescribedAndStartsWithTheDomain) {
    const TwoHoles domain;
    const Complex a = std::polar(2.0, 0.7), b(3, -1);
    const BoundaryCondition same = test::boundary_values(domain.surface, [&](Complex p) { return a * p + b; });
    const Continuation still(domain.surface, domain.z, 0, same);
    EXPECT_EQ(still.pieces(), 1);
    for (const double t : {0.0, 0.3, 1.0}) {
        const BoundaryCondition at = still.at(t);
        ASSERT_EQ(at.vertices.size(), same.vertices.size());
        for (std::size_t i = 0; i < at.vertices.size(); ++i)
            EXPECT_NEAR(std::abs(at.images[i] - (a * domain.z[at.vertices[i]] + b)), 0, 1e-12);
    }
    EXPECT_NEAR((still.start() - (a * domain.z.array() + b).matrix()).cwiseAbs().maxCoeff(), 0, 1e-12);

    const BoundaryCondition moved =
        test::boundary_values(domain.surface, [](Complex p) { return p + 0.2 * p * p + 0.1 * std::conj(p); });
    const Continuation way(domain.surface, domain.z, 0, moved);
    EXPECT_EQ(way.at(1).images, moved.images);
    const BoundaryCondition first = way.at(0);
    for (std::size_t i = 0; i < first.vertices.size(); ++i)
        EXPECT_NEAR(std::abs(first.images[i] - way.start()[first.vertices[i]]), 0, 1e-12);
}

TEST(Continuation, WaysThatMeetAreRefusedAndWaypointsKeepLoopsApart) {
    const TwoHoles domain;
    const int left = domain.loop_at(-1), right = domain.loop_at(1);
    const BoundaryCondition exchanged = domain.exchanged();
    try {
        Continuation(domain.surface, domain.z, 0, exchanged);
        FAIL() << "the holes pass through each other";
    } catch (const Error& error) {
        EXPECT_EQ(error.cause(), Cause::bad_boundary);
        EXPECT_EQ(error.indices(), (std::vector<int>{std::min(left, right), std::max(left, right)}));
    }
    EXPECT_THROW(Continuation(domain.surface, domain.z, 0, exchanged, {{0, left, 0}}), Error);
    EXPECT_THROW(Continuation(domain.surface, domain.z, 0, exchanged, {{1, 0, 0}}), Error);
    EXPECT_THROW(Continuation(domain.surface, domain.z, 0, exchanged, {{1, left, {0, 5}}}).at(0.5), Error);

    // So near each other that the loops have to shrink on the way.
    const Continuation way(domain.surface, domain.z, 0, exchanged, {{1, left, {0, 0.06}}, {1, right, {0, -0.06}}});
    EXPECT_EQ(way.pieces(), 2);
    EXPECT_NEAR(std::abs(way.centre(left, 0.5) - Complex(0, 0.06)), 0, 1e-12);
    bool shrunk = false;
    double last_area = 0.12 * 0.12;
    for (int i = 0; i <= 40; ++i) {
        const BoundaryCondition at = way.at(i / 40.0);
        const auto& loops = domain.surface.topology.boundary_loops;
        const std::vector<Complex> one = images_of(at, loops[left]), two = images_of(at, loops[right]),
                                   outer = images_of(at, loops[0]);
        double gap = 9, size = 0;
        for (const Complex p : one) {
            EXPECT_EQ(winding_number(two, p), 0);
            EXPECT_EQ(winding_number(outer, p), 1);
            size = std::max(size, std::abs(p - way.centre(left, i / 40.0)));
            for (const Complex q : two) gap = std::min(gap, std::abs(p - q));
        }
        EXPECT_GT(gap, 0.005);
        EXPECT_LT(std::abs(size * size - last_area), 0.4 * std::max(size * size, last_area)) << i;  // no leaps
        last_area = size * size;
        shrunk = shrunk || size < 0.1;
    }
    EXPECT_TRUE(shrunk);
}

TEST(Continuation, TheSideOfTheWaypointsIsTheClass) {
    const TwoHoles domain;
    const int left = domain.loop_at(-1), right = domain.loop_at(1);
    const BoundaryCondition exchanged = domain.exchanged();
    const auto paths = loop_paths(domain.surface, domain.z, 0);
    // Between the two classes the angle of each path, seen from the other hole's image, differs by one turn.
    double angle[2];
    for (const int side : {0, 1}) {
        const double y = side ? 0.4 : -0.4;
        const std::vector<Waypoint> waypoints{{1, left, {0, y}}, {1, right, {0, -y}}};
        const FollowedMap followed =
            follow(domain.surface, Continuation(domain.surface, domain.z, 0, exchanged, waypoints), 0.125, 0.125);
        const Eigen::VectorXcd& f = followed.map;
        EXPECT_GE(followed.steps, 16);
        EXPECT_TRUE(distortion(domain.surface.operators, f).flipped.empty());
        for (std::size_t i = 0; i < exchanged.vertices.size(); ++i)
            EXPECT_EQ(f[exchanged.vertices[i]], exchanged.images[i]);
        const HomotopyClass found = homotopy_class(domain.surface, paths, f);
        for (const HoleTurns& hole : found.holes) EXPECT_TRUE(hole.meaningful);
        const auto at = std::find_if(paths.begin(), paths.end(), [&](const LoopPath& p) { return p.loop == left; });
        angle[side] = turning_angle(loop_images(at->vertices, f),
                                    point_inside(loop_images(domain.surface.topology.boundary_loops[right], f)));
    }
    EXPECT_NEAR(std::abs(angle[1] - angle[0]), kTurn, 1e-9);

    const auto steps =
        continuation_steps(domain.surface, domain.z, 0, exchanged, {{1, left, {0, 0.4}}, {1, right, {0, -0.4}}}, 10);
    ASSERT_EQ(steps.size(), 20u);
    EXPECT_EQ(steps.back().images, exchanged.images);
    EXPECT_THROW(continuation_steps(domain.surface, domain.z, 0, exchanged, {}, 0), Error);
}

TEST(Continuation, ALoopTurnsTheShorterWayAndNeverCollapses) {
    const TwoHoles domain;
    const BoundaryCondition turned = test::boundary_values(domain.surface, [](Complex p) {
        return std::abs(p) > 0.99 ? p : p.real() > 0 ? 0.4 + (p - 0.4) * std::polar(1.5, 3.0) : p;
    });
    const Continuation way(domain.surface, domain.z, 0, turned);
    const auto& loop = domain.surface.topology.boundary_loops[domain.loop_at(1)];
    const Complex at_start = way.start()[loop[0]] - way.centre(domain.loop_at(1), 0);
    for (const double t : {0.25, 0.5, 0.75}) {
        const auto images = images_of(way.at(t), loop);
        const Complex ratio = (images[0] - way.centre(domain.loop_at(1), t)) / at_start;
        EXPECT_NEAR(std::arg(ratio), 3.0 * t, 1e-3);
        EXPECT_NEAR(std::abs(ratio), std::pow(1.5, t), 1e-3);
    }
}

}  // namespace
}  // namespace beltrami
