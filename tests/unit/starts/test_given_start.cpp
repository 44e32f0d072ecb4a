#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <beltrami/base/error.h>
#include <beltrami/base/random.h>
#include <beltrami/generate/round_domains.h>
#include <beltrami/mesh/planar.h>
#include <beltrami/starts/given_start.h>

namespace beltrami {
namespace {

TargetDomain ring_target(double inner) {
    return target_domain(TargetCurve::circle(0, 1), {TargetCurve::circle(0, inner)});
}

/// Parameters ascend, once around; images lie there.
void expect_in_order(const Surface& source, const TargetDomain& target, const SlidingStart& start) {
    for (const SlidingLoop& sliding : start.loops) {
        const auto& s = sliding.parameters;
        for (std::size_t i = 1; i < s.size(); ++i) EXPECT_LT(s[i - 1], s[i]);
        EXPECT_LT(s.back(), s.front() + sliding.curve.length());
        const std::vector<int>& loop = source.topology.boundary_loops[sliding.loop];
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const Complex image = start.map[loop[i]];
            EXPECT_LT(std::abs(image - sliding.curve.point(s[i])), 1e-12);
            EXPECT_LT(std::abs(image - target.curve(start.curves[sliding.loop]).point(sliding.curve.nearest(image))),
                      1e-9);
        }
    }
}

TEST(GivenStart, OfAMapOntoTheTargetIsThatMap) {
    const Surface ring(annulus(0.5, 1, 48));
    const Eigen::VectorXcd z = planar_coordinates(ring.mesh);
    const SlidingStart start = given_start(ring, ring_target(0.5), z);
    expect_in_order(ring, ring_target(0.5), start);
    EXPECT_LT((start.map - z).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_EQ(start.curves, (std::vector<int>{0, 1}));
    EXPECT_EQ(start.flips, 0);
}

TEST(GivenStart, PutsVerticesThatAreOutOfOrderInOrder) {
    const Surface ring(annulus(0.5, 1, 48));
    Eigen::VectorXcd z = planar_coordinates(ring.mesh);
    const Eigen::VectorXcd even = z;
    std::vector<char> rim = ring.topology.on_boundary;
    for (int v = 0; v < z.size(); ++v)  // neighbours are 0.13 apart along the outer circle
        z[v] += 0.2 * std::polar(1.0, 7.0 * v * v) * (rim[v] ? 1.0 : 0.1);
    const SlidingStart start = given_start(ring, ring_target(0.5), z);
    expect_in_order(ring, ring_target(0.5), start);
    for (int v = 0; v < z.size(); ++v) {
        if (rim[v]) {
            EXPECT_LT(std::abs(start.map[v] - even[v]), 0.3);
        } else {
            EXPECT_EQ(start.map[v], z[v]);
        }
    }
}

TEST(GivenStart, PutsMarkedVerticesOnTheirPlaces) {
    const Surface plate(disk(8));
    const TargetDomain target = target_domain(TargetCurve::circle(0, 1));
    const std::vector<int>& loop = plate.topology.boundary_loops[0];
    Correspondence wanted;
    const std::vector<double> angles{0.3, 1.5, 4};
    for (int m = 0; m < 3; ++m) wanted.marks.emplace_back(loop[16 * m], 0, angles[m]);
    const SlidingStart start = given_start(plate, target, planar_coordinates(plate.mesh), wanted);
    expect_in_order(plate, target, start);
    for (int m = 0; m < 3; ++m) {
        EXPECT_LT(std::abs(start.map[loop[16 * m]] - std::polar(1.0, angles[m])), 1e-12);
        EXPECT_TRUE(start.loops[0].held[16 * m]);
    }
    EXPECT_EQ(std::count(start.loops[0].held.begin(), start.loops[0].held.end(), 1), 3);
}

TEST(GivenStart, RefusesWhatRunsAroundNoCurveOnce) {
    const Surface ring(annulus(0.5, 1, 48));
    const Eigen::VectorXcd z = planar_coordinates(ring.mesh);
    const auto refused = [&](const Eigen::VectorXcd& map, const TargetDomain& target) {
        try {
            given_start(ring, target, map);
        } catch (const Error& error) {
            return error.cause() == Cause::bad_boundary && error.where().of == Things::loops;
        }
        return false;
    };
    EXPECT_TRUE(refused(z.conjugate(), ring_target(0.5)));                 // backwards
    EXPECT_TRUE(refused(z.array().square().matrix(), ring_target(0.25)));  // twice around
    EXPECT_TRUE(refused(Eigen::VectorXcd(0.1 * z), ring_target(0.5)));     // both loops are nearest to the hole
    EXPECT_THROW(given_start(ring, target_domain(TargetCurve::circle(0, 1)), z), Error);
    EXPECT_THROW(given_start(ring, ring_target(0.5), z.head(5)), Error);
}

}  // namespace
}  // namespace beltrami
