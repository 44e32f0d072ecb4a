#include <gtest/gtest.h>

#include <cmath>

#include <beltrami/plane/disk_moebius.h>

namespace beltrami {
namespace {

TEST(DiskMoebius, TakesCirclesToCircles) {
    const DiskMoebius move{0.7, {0.4, -0.3}};
    EXPECT_NEAR(std::abs(move(Complex(0.4, -0.3))), 0, 1e-15);
    for (const RoundHole& hole : {RoundHole{3, {0.2, 0.5}, 0.3}, RoundHole{4, 0, 0.1}, RoundHole{5, {-0.6, 0}, 0.35}}) {
        const RoundHole image = move(hole);
        EXPECT_EQ(image.loop, hole.loop);
        for (int i = 0; i < 12; ++i)
            EXPECT_NEAR(std::abs(move(hole.centre + std::polar(hole.radius, 0.5 * i)) - image.centre), image.radius,
                        1e-14);
        EXPECT_NEAR(hyperbolic_circle(image).radius, hyperbolic_circle(hole).radius, 1e-13);
        EXPECT_NEAR(std::abs(hyperbolic_circle(image).centre - move(hyperbolic_circle(hole).centre)), 0, 1e-14);
    }
    for (int i = 0; i < 12; ++i) EXPECT_NEAR(std::abs(move(std::polar(1.0, 0.5 * i))), 1, 1e-14);
}

TEST(DiskMoebius, KeepsHyperbolicDistances) {
    const DiskMoebius move{-2, {-0.5, 0.6}};
    const Complex z(0.3, 0.1), w(-0.7, -0.2);
    EXPECT_NEAR(hyperbolic_gap(move(z), move(w)), hyperbolic_gap(z, w), 1e-13);
    // The distance from 0 is 2 artanh |z|.
    EXPECT_NEAR(std::asinh(std::sqrt(hyperbolic_gap(0, z))), std::atanh(std::abs(z)), 1e-14);
    // On a diameter distances add up.
    const RoundHole hole{1, 0.3, 0.4};
    EXPECT_NEAR(hyperbolic_circle(hole).radius, std::atanh(0.7) - std::atanh(-0.1), 1e-14);
}

TEST(DiskMoebius, CentresAHole) {
    const RoundHole hole{1, {0.3, -0.4}, 0.2};
    const RoundHole image = centring(hole)(hole);
    EXPECT_NEAR(std::abs(image.centre), 0, 1e-15);
    EXPECT_NEAR(image.radius, std::tanh((std::atanh(0.7) - std::atanh(0.3)) / 2), 1e-14);
}

}  // namespace
}  // namespace beltrami
