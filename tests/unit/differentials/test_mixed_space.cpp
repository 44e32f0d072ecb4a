#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <beltrami/base/constants.h>
#include <beltrami/differentials/mixed_space.h>
#include <beltrami/generate/round_domains.h>
#include <beltrami/linear/decomposition.h>
#include <beltrami/mesh/planar.h>

#include "support/mixed_domains.h"

namespace beltrami {
namespace {

MixedDomain ring_with_sliding_inner_circle(double r) {
    return {{test::whole_circle(0, 1, false), test::whole_circle(0, r, true)}, {}, {}, {}};
}

MixedDomain two_sliding_holes(std::vector<Complex> pins = {}) {
    return {{test::whole_circle(0, 1, false), test::whole_circle({-0.4, 0.1}, 0.2, true),
             test::whole_circle(0.35, 0.25, true)},
            {},
            std::move(pins),
            {}};
}

ChartPoints in_mixed_domain(const std::vector<Complex>& points) {
    ChartPoints result;
    result.positions = Eigen::Map<const Eigen::VectorXcd>(points.data(), static_cast<Eigen::Index>(points.size()));
    result.derivatives = Eigen::VectorXcd::Ones(result.positions.size());
    return result;
}

std::vector<Complex> inside(const MixedDomain& domain, double margin = 0.02) {
    std::vector<Complex> points;
    for (double y = -1; y < 1; y += 0.061)
        for (double x = -1; x < 1; x += 0.061) {
            const Complex z(x, y);
            bool in = std::abs(z) < 1 - margin;
            for (std::size_t l = 1; l < domain.loops.size(); ++l)
                in = in && std::abs(z - domain.loops[l].centre) > domain.loops[l].radius + margin;
            for (const Complex pin : domain.pins) in = in && std::abs(z - pin) > margin;
            if (in) points.push_back(z);
        }
    return points;
}

/// Part of f that is not a real combination of the columns, in the mean square.
double outside_of_span(const Eigen::MatrixXcd& values, const Eigen::VectorXcd& f) {
    Eigen::MatrixXd columns(2 * values.rows(), values.cols());
    columns << values.real(), values.imag();
    Eigen::VectorXd wanted(2 * f.size());
    wanted << f.real(), f.imag();
    const Eigen::MatrixXd Q = orthonormal_columns(columns);
    return (Q * (Q.transpose() * wanted) - wanted).norm() / wanted.norm();
}

Eigen::VectorXcd values_of(const std::vector<Complex>& points, const std::function<Complex(Complex)>& f) {
    Eigen::VectorXcd result(static_cast<Eigen::Index>(points.size()));
    for (std::size_t i = 0; i < points.size(); ++i) result[static_cast<Eigen::Index>(i)] = f(points[i]);
    return result;
}

TEST(MixedSpace, HasTheDimensionOfTheTheoryWhereLoopsHaveOneConditionEach) {
    // 2(N+1) + 3n + 2q
    const auto dimension = [](MixedDomain domain, int degree, std::vector<int> powers) {
        const MixedSpace space(std::move(domain), degree, degree, std::move(powers));
        EXPECT_LT(space.fit().residual, 1e-6);
        EXPECT_GT(space.fit().next, 0.1);
        EXPECT_FALSE(space.complex_coefficients());
        return space.size();
    };
    EXPECT_EQ(dimension(ring_with_sliding_inner_circle(0.5), 10, {4}), 2 * 11 + 3);
    EXPECT_EQ(dimension(two_sliding_holes(), 14, {4, 4}), 36);
    EXPECT_EQ(dimension(two_sliding_holes({{-0.05, -0.55}}), 14, {4, 4}), 38);
    // A disk that slides, with 2, 3 and 5 pins: 2q − 3.
    const std::vector<Complex> pins{0.6, {0.1, 0.5}, {-0.5, 0.3}, {-0.4, -0.4}, {0.2, -0.5}};
    for (const int q : {2, 3, 5})
        EXPECT_EQ(dimension({{test::whole_circle(0, 1, true)}, {}, {pins.begin(), pins.begin() + q}, {}}, 8, {}),
                  2 * q - 3);
    // A hole is prescribed, the outer circle slides: powers up to 4 (degree 8 begins with them), less 3.
    EXPECT_EQ(dimension({{test::whole_circle(0, 1, true), test::whole_circle(0, 0.5, false)}, {}, {}, {}}, 8, {4}),
              2 * 4 - 3);
}

TEST(MixedSpace, HoldsTheLaurentSeriesOfARing) {
    // φ z² = b + Σ b_l z^l + conj(b_l) (r²/z)^l is real on |z| = r.
    const double r = 0.5;
    const MixedDomain domain = ring_with_sliding_inner_circle(r);
    const MixedSpace space(domain, 8, 8, {4});
    const std::vector<Complex> points = inside(domain);
    const Eigen::MatrixXcd values = space.evaluate(in_mixed_domain(points));
    for (int l = 0; l <= 10; ++l)
        for (const Complex b : {Complex(1), kI}) {
            if (l == 0 && b == kI) continue;
            EXPECT_LT(outside_of_span(values, values_of(points,
                                                        [&](Complex z) {
                                                            return (b * std::pow(z, l) +
                                                                    std::conj(b) * std::pow(r * r / z, l)) /
                                                                   (z * z);
                                                        })),
                      1e-6)
                << l;
        }
    EXPECT_GT(outside_of_span(values, values_of(points, [](Complex z) { return kI / (z * z); })), 0.5);
}

TEST(MixedSpace, GrowsByWhatIsPrescribedAndKeepsItsFunctions) {
    const MixedDomain domain = two_sliding_holes({{-0.05, -0.55}});
    const MixedSpace space(domain, 6, 12, {4, 4});
    EXPECT_EQ(space.size(), 2 * 7 + 6 + 2);
    const auto larger = space.refined();
    ASSERT_NE(larger, nullptr);
    EXPECT_EQ(larger->size(), 2 * 11 + 6 + 2);
    const auto largest = larger->refined();
    ASSERT_NE(largest, nullptr);
    EXPECT_EQ(largest->size(), 2 * 13 + 6 + 2);
    EXPECT_EQ(largest->refined(), nullptr);
    const ChartPoints points = in_mixed_domain(inside(domain));
    const Eigen::MatrixXcd before = space.evaluate(points), after = largest->evaluate(points);
    EXPECT_LT((after.leftCols(space.size()) - before).cwiseAbs().maxCoeff(), 1e-9 * before.cwiseAbs().maxCoeff());
}

TEST(MixedSpace, IsRealAlongArcsThatSlideUpToTheirEnds) {
    const MixedSpace space(test::disk_with_sliding_arcs({1.5, 2.5, 4.4, 0.3 + kTurn}), 14, 14, {});
    EXPECT_GT(space.size(), 12);
    EXPECT_LT(space.fit().last, 0.03);
    EXPECT_GT(space.fit().next, 0.03);
    // Most functions are far more real than the last one.
    for (const double t : {1.5 + 1e-4, 1.5 + 1e-2, 2.0, 2.49, 4.41, 5.0, 6.5}) {
        const Complex z = std::polar(1.0, t);
        const Eigen::RowVectorXcd values = space.evaluate(in_mixed_domain({z})) * (-z * z);
        EXPECT_LT(values.imag().norm(), 0.1 * values.norm()) << t;
    }
    const Complex z = std::polar(1.0, 3.4);  // prescribed: anything
    const Eigen::RowVectorXcd there = space.evaluate(in_mixed_domain({z})) * (-z * z);
    EXPECT_GT(there.imag().norm(), 0.3 * there.norm());
}

/// t takes the disk to a half disk, its upper half circle to the diameter: φ dz² = P(t) dt² with real P.
TEST(MixedSpace, HoldsTheDifferentialsOfTheDoubleOverAHalfCircle) {
    const MixedDomain domain = test::disk_with_sliding_arcs({0, std::numbers::pi});
    const MixedSpace space(domain, 12, 12, {});
    const std::vector<Complex> points = inside(domain);
    const Eigen::MatrixXcd values = space.evaluate(in_mixed_domain(points));
    const auto t_of = [](Complex z) {
        const Complex s = std::sqrt(kI * (1.0 + z) / (1.0 - z));
        return (s - kI) / (s + kI);
    };
    const auto derivative = [&](Complex z) {
        const Complex s = std::sqrt(kI * (1.0 + z) / (1.0 - z));
        return 2.0 * kI / ((s + kI) * (s + kI)) * 0.5 / s * 2.0 * kI / ((1.0 - z) * (1.0 - z));
    };
    for (int power = 0; power <= 4; ++power) {
        const auto phi = [&](Complex z) { return std::pow(t_of(z), power) * derivative(z) * derivative(z); };
        EXPECT_LT(outside_of_span(values, values_of(points, phi)), 1e-3) << power;
    }
}

TEST(MixedSpace, TurnsWithItsDomain) {
    const double angle = 0.7;
    const Complex turn = std::polar(1.0, angle);
    const MixedDomain domain = test::disk_with_sliding_arcs({0.3, 1.5, 2.5, 4.4}),
                      turned = test::disk_with_sliding_arcs({0.3 + angle, 1.5 + angle, 2.5 + angle, 4.4 + angle});
    const MixedSpace one(domain, 10, 10, {}), other(turned, 10, 10, {});
    ASSERT_EQ(one.size(), other.size());
    const std::vector<Complex> points = inside(domain);
    std::vector<Complex> images = points;
    for (Complex& z : images) z *= turn;
    const Eigen::MatrixXcd values = one.evaluate(in_mixed_domain(points)),
                           there = turn * turn * other.evaluate(in_mixed_domain(images));
    for (Eigen::Index j = 0; j < there.cols(); ++j) EXPECT_LT(outside_of_span(values, there.col(j)), 1e-5);
}

TEST(MixedSpace, PolesAtPointsOfLinesHaveTheirResidue) {
    MixedDomain domain{{test::whole_circle(0, 1, false)}, {}, {}, {{Complex(0.2, 0.1), std::polar(1.0, 0.4)}}};
    const MixedSpace space(domain, 6, 6, {});
    EXPECT_EQ(space.size(), 2 * 7 + 1);
    const std::vector<Complex> points = inside(domain);
    const Eigen::MatrixXcd values = space.evaluate(in_mixed_domain(points));
    const auto pole = [&](Complex residue) {
        return values_of(points, [&](Complex z) { return residue / (z - domain.held[0].at); });
    };
    EXPECT_LT(outside_of_span(values, pole(domain.held[0].residue)), 1e-6);
    EXPECT_GT(outside_of_span(values, pole(kI * domain.held[0].residue)), 0.1);
}

TEST(MixedDomain, FollowsWhatIsHeldAlongTheLoops) {
    const Surface surface(annulus(0.5, 1, 40));
    const auto& loops = surface.topology.boundary_loops;
    const Eigen::VectorXcd z = planar_coordinates(surface.mesh);
    Chart chart = make_chart(surface, z, true);
    chart.holes = {{1, 0.0, 0.5}};
    std::vector<std::vector<char>> held{std::vector<char>(loops[0].size(), 0), std::vector<char>(loops[1].size(), 0)};
    // The outer loop is prescribed from position 38 to 3 and marked at 10; the inner one wholly slides.
    for (const int i : {38, 39, 0, 1, 2, 3, 10}) held[0][i] = 1;
    const MixedDomain domain = mixed_domain(surface, chart, held, {});
    ASSERT_EQ(domain.loops.size(), 2u);
    ASSERT_EQ(domain.loops[0].transitions.size(), 2u);
    ASSERT_EQ(domain.marks.size(), 1u);
    EXPECT_NEAR(std::abs(domain.marks[0].at - z[loops[0][10]]), 0, 1e-12);
    EXPECT_FALSE(domain.closed());
    double around = 0;
    for (const auto& part : domain.loops[0].parts) {
        around += part.to - part.from;
        if (part.slides) continue;
        EXPECT_NEAR(std::abs(std::polar(1.0, part.from) - z[loops[0][38]]), 0, 1e-12);
        EXPECT_NEAR(std::abs(std::polar(1.0, part.to) - z[loops[0][3]]), 0, 1e-12);
    }
    EXPECT_NEAR(around, kTurn, 1e-12);
    EXPECT_EQ(domain.loops[1].parts.size(), 1u);
    EXPECT_TRUE(domain.loops[1].parts[0].slides);
}

}  // namespace
}  // namespace beltrami
