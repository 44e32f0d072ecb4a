#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include <beltrami/base/parallel.h>
#include <beltrami/differentials/polynomial_space.h>
#include <beltrami/differentials/rational_space.h>
#include <beltrami/differentials/sampled_space.h>

namespace beltrami {
namespace {

/// What a space on samples sees of a chart: samples spread evenly over the disk outside a hole about 0, every 97th
/// excluded, with derivatives that vary.
Chart spiral_chart(int samples, double hole = 0.0) {
    Chart chart;
    chart.positions.resize(samples);
    chart.derivatives.resize(samples);
    chart.excluded.assign(samples, 0);
    for (int s = 0; s < samples; ++s) {
        const double t = (s + 0.5) / samples;
        chart.positions[s] = std::polar(std::sqrt(hole * hole + (1 - hole * hole) * t), 2.399963229728653 * s);
        chart.derivatives[s] = std::exp(0.5 * chart.positions[s]);
        chart.excluded[s] = s % 97 == 0;
    }
    return chart;
}

/// Cells would be nearly as small as samples around it: functions are evaluated afresh.
Singularities pin_at(Complex z) {
    Singularities result;
    result.pins = {z};
    return result;
}
Singularities hole_of(double radius) {
    Singularities result;
    result.holes = {{0.0, radius, 6}};
    return result;
}

std::unique_ptr<DifferentialSpace> space_for(const Singularities& singularities, const Chart& chart, int degree) {
    Eigen::VectorXcd points(2000);
    for (int i = 0; i < 2000; ++i) points[i] = chart.positions[i * (chart.positions.size() / 2000)];
    auto space =
        RationalSpace::starting_space(singularities, {points, Eigen::VectorXd::Constant(2000, 1.0 / 2000)}, degree);
    while (auto larger = space->refined()) space = std::move(larger);
    return space;
}

struct SampledCase {
    const char* name;
    int samples;
    double hole;
    bool pinned;
    int degree;
    double least_error, largest_error;  ///< as part of the largest value
};
std::ostream& operator<<(std::ostream& out, const SampledCase& c) {
    return out << c.name;
}

class SampledSpaces : public testing::TestWithParam<SampledCase> {
  protected:
    const SampledCase& how = GetParam();
    Chart chart = spiral_chart(how.samples, how.hole);
    Singularities singularities =
        how.pinned ? pin_at({0.31, 0.4}) : (how.hole > 0 ? hole_of(how.hole) : Singularities());
    std::unique_ptr<DifferentialSpace> space = space_for(singularities, chart, how.degree);
    SampledSpace sampled{chart, singularities, 0.4};
    Eigen::VectorXcd coefficients = Eigen::VectorXcd::Random(space->size());
    void SetUp() override { sampled.set(*space); }
};

TEST_P(SampledSpaces, CombinationsHaveTheirStatedAccuracy) {
    Eigen::VectorXcd exact = space->combination({chart.positions, chart.derivatives}, coefficients);
    const Eigen::VectorXcd found = sampled.combination(coefficients);
    double error = 0, size = 0;
    for (int s = 0; s < how.samples; ++s) {
        if (chart.excluded[s]) {
            EXPECT_EQ(found[s], 0.0);
            continue;
        }
        // Beside the pole of a pin errors are to be small against the value there.
        error = std::max(error, std::abs(found[s] - exact[s]) / (how.pinned ? std::abs(exact[s]) + 1 : 1));
        size = std::max(size, how.pinned ? 1.0 : std::abs(exact[s]));
    }
    EXPECT_LE(error, how.largest_error * size);
    EXPECT_GE(error, how.least_error * size);  // else another way was taken than the one to be tested
}

TEST_P(SampledSpaces, PairingIsTheAdjoint) {
    const Eigen::MatrixXcd weights = Eigen::MatrixXcd::Random(how.samples, 2);
    const Eigen::MatrixXcd paired = sampled.pair(weights);
    ASSERT_EQ(paired.rows(), space->size());
    ASSERT_EQ(paired.cols(), 2);
    const Eigen::VectorXcd phi = sampled.combination(coefficients);
    const double size = phi.norm() * weights.col(0).norm();
    for (int column = 0; column < 2; ++column) {
        const Complex along_samples = weights.col(column).transpose() * phi;
        const Complex along_basis = paired.col(column).transpose() * coefficients;
        EXPECT_LT(std::abs(along_samples - along_basis), 1e-12 * size);
    }
}

TEST_P(SampledSpaces, SameBytesOnAnyNumberOfThreads) {
    const Eigen::MatrixXcd weights = Eigen::MatrixXcd::Random(how.samples, 1);
    const int before = thread_count();
    set_thread_count(1);
    const Eigen::VectorXcd one = sampled.combination(coefficients);
    const Eigen::MatrixXcd paired = sampled.pair(weights);
    set_thread_count(3);
    EXPECT_EQ(sampled.combination(coefficients), one);
    EXPECT_EQ(sampled.pair(weights), paired);
    set_thread_count(before);
}

// Polynomials are made afresh where they are few for the samples. A cubic in a cell is off by 1e-5 for polynomials of
// degree 10, by half a percent for degree 40; by (7·8·9·6/24)(.0127/.35)⁴ of its size for the sixth power about a hole.
INSTANTIATE_TEST_SUITE_P(Ways, SampledSpaces,
                         testing::Values(SampledCase{"dense", 20'000, 0, false, 10, 0, 1e-12},
                                         SampledCase{"dense_with_a_pin", 20'000, 0, true, 10, 0, 1e-12},
                                         SampledCase{"interpolated", 1'000'000, 0, false, 10, 1e-9, 2e-5},
                                         SampledCase{"interpolated_of_high_degree", 300'000, 0, false, 40, 1e-5, 5e-3},
                                         SampledCase{"interpolated_with_a_hole", 700'000, 0.35, false, 10, 1e-9, 1e-4},
                                         SampledCase{"afresh", 50'000, 0, true, 10, 0, 1e-12},
                                         SampledCase{"afresh_with_a_small_hole", 50'000, 0.1, false, 10, 0, 1e-12}),
                         [](const auto& parameter) { return parameter.param.name; });

/// Of a regular set of points, the same ones turned.
Chart turned(Chart chart, double angle) {
    chart.positions *= std::polar(1.0, angle);
    return chart;
}

TEST(ChartGrid, HoldsEverySampleOnceInACellOfItsSize) {
    const Chart chart = spiral_chart(8000);
    Singularities singularities = pin_at({0.3, -0.2});
    singularities.holes = {{{-0.4, 0.1}, 0.2, 4}};
    const CellSize size(0.1, singularities, 0.25, 0.5, 1e-3);
    const double phase = 0.7;
    const ChartGrid grid = chart_grid(chart, phase, size);
    ASSERT_EQ(grid.cell_count(), static_cast<int>(grid.size.size()));
    EXPECT_EQ(grid.offsets.front(), 0);
    EXPECT_EQ(grid.offsets.back(), static_cast<int>(grid.samples.size()));
    std::set<int> seen;
    std::set<double> sizes;
    for (int c = 0; c < grid.cell_count(); ++c) {
        ASSERT_LT(grid.offsets[c], grid.offsets[c + 1]) << "an empty cell";
        sizes.insert(grid.size[c]);
        Eigen::Vector2d low(2, 2), high(-2, -2);
        for (int i = grid.offsets[c]; i < grid.offsets[c + 1]; ++i) {
            const int s = grid.samples[i];
            EXPECT_TRUE(seen.insert(s).second);
            EXPECT_EQ(grid.cell[s], c);
            EXPECT_EQ(grid.size[c], std::ldexp(size.largest(), -size.level(chart.positions[s])));
            if (i > grid.offsets[c]) {
                EXPECT_LT(grid.samples[i - 1], s);
            }
            const Complex z = std::polar(1.0, -phase) * chart.positions[s];
            low = low.cwiseMin(Eigen::Vector2d(z.real(), z.imag()));
            high = high.cwiseMax(Eigen::Vector2d(z.real(), z.imag()));
        }
        EXPECT_LE((high - low).maxCoeff(), grid.size[c] * (1 + 1e-12));
    }
    EXPECT_GE(sizes.size(), 4u);
    for (int s = 0; s < 8000; ++s) {
        EXPECT_EQ(grid.cell[s] >= 0, chart.excluded[s] == 0);
        EXPECT_EQ(seen.count(s), chart.excluded[s] == 0);
    }
}

TEST(ChartGrid, TurnsWithItsPhase) {
    const Chart chart = spiral_chart(5000);
    const CellSize size(0.07);
    const ChartGrid plain = chart_grid(chart, 0.2, size), same = chart_grid(turned(chart, 1.1), 1.3, size),
                    other = chart_grid(turned(chart, 1.1), 0.2, size);
    EXPECT_EQ(plain.samples, same.samples);
    EXPECT_EQ(plain.offsets, same.offsets);
    EXPECT_NE(plain.samples, other.samples);
}

TEST(ChartGrid, WithoutSamplesHasNoCells) {
    Chart chart = spiral_chart(50);
    chart.excluded.assign(50, 1);
    EXPECT_EQ(chart_grid(chart, 0, CellSize(0.1)).cell_count(), 0);
}

TEST(CellSize, IsTheLargestPowerOfTwoBelowSlopeTimesDistance) {
    Singularities singularities = pin_at({0.2, 0.1});
    singularities.corners = {{{0, 1}, {0, 1}, 0.5, 0.01}};
    singularities.holes = {{{-0.5, 0}, 0.2, 5}};
    const double largest = 0.05, slope = 0.25, hole_slope = 0.1, least = 1e-3;
    const CellSize size(largest, singularities, slope, hole_slope, least);
    int deepest = 0;
    for (int i = 0; i < 4000; ++i) {
        const Complex z = std::polar(std::sqrt(i / 4000.0), 2.4 * i);
        const double wanted = std::min({slope * std::abs(z - singularities.pins[0]),
                                        slope * std::abs(z - singularities.corners[0].vertex),
                                        hole_slope * std::abs(z - singularities.holes[0].centre)});
        const int level = size.level(z);
        const double edge = std::ldexp(largest, -level);
        deepest = std::max(deepest, level);
        if (wanted >= largest) {
            EXPECT_EQ(level, 0);
        } else if (wanted > least) {
            EXPECT_LE(edge, wanted * (1 + 1e-12));
            EXPECT_GT(edge, wanted / 2 * (1 - 1e-12));
        }
        EXPECT_GT(edge, least / 2);
    }
    EXPECT_GE(deepest, 4);
    EXPECT_EQ(size.level(singularities.pins[0]), 6);  // .05/2⁶ is the first below .001
    EXPECT_EQ(CellSize(0.05).level(0.3), 0);
    EXPECT_EQ(CellSize(0.05).largest(), 0.05);
}

}  // namespace
}  // namespace beltrami
