#include <gtest/gtest.h>

#include <cmath>

#include <beltrami/certificate/period_pair.h>
#include <beltrami/certificate/proved_bounds.h>
#include <beltrami/meshing/planar_domains.h>
#include <beltrami/operators/distortion.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

/// z exp(i c log|z|): the shear x + iy → x + i(y + cx) of log z, extremal in its class.
Eigen::VectorXcd turned(const Mesh& ring, double c) {
    return test::complex_positions(ring).unaryExpr(
        [c](Complex z) { return z * std::polar(1.0, c * std::log(std::abs(z))); });
}
double dilatation_of_shear(double c) {
    return std::pow(0.5 * c + std::sqrt(1 + 0.25 * c * c), 2);
}

TEST(PeriodPair, SeesHowAHoleIsTurned) {
    const double c = 1.2, K = dilatation_of_shear(c);
    double error[2];
    for (const int level : {0, 1}) {
        const Surface ring(annulus(0.3, 1, 24 << level));
        const auto image = image_under(ring, turned(ring.mesh, c));
        ASSERT_TRUE(image);
        const PairBound bound = period_pair_bound(ring, *image);
        EXPECT_LT(bound.K, K * 1.01);  // of the polygons
        error[level] = std::abs(K - bound.K);
        // Single-valued functions see what is common to all classes.
        EXPECT_LT(pair_bound(ring, *image).K, 0.8 * K);
    }
    EXPECT_LT(error[1], 0.01 * K);
    EXPECT_LT(error[1], 0.5 * error[0]);
}

TEST(PeriodPair, OfAnotherClassIsAnother) {
    // The same boundary values after a whole turn more.
    const double inner = 0.1, c = 0.3, more = c - 2 * std::numbers::pi / std::log(inner);
    const Surface ring(annulus(inner, 1, 96));
    const auto image = image_under(ring, turned(ring.mesh, c)), other = image_under(ring, turned(ring.mesh, more));
    ASSERT_TRUE(image && other);
    const double K = dilatation_of_shear(c), K_other = dilatation_of_shear(more);
    EXPECT_NEAR(period_pair_bound(ring, *image).K, K, 0.01 * K);
    EXPECT_NEAR(period_pair_bound(ring, *other).K, K_other, 0.05 * K_other);
    EXPECT_LT(period_pair_bound(ring, *other).K, 1.01 * K_other);
}

TEST(PeriodPair, IsBelowWhatAMapOfTheClassAttains) {
    DomainOptions options;
    options.edge_length = 0.12;
    const Surface surface(circle_domain({}, {{{0.45, 0}, 0.2}, {{-0.4, 0.1}, 0.25}}, options));
    const Eigen::VectorXcd map = test::complex_positions(surface.mesh).unaryExpr([](Complex z) {
        return std::exp(0.6 * z + 0.25 * std::conj(z)) + 0.05 * z * z;
    });
    const auto image = image_under(surface, map);
    ASSERT_TRUE(image);
    const double attained = distortion(surface.operators, map).max_dilatation(),
                 K = period_pair_bound(surface, *image).K;
    EXPECT_GE(K, pair_bound(surface, *image).K * (1 - 1e-4));
    EXPECT_GT(K, 1.5);
    EXPECT_LT(K, attained);
}

TEST(PeriodPair, IsWhatIsProvedWithHoles) {
    const Surface ring(annulus(0.3, 1, 36));
    const Eigen::VectorXcd map = turned(ring.mesh, 1.2);
    BoundaryCondition boundary;
    for (const auto& loop : ring.topology.boundary_loops)
        for (const int v : loop) boundary.pin(v, map[v]);
    EXPECT_NEAR(proved_bounds(ring, boundary, map).K(), period_pair_bound(ring, *image_under(ring, map)).K, 1e-6);
}

}  // namespace
}  // namespace beltrami
