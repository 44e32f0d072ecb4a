#include <gtest/gtest.h>

#include <cmath>

#include <beltrami/base/constants.h>
#include <beltrami/differentials/slit_space.h>
#include <beltrami/linear/decomposition.h>

#include "support/mixed_domains.h"

namespace beltrami {
namespace {

const std::vector<double> kTwoArcs{1.5, 2.5, 4.4, 0.3 + kTurn};

Eigen::MatrixXcd values(const DifferentialSpace& space, const std::vector<Complex>& points) {
    ChartPoints at;
    at.positions = Eigen::Map<const Eigen::VectorXcd>(points.data(), static_cast<Eigen::Index>(points.size()));
    at.derivatives = Eigen::VectorXcd::Ones(at.positions.size());
    return space.evaluate(at);
}

std::vector<Complex> inside() {
    std::vector<Complex> points;
    for (double y = -0.97; y < 1; y += 0.061)
        for (double x = -0.97; x < 1; x += 0.061)
            if (std::abs(Complex(x, y)) < 0.98) points.emplace_back(x, y);
    return points;
}

TEST(SlitSpace, DescribesDisksThatSlideInPartWithPrescribedHoles) {
    MixedDomain domain = test::disk_with_sliding_arcs(kTwoArcs);
    EXPECT_TRUE(SlitSpace::describes(domain));
    domain.loops.push_back(test::whole_circle(0.3, 0.1, false));
    EXPECT_TRUE(SlitSpace::describes(domain));
    domain.loops.push_back(test::whole_circle(-0.3, 0.1, true));
    EXPECT_FALSE(SlitSpace::describes(domain));
    EXPECT_FALSE(SlitSpace::describes({{test::whole_circle(0, 1, false)}, {}, {}, {}}));
    EXPECT_FALSE(SlitSpace::describes({{test::whole_circle(0, 1, true)}, {}, {}, {}}));
}

TEST(SlitSpace, HasTheDimensionOfItsPowers) {
    // N + 2 for each slit, 2 for each pin and each power of a hole, 1 for each mark and each held point, less 3.
    MixedDomain domain = test::disk_with_sliding_arcs({0, kTurn / 2});
    EXPECT_EQ(SlitSpace(domain, 12, 12, {}).size(), 12 + 2 - 3);
    domain.pins = {0.2, {-0.1, 0.4}};
    domain.held = {{{-0.4, -0.2}, {1, 2}}};
    EXPECT_EQ(SlitSpace(domain, 12, 12, {}).size(), 12 + 2 - 3 + 2 * 2 + 1);
    MixedDomain two = test::disk_with_sliding_arcs(kTwoArcs);
    two.loops.push_back(test::whole_circle({0.3, -0.1}, 0.1, false));
    two.marks = {{std::polar(1.0, 2.0), 0}};
    EXPECT_EQ(SlitSpace(two, 12, 12, {4}).size(), 2 * (12 + 2) - 3 + 2 * 4 + 1);
}

TEST(SlitSpace, IsRealAlongArcsThatSlideUpToTheirEnds) {
    MixedDomain domain = test::disk_with_sliding_arcs(kTwoArcs);
    domain.pins = {{0.2, 0.3}};
    domain.loops.push_back(test::whole_circle({-0.3, -0.2}, 0.15, false));
    const SlitSpace space(domain, 18, 18, {5});
    std::vector<Complex> points;
    for (const auto& [from, to] : {std::pair(1.5, 2.5), std::pair(4.4, 0.3 + kTurn)})
        for (const double part : {1e-6, 1e-3, 0.1, 0.33, 0.47, 0.8, 1 - 1e-6})
            points.push_back(std::polar(1.0, from + part * (to - from)));
    const Eigen::MatrixXcd phi = values(space, points);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto row = static_cast<Eigen::Index>(i);
        const Eigen::RowVectorXcd real = -points[i] * points[i] * phi.row(row);  // τ = i w
        EXPECT_LT(real.imag().cwiseAbs().maxCoeff(), 1e-7 * real.cwiseAbs().maxCoeff()) << points[i];
    }
}

TEST(SlitSpace, IsHolomorphicInsideWithSimplePolesAtPins) {
    MixedDomain domain = test::disk_with_sliding_arcs(kTwoArcs);
    domain.pins = {{0.2, 0.3}};
    const SlitSpace space(domain, 18, 18, {});
    constexpr double kStep = 1e-5;
    for (const Complex z : {Complex(-0.5, 0.3), Complex(0.1, -0.9), Complex(0.7, 0.6), Complex(0.22, 0.3)}) {
        const Eigen::MatrixXcd phi = values(space, {z + kStep, z - kStep, z + kI * kStep, z - kI * kStep, z});
        const Eigen::RowVectorXcd along = phi.row(0) - phi.row(1), across = phi.row(2) - phi.row(3);
        EXPECT_LT((across - kI * along).cwiseAbs().maxCoeff(), 1e-4 * along.cwiseAbs().maxCoeff()) << z;
    }
    const Eigen::MatrixXcd phi = values(space, {domain.pins[0] + 1e-4, domain.pins[0] + 1e-6});
    EXPECT_NEAR((phi.row(1).norm() / phi.row(0).norm()), 100, 1);
}

/// With one arc prescribed, t that takes it to a half circle and the arc that slides to its diameter: φ = p(t) dt² with
/// real polynomials p, which a lower degree of J holds wholly.
TEST(SlitSpace, IsThePolynomialsOfAHalfDisk) {
    const SlitSpace space(test::disk_with_sliding_arcs({0, kTurn / 2}), 16, 16, {});
    const std::vector<Complex> points = inside();
    const Eigen::MatrixXcd phi = values(space, points);
    Eigen::MatrixXd columns(2 * phi.rows(), phi.cols());
    columns << phi.real(), phi.imag();
    const Eigen::MatrixXd Q = orthonormal_columns(columns);
    for (int power = 0; power <= 15; ++power) {
        Eigen::VectorXd wanted(2 * phi.rows());
        for (std::size_t i = 0; i < points.size(); ++i) {
            const Complex s = std::sqrt(kI * (1.0 + points[i]) / (1.0 - points[i])), t = (s - kI) / (s + kI);
            const Complex dt = 2.0 * kI / ((s + kI) * (s + kI)) * kI / ((1.0 - points[i]) * (1.0 - points[i]) * s);
            const Complex value = std::pow(t, power) * dt * dt;
            wanted[static_cast<Eigen::Index>(i)] = value.real();
            wanted[static_cast<Eigen::Index>(i) + phi.rows()] = value.imag();
        }
        const double outside = (Q * (Q.transpose() * wanted) - wanted).norm() / wanted.norm();
        if (power <= 14)
            EXPECT_LT(outside, 1e-9) << power;
        else
            EXPECT_GT(outside, 1e-3);
    }
}

TEST(SlitSpace, GrowsAndKeepsItsFunctions) {
    MixedDomain domain = test::disk_with_sliding_arcs(kTwoArcs);
    domain.loops.push_back(test::whole_circle({-0.3, -0.2}, 0.15, false));
    const SlitSpace space(domain, 8, 20, {16});
    EXPECT_EQ(space.size(), 2 * (8 + 2) - 3 + 2 * 4);
    const auto larger = space.refined();
    ASSERT_NE(larger, nullptr);
    EXPECT_EQ(larger->size(), 2 * (12 + 2) - 3 + 2 * 6);
    const auto largest = larger->refined()->refined();
    ASSERT_NE(largest, nullptr);
    EXPECT_EQ(largest->size(), 2 * (20 + 2) - 3 + 2 * 10);
    EXPECT_EQ(largest->refined(), nullptr);
    const std::vector<Complex> points = inside();
    const Eigen::MatrixXcd before = values(space, points), after = values(*largest, points);
    EXPECT_LT((after.leftCols(space.size()) - before).cwiseAbs().maxCoeff(), 1e-9 * before.cwiseAbs().maxCoeff());
}

}  // namespace
}  // namespace beltrami
