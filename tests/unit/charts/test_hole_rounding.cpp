#include <gtest/gtest.h>

#include <numbers>

#include <beltrami/charts/hole_centre.h>
#include <beltrami/charts/hole_rounding.h>
#include <beltrami/plane/circle_fit.h>

namespace beltrami {
namespace {

std::vector<Complex> ellipse(Complex centre, double a, double b, double turn, int n = 80) {
    std::vector<Complex> rim;
    for (int i = 0; i < n; ++i) {
        const double t = -2 * std::numbers::pi * i / n;
        rim.push_back(centre + std::polar(1.0, turn) * Complex(a * std::cos(t), b * std::sin(t)));
    }
    return rim;
}

TEST(CircleFit, OfPointsOnACircleIsExact) {
    const CircleFit fit = fit_circle(ellipse({3e5, -2e5}, 0.25, 0.25, 0, 7));
    EXPECT_TRUE(fit.exact());
    EXPECT_LT(std::abs(fit.centre - Complex(3e5, -2e5)), 1e-9);
    EXPECT_NEAR(fit.radius, 0.25, 1e-9);
    EXPECT_FALSE(fit_circle(ellipse(0, 0.3, 0.29, 0)).exact());
}

TEST(HoleCentre, LiesInsideAndTurnsWithThePolygon) {
    const std::vector<Complex> ring{{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0.9}, {0.9, 0.9}, {0.9, 0.1}, {0, 0.1}};  // a C
    const HoleCentre hole = hole_centre(ring);
    const auto in_corner = [](double t) { return t > 0 && t < 1; };
    EXPECT_TRUE(in_corner(hole.centre.real()) && in_corner(hole.centre.imag()));
    EXPECT_FALSE(hole.centre.real() < 0.9 && hole.centre.imag() > 0.1 && hole.centre.imag() < 0.9);
    for (const Complex z : ring) EXPECT_GE(std::abs(z - hole.centre), 0.5 * hole.radius * (1 - 1e-12));
    const Complex turn = std::polar(3.0, 0.7), shift(5, -2);
    std::vector<Complex> turned;
    for (const Complex z : ring) turned.push_back(turn * z + shift);
    const HoleCentre other = hole_centre(turned);
    EXPECT_LT(std::abs(other.centre - (turn * hole.centre + shift)), 1e-12);
    EXPECT_NEAR(other.radius, 3 * hole.radius, 1e-12);
}

TEST(HoleRounding, MapsOfTheDiskKeepTheCircleAndKnowTheirDerivative) {
    CircleMap map;
    map.poles.push_back({{0.3, 0.2}, 0.1, Eigen::VectorXcd::Zero(3)});
    map.poles.push_back({{-0.4, 0}, 0.2, Eigen::VectorXcd::Zero(2)});
    map.poles[0].coefficients << Complex(0.05, 0.02), Complex(-0.03, 0.01), Complex(0.02, 0.02);
    map.poles[1].coefficients << Complex(0.01, -0.05), Complex(0.04, 0.03);
    for (int i = 0; i < 20; ++i) EXPECT_NEAR(std::abs(map(std::polar(1.0, 0.3 * i))[0]), 1, 1e-14);
    const double h = 1e-5;
    for (const Complex z : {Complex(0.6, 0.4), Complex(0, -0.7), Complex(-0.1, 0.3)})
        for (const Complex step : {Complex(h, 0), Complex(0, h)})
            EXPECT_LT(std::abs((map(z + step)[0] - map(z - step)[0]) / (2.0 * step) - map(z)[1]), 1e-9);
}

TEST(HoleRounding, EllipsesBecomeRound) {
    const std::vector<std::vector<Complex>> mild{ellipse({0.4, 0.1}, 0.3, 0.15, 0.5),
                                                 ellipse({-0.5, 0.2}, 0.2, 0.14, 2)};
    EXPECT_LT(round_holes(mild).ratio, 1.05);
    std::vector<std::vector<Complex>> rims = mild;
    rims.push_back(ellipse({-0.1, -0.5}, 0.3, 0.08, 0));
    const HoleRounding rounding = round_holes(rims);
    EXPECT_GT(rounding.ratio_before, 3.5);
    EXPECT_LT(rounding.ratio, 1.1);  // as round as ten powers a hole allow
    double worst = 1;
    for (const auto& rim : rims) {
        std::vector<Complex> moved;
        for (const Complex z : rim) moved.push_back(rounding(z)[0]);
        worst = std::max(worst, fit_circle(moved).ratio());
    }
    EXPECT_NEAR(worst, rounding.ratio, 1e-3);
    for (int i = 0; i < 20; ++i) EXPECT_NEAR(std::abs(rounding(std::polar(1.0, 0.3 * i))[0]), 1, 1e-13);
}

TEST(HoleRounding, LeavesRoundHolesAlone) {
    EXPECT_TRUE(round_holes({ellipse({0.3, 0.1}, 0.2, 0.2, 0), ellipse({-0.5, 0}, 0.3, 0.3, 0)}).steps.empty());
}

TEST(HoleRounding, TurnsWithTheDomain) {
    const Complex turn = std::polar(1.0, 1.1);
    const HoleRounding straight =
        round_holes({ellipse({0.4, 0.1}, 0.3, 0.15, 0.5), ellipse({-0.5, 0.2}, 0.2, 0.14, 2)});
    const HoleRounding turned = round_holes(
        {ellipse(turn * Complex(0.4, 0.1), 0.3, 0.15, 1.6), ellipse(turn * Complex(-0.5, 0.2), 0.2, 0.14, 3.1)});
    for (const Complex z : {Complex(0.9, 0.1), Complex(0, 0.5), Complex(0, -0.6)})
        EXPECT_LT(std::abs(turned(turn * z)[0] - turn * straight(z)[0]), 1e-9);
}

}  // namespace
}  // namespace beltrami
