#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include <beltrami/base/error.h>
#include <beltrami/charts/chart.h>
#include <beltrami/differentials/polynomial_space.h>
#include <beltrami/differentials/sampled_space.h>
#include <beltrami/differentials/tabulated_space.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

Eigen::MatrixXcd some_values(int samples) {
    Eigen::MatrixXcd values(samples, 3);
    for (int s = 0; s < samples; ++s)
        for (int j = 0; j < 3; ++j) values(s, j) = {std::sin(1.7 * s + j), std::cos(0.3 * s * (j + 1))};
    return values;
}

TEST(TabulatedSpace, KnowsItsValuesAndNothingElse) {
    const Eigen::MatrixXcd values = some_values(10);
    const TabulatedSpace space(values);
    EXPECT_EQ(space.size(), 3);
    EXPECT_FALSE(space.complex_coefficients());
    EXPECT_TRUE(TabulatedSpace(values, Coefficients::complex).complex_coefficients());
    ASSERT_NE(space.tabulated(), nullptr);
    EXPECT_EQ(*space.tabulated(), values);
    EXPECT_EQ(space.refined(), nullptr);
    EXPECT_THROW(space.generators({Eigen::VectorXcd::Zero(1), Eigen::VectorXcd::Ones(1)}), std::logic_error);
    EXPECT_EQ(PolynomialSpace(3, 3).tabulated(), nullptr);
}

TEST(TabulatedSpace, RefusesValuesThatAreNotFinite) {
    Eigen::MatrixXcd values = some_values(10);
    values(7, 1) = {0, NAN};
    values(4, 2) = INFINITY;
    try {
        const TabulatedSpace space(values);
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.cause(), Cause::bad_option);
        EXPECT_EQ(error.indices(), (std::vector{4, 7}));
    }
}

/// Whatever their number: charts of 90 000 samples are interpolated otherwise, those with a pin evaluated afresh.
TEST(TabulatedSpace, CombinationsAndPairingsAreThoseOfTheTable) {
    for (const int samples : {500, 90'000})
        for (const bool pinned : {false, true}) {
            Chart chart;
            chart.positions.resize(samples);
            for (int s = 0; s < samples; ++s) chart.positions[s] = std::polar(std::sqrt((s + 0.5) / samples), 2.4 * s);
            chart.derivatives = Eigen::VectorXcd::Constant(samples, {0.3, 2});
            chart.excluded.assign(samples, 0);
            chart.excluded[7] = 1;
            Singularities singularities;
            if (pinned) singularities.pins = {{0.31, 0.4}};
            SampledSpace sampled(chart, singularities, 0.4);
            const PolynomialSpace other(2, 2);
            sampled.set(other);
            Eigen::MatrixXcd values = some_values(samples);
            const TabulatedSpace space(values);
            sampled.set(space);
            values.row(7).setZero();
            const Eigen::VectorXcd c = Eigen::VectorXcd::Random(3);
            const Eigen::MatrixXcd weights = Eigen::MatrixXcd::Random(samples, 2);
            EXPECT_LT((sampled.combination(c) - values * c).cwiseAbs().maxCoeff(), 1e-13);
            EXPECT_LT((sampled.pair(weights) - values.transpose() * weights).norm(), 1e-11 * weights.norm());
            // And back: the space before is as it was.
            SampledSpace fresh(chart, singularities, 0.4);
            fresh.set(other);
            sampled.set(other);
            EXPECT_EQ(sampled.combination(c), fresh.combination(c));
        }
}

TEST(TabulatedSpace, HasToBelongToTheSamples) {
    const Surface surface(disk(3));
    const Chart chart = chart_of_frames(surface);
    SampledSpace sampled(chart, {}, 0);
    const TabulatedSpace space(some_values(10));
    EXPECT_THROW(sampled.set(space), std::logic_error);
}

TEST(ChartOfFrames, IsASimilarityToTheAreaPi) {
    const Surface surface(test::bump(500));
    const Chart chart = chart_of_frames(surface);
    double area = 0;
    for (int s = 0; s < surface.operators.sample_count(); ++s)
        area += surface.operators.weights[s] * std::norm(chart.derivatives[s]);
    EXPECT_NEAR(area, std::numbers::pi, 1e-12);
    EXPECT_EQ(chart.positions.size(), 0);
}

}  // namespace
}  // namespace beltrami
