#include <beltrami/base/constants.h>
#include <beltrami/certificate/chart_quadrilateral.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include <beltrami/certificate/modulus.h>
#include <beltrami/charts/round_disk.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

template <class Move>
std::vector<double> angles(int n, Move&& move) {
    std::vector<double> result;
    for (int i = 0; i < n; ++i) result.push_back(move(kTurn * i / n));
    return result;
}

double same(double t) {
    return t;
}
/// A Möbius map of the disk on the circle.
double moebius(double t) {
    const Complex a(0.3, -0.2), z = std::polar(1.0, t), w = (z - a) / (1.0 - std::conj(a) * z),
                                first = (1.0 - a) / (1.0 - std::conj(a));
    const double turn = std::arg(w / first);
    return turn < 0 ? turn + kTurn : turn;
}

TEST(ChartQuadrilateral, ConformalValuesForceNothing) {
    EXPECT_NEAR(quadrilateral_ratio(angles(200, same), angles(200, moebius)), 1, 1e-9);
}

TEST(ChartQuadrilateral, IsAtLeastThatOfFourGivenVerticesAndAtMostADilatation) {
    // A quarter is stretched to a third: the four vertices at its ends and opposite see some of that.
    const int n = 240;
    const auto stretched = [](double t) {
        const double quarter = kTurn / 4, third = kTurn / 3;
        return t < quarter ? t * third / quarter : third + (t - quarter) * (kTurn - third) / (kTurn - quarter);
    };
    const std::vector<double> from = angles(n, same), to = angles(n, stretched);
    const std::array<int, 4> corners{0, n / 4, n / 2, 3 * n / 4};
    std::array<double, 4> here, there;
    for (int i = 0; i < 4; ++i) {
        here[i] = from[corners[i]];
        there[i] = to[corners[i]];
    }
    const double given = std::exp(std::abs(std::log(disk_modulus(there) / disk_modulus(here))));
    EXPECT_GT(given, 1.05);
    const double found = quadrilateral_ratio(from, to);
    EXPECT_GE(found, given - 1e-12);
    // The radial extension is linear in log z, with the dilatations 4/3 and 9/8.
    EXPECT_LT(found, 4.0 / 3);
}

TEST(ChartQuadrilateral, OfADiskNeedsImagesOnACircle) {
    const Surface surface(disk(disk_rings_for_triangles(3'000)));
    const Chart chart = round_disk_chart(surface);
    std::vector<Complex> images, lobes;
    for (const int v : surface.topology.boundary_loops[0]) {
        const double t = std::arg(Complex(surface.mesh.positions(v, 0), surface.mesh.positions(v, 1)));
        images.push_back(Complex(3, 1) + std::polar(2.0, t + 0.5 * std::sin(t)));
        lobes.push_back(std::polar(1 + 0.2 * std::cos(3 * t), t));
    }
    const double K = chart_quadrilateral_estimate(surface, chart, images);
    EXPECT_GT(K, 1.05);
    EXPECT_LT(K, 2);  // of the radial extension of t + sin(t)/2
    EXPECT_EQ(chart_quadrilateral_estimate(surface, chart, lobes), 1);
}

}  // namespace
}  // namespace beltrami
