#include <beltrami/base/constants.h>
#include <beltrami/differentials/curve_densities.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>

namespace beltrami {
namespace {

Singularities::Curve curve_of(std::vector<Complex> points, bool real = false, bool closed = false) {
    const int last = static_cast<int>(points.size()) - 1;
    return {std::move(points), 0, last, real, closed};
}

std::vector<Complex> segment(Complex from, Complex to, int edges) {
    std::vector<Complex> points;
    for (int i = 0; i <= edges; ++i) points.push_back(from + (to - from) * (static_cast<double>(i) / edges));
    return points;
}

std::vector<Complex> arc(double radius, double from, double to, int edges) {
    std::vector<Complex> points;
    for (int i = 0; i <= edges; ++i) points.push_back(std::polar(radius, from + (to - from) * i / edges));
    return points;
}

Eigen::VectorXcd some_places() {
    Eigen::VectorXcd z(5);
    z << Complex(0.3, 0.2), Complex(-0.4, 0.7), Complex(0.1, -0.05), Complex(2, -1), Complex(-0.2, -0.6);
    return z;
}

TEST(CurveDensities, OfADensityThatIsOneAreTheLogarithm) {
    const Complex a(-0.6, -0.1), b(0.5, 0.3);
    const CurveDensities curve(curve_of(segment(a, b, 12)));
    const Eigen::VectorXcd z = some_places();
    const Eigen::VectorXcd found = curve.integral(z, Eigen::VectorXcd::Ones(13));
    for (Eigen::Index i = 0; i < z.size(); ++i)
        EXPECT_LT(std::abs(found[i] - std::log((b - z[i]) / (a - z[i])) / (2 * std::numbers::pi * kI)), 1e-14);
    // The hats of the first level make it.
    const int hats = curve.size_up_to(0);
    const Eigen::VectorXcd sum = curve.weights(z) * curve.densities().leftCols(hats).rowwise().sum();
    EXPECT_LT((sum - found).norm(), 1e-14);
}

TEST(CurveDensities, ConvergeInSecondOrder) {
    // ∫_{−1}^{1} t²/(t − z) dt = 2z + z² log((1 − z)/(−1 − z)).
    const Eigen::VectorXcd z = some_places();
    std::vector<double> error;
    for (const int edges : {20, 40, 80}) {
        const auto points = segment(-1, 1, edges);
        Eigen::VectorXcd density(edges + 1);
        for (int i = 0; i <= edges; ++i) density[i] = points[i] * points[i];
        const Eigen::VectorXcd found = CurveDensities(curve_of(points)).integral(z, density);
        double worst = 0;
        for (Eigen::Index i = 0; i < z.size(); ++i) {
            const Complex exact =
                (2.0 * z[i] + z[i] * z[i] * std::log((1.0 - z[i]) / (-1.0 - z[i]))) / (2 * std::numbers::pi * kI);
            worst = std::max(worst, std::abs(found[i] - exact));
        }
        error.push_back(worst);
    }
    EXPECT_LT(error[2], 1e-4);
    for (int i = 0; i < 2; ++i) EXPECT_NEAR(std::log2(error[i] / error[i + 1]), 2, 0.2);
}

TEST(CurveDensities, JumpFromRightToLeft) {
    const auto points = arc(0.8, 0.3, 2.0, 20);
    const CurveDensities curve(curve_of(points));
    for (int j = 0; j < curve.size(); ++j)
        for (int i = 0; i < 20; ++i) {
            const Complex along = points[i + 1] - points[i], at = points[i] + 0.37 * along;
            Eigen::VectorXcd z(2);
            z << at + 1e-9 * kI * along, at - 1e-9 * kI * along;
            const Eigen::VectorXcd values = curve.weights(z) * curve.densities().col(j);
            const Complex density = 0.63 * curve.densities()(i, j) + 0.37 * curve.densities()(i + 1, j);
            EXPECT_LT(std::abs(values[0] - values[1] - density), 1e-7);
        }
}

TEST(CurveDensities, AreRealAlongTheCurveWhereAskedFor) {
    auto points = arc(0.8, 0.3, 2.0, 24);
    Singularities::Curve curve = curve_of(points, true);
    curve.points.push_back(1.4 * points.back());  // goes on beyond the domain
    const CurveDensities densities(curve);
    int outside = 0;
    for (int j = 0; j < densities.size(); ++j) {
        if (!densities.real(j)) {
            ++outside;
            EXPECT_EQ(densities.densities().col(j).head(25).norm(), 0.0);
            continue;
        }
        for (int i = 1; i < 24; ++i) {
            const Complex tangent = (points[i + 1] - points[i - 1]) / std::abs(points[i + 1] - points[i - 1]);
            EXPECT_LT(std::abs(std::imag(densities.densities()(i, j) * tangent * tangent)), 1e-12);
        }
    }
    EXPECT_EQ(outside, 1);
}

TEST(CurveDensities, OfAClosedCurveTellInsideFromOutside) {
    auto points = arc(0.8, 0, 2 * std::numbers::pi, 40);
    points.back() = points.front();
    const CurveDensities curve(curve_of(points, false, true));
    const int hats = curve.size_up_to(0);
    const Eigen::VectorXcd z = some_places();
    const Eigen::VectorXcd sum = curve.weights(z) * curve.densities().leftCols(hats).rowwise().sum();
    for (Eigen::Index i = 0; i < z.size(); ++i) EXPECT_LT(std::abs(sum[i] - (std::abs(z[i]) < 0.8 ? 1.0 : 0.0)), 1e-13);
}

TEST(CurveDensities, ComeInLevelsUntilThereAreNoMorePoints) {
    const CurveDensities curve(curve_of(segment(-1, 1, 9)));
    ASSERT_GE(curve.levels(), 1);
    for (int level = 1; level < curve.levels(); ++level)
        EXPECT_GT(curve.size_up_to(level), curve.size_up_to(level - 1));
    EXPECT_LE(curve.size(), 10);
    // Independent, as densities.
    EXPECT_EQ(curve.densities().fullPivLu().rank(), curve.size());
    const CurveDensities shortest(curve_of(segment(-1, 1, 1)));
    EXPECT_EQ(shortest.levels(), 1);
    EXPECT_EQ(shortest.size(), 2);
}

}  // namespace
}  // namespace beltrami
