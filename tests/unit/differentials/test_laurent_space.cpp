#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <beltrami/base/error.h>
#include <beltrami/differentials/dimension.h>
#include <beltrami/differentials/laurent_space.h>
#include <beltrami/differentials/sampled_space.h>
#include <beltrami/linear/decomposition.h>

namespace beltrami {
namespace {

ChartPoints in_domain(const std::vector<Complex>& points) {
    ChartPoints result;
    result.positions = Eigen::Map<const Eigen::VectorXcd>(points.data(), static_cast<Eigen::Index>(points.size()));
    result.derivatives = Eigen::VectorXcd::Ones(result.positions.size());
    return result;
}

/// Places of a grid inside a domain, away from its boundary and its marks.
std::vector<Complex> inside(const RoundDomain& domain, double step, double margin = 0.01) {
    std::vector<Complex> points;
    const double R = domain.outer.radius;
    for (double y = -R; y < R; y += step)
        for (double x = -R; x < R; x += step) {
            const Complex z = domain.outer.centre + Complex(x, y);
            bool in = std::abs(z - domain.outer.centre) < R - margin;
            for (const auto& hole : domain.holes) in = in && std::abs(z - hole.centre) > hole.radius + margin;
            if (in) points.push_back(z);
        }
    return points;
}

/// Largest |Im φτ²| / |φ|∞ of the space at so many places of every circle, as part of the mean |φ| there; marks kept
/// away from.
double largest_imaginary_part(const LaurentSpace& space, int around, double from_marks = 0.05) {
    double largest = 0, mean = 0;
    int count = 0;
    for (int c = 0; c < space.domain().circle_count(); ++c)
        for (int i = 0; i < around; ++i) {
            const Complex direction = std::polar(1.0, 2 * std::numbers::pi * (i + 0.41) / around);
            const Complex z = space.domain().circle(c).centre + space.domain().circle(c).radius * direction;
            bool near = false;
            for (const Complex p : space.domain().boundary_marks) near = near || std::abs(z - p) < from_marks;
            if (near) continue;
            const Eigen::MatrixXcd values = space.evaluate(in_domain({z}));
            largest = std::max(largest, (values * direction * direction).imag().cwiseAbs().maxCoeff());
            mean += values.cwiseAbs().maxCoeff();
            ++count;
        }
    return largest / (mean / count);
}

/// Part of f (one column) that is not a real combination of the columns of values, in the mean square.
double outside(const Eigen::MatrixXcd& values, const Eigen::VectorXcd& f) {
    Eigen::MatrixXd columns(2 * values.rows(), values.cols());
    columns << values.real(), values.imag();
    Eigen::VectorXd wanted(2 * f.size());
    wanted << f.real(), f.imag();
    const Eigen::MatrixXd Q = orthonormal_columns(columns);
    return (Q * (Q.transpose() * wanted) - wanted).norm() / wanted.norm();
}

struct DomainCase {
    const char* name;
    RoundDomain domain;
    int dimension;
};
std::ostream& operator<<(std::ostream& out, const DomainCase& c) {
    return out << c.name;
}

RoundDomain with_marks(RoundDomain domain, const std::vector<double>& outer_angles) {
    for (const double t : outer_angles)
        domain.boundary_marks.push_back(domain.outer.centre + std::polar(domain.outer.radius, t));
    return domain;
}

const RoundDomain kDisk{};
const RoundDomain kRing{{}, {{0.0, 0.5}}, {}, {}};
const RoundDomain kEccentric{{}, {{Complex(0.2, 0.1), 0.5}}, {}, {}};
const RoundDomain kTwo{{}, {{Complex(-0.4, 0.1), 0.2}, {0.35, 0.25}}, {}, {}};
const RoundDomain kThree{{}, {{Complex(-0.5, -0.2), 0.1}, {Complex(0.5, -0.2), 0.15}, {Complex(0, 0.5), 0.1}}, {}, {}};
const RoundDomain kCollinear{{}, {{-0.5, 0.15}, {0.0, 0.15}, {0.5, 0.15}}, {}, {}};
const RoundDomain kElsewhere{{Complex(3, -2), 2.5}, {{Complex(2, -1.5), 0.5}, {Complex(4, -2.4), 0.7}}, {}, {}};

RoundDomain symmetric(int holes, double at, double radius) {
    RoundDomain domain;
    for (int i = 0; i < holes; ++i) domain.holes.push_back({std::polar(at, 2 * std::numbers::pi * i / holes), radius});
    return domain;
}
RoundDomain grid_of_nine() {
    RoundDomain domain;
    for (int i = -1; i <= 1; ++i)
        for (int j = -1; j <= 1; ++j) domain.holes.push_back({Complex(0.45 * i, 0.45 * j), 0.12});
    return domain;
}
RoundDomain with_inner_marks(RoundDomain domain) {
    domain.interior_marks = {Complex(0.08, 0.05), Complex(-0.1, -0.6)};
    return domain;
}
RoundDomain marks_on_holes(RoundDomain domain) {
    for (const auto& hole : domain.holes) domain.boundary_marks.push_back(hole.centre + std::polar(hole.radius, 2.2));
    return with_marks(domain, {0.3, 0.5});
}

class LaurentSpaces : public testing::TestWithParam<DomainCase> {};

TEST_P(LaurentSpaces, HaveTheDimensionOfTheTheoryAndAreRealOnTheBoundary) {
    const LaurentSpace space(GetParam().domain);
    EXPECT_EQ(space.size(), GetParam().dimension);
    EXPECT_FALSE(space.complex_coefficients());
    EXPECT_EQ(space.refined(), nullptr);
    EXPECT_LT(space.fit().residual, 1e-9);
    EXPECT_GT(space.fit().next, 1e-3);
    EXPECT_LT(largest_imaginary_part(space, 397), 2e-8);
}

INSTANTIATE_TEST_SUITE_P(Domains, LaurentSpaces,
                         testing::Values(DomainCase{"ring", kRing, 1}, DomainCase{"eccentric", kEccentric, 1},
                                         DomainCase{"ring_one_mark", with_marks(kRing, {1.0}), 1},
                                         DomainCase{"ring_two_marks", with_marks(kRing, {1.0, 2.5}), 2},
                                         DomainCase{"eccentric_marks_on_both", marks_on_holes(kEccentric), 3},
                                         DomainCase{"two", kTwo, 3}, DomainCase{"three", kThree, 6},
                                         DomainCase{"collinear", kCollinear, 6},
                                         DomainCase{"symmetric_four", symmetric(4, 0.55, 0.2), 9},
                                         DomainCase{"nine", grid_of_nine(), 24}, DomainCase{"elsewhere", kElsewhere, 3},
                                         DomainCase{"four_marks", with_marks(kDisk, {0.1, 1, 2, 4}), 1},
                                         DomainCase{"six_marks", with_marks(kDisk, {0.1, 0.3, 2, 2.5, 4, 5}), 3},
                                         DomainCase{"two_and_marks", marks_on_holes(kTwo), 7},
                                         DomainCase{"two_and_inner_marks", with_inner_marks(kTwo), 7},
                                         DomainCase{"near_marks", with_marks(kDisk, {0, 0.01, 3, 3.002}), 1}),
                         [](const auto& parameter) { return parameter.param.name; });

TEST(LaurentSpace, OfARingIsOneOverZSquared) {
    const LaurentSpace space(kRing);
    const std::vector<Complex> points = inside(kRing, 0.05);
    const Eigen::MatrixXcd values = space.evaluate(in_domain(points));
    for (std::size_t i = 0; i < points.size(); ++i)
        EXPECT_NEAR(
            std::abs(values(static_cast<int>(i), 0) * points[i] * points[i] / (values(0, 0) * points[0] * points[0]) -
                     1.0),
            0, 1e-12);
    // Real with a real factor.
    EXPECT_NEAR(std::arg(std::pow(values(0, 0) * points[0] * points[0], 2)), 0, 1e-12);
}

TEST(LaurentSpace, OfAnEccentricRingIsThatOfTheRing) {
    // w = (z + a)/(1 + a z) sends the unit disk to itself and a round ring to an eccentric one.
    const double a = 0.3, r = 0.4;
    const double left = (-r + a) / (1 - a * r), right = (r + a) / (1 + a * r);
    const LaurentSpace space({{}, {{0.5 * (left + right), 0.5 * (right - left)}}, {}, {}});
    const std::vector<Complex> points = inside(space.domain(), 0.05);
    Eigen::VectorXcd exact(static_cast<Eigen::Index>(points.size()));
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Complex w = points[i], z = (w - a) / (1.0 - a * w), slope = (1 - a * a) / ((1.0 - a * w) * (1.0 - a * w));
        exact[static_cast<Eigen::Index>(i)] = slope * slope / (z * z);
    }
    EXPECT_LT(outside(space.evaluate(in_domain(points)), exact), 1e-9);
}

TEST(LaurentSpace, OfADiskWithFourMarksIsTheirProduct) {
    for (const std::vector<double>& angles :
         {std::vector{0.1, 1.0, 2.0, 4.0}, std::vector{0.0, 0.01, 3.0, 3.002}, std::vector{0.5, 0.6, 0.7, 0.8}}) {
        const LaurentSpace space(with_marks(kDisk, angles));
        const std::vector<Complex> points = inside(kDisk, 0.05);
        Eigen::VectorXcd exact = Eigen::VectorXcd::Ones(static_cast<Eigen::Index>(points.size()));
        Complex factor = 1;
        for (const double t : angles) {
            factor *= std::polar(1.0, 0.5 * t);
            for (std::size_t i = 0; i < points.size(); ++i)
                exact[static_cast<Eigen::Index>(i)] /= points[i] - std::polar(1.0, t);
        }
        EXPECT_LT(outside(space.evaluate(in_domain(points)), factor * exact), 1e-9);
    }
}

TEST(LaurentSpace, TurnsWithTheDomain) {
    const Complex turn = std::polar(1.0, 0.7);
    RoundDomain turned = marks_on_holes(kTwo);
    for (auto& hole : turned.holes) hole.centre *= turn;
    for (Complex& p : turned.boundary_marks) p *= turn;
    std::swap(turned.holes[0], turned.holes[1]);
    const LaurentSpace one(marks_on_holes(kTwo)), other(turned);
    std::vector<Complex> points = inside(kTwo, 0.07);
    const Eigen::MatrixXcd values = one.evaluate(in_domain(points));
    for (Complex& z : points) z *= turn;
    const Eigen::MatrixXcd other_values = turn * turn * other.evaluate(in_domain(points));
    for (int j = 0; j < other.size(); ++j) EXPECT_LT(outside(values, other_values.col(j)), 1e-9);
}

TEST(LaurentSpace, PulledBackValuesTransformAsQuadraticDifferentials) {
    const LaurentSpace space(kThree);
    const ChartPoints plain = in_domain(inside(kThree, 0.2));
    ChartPoints turned = plain;
    turned.derivatives *= std::polar(2.0, 0.6);
    EXPECT_LT((space.evaluate(turned) - std::polar(4.0, 1.2) * space.evaluate(plain)).cwiseAbs().maxCoeff(), 1e-12);
    const Eigen::VectorXcd c = Eigen::VectorXcd::Random(6).real().cast<Complex>();
    EXPECT_LT((space.combination(plain, c) - space.evaluate(plain) * c).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(LaurentSpace, HolesThatNearlyTouchTakeMorePowers) {
    int last = 0;
    for (const double gap : {0.2, 0.02, 0.002}) {
        const LaurentSpace space({{}, {{-0.25 - gap / 2, 0.25}, {0.25 + gap / 2, 0.25}}, {}, {}});
        EXPECT_EQ(space.size(), 3);
        EXPECT_LT(space.fit().residual, gap < 0.01 ? 1e-4 : 1e-8);
        EXPECT_GE(space.fit().degree, last);
        last = space.fit().degree;
    }
    EXPECT_GT(last, 16);
}

/// On large meshes functions are interpolated in cells, or evaluated afresh where marks ask for small ones.
TEST(LaurentSpace, OnManySamplesItHasItsValues) {
    for (const bool marked : {false, true}) {
        const RoundDomain domain = marked ? with_marks(kTwo, {0.3, 2, 4}) : kTwo;
        const LaurentSpace space(domain);
        Chart chart;
        const std::vector<Complex> points = inside(domain, 0.005, 1e-3);
        chart.positions = in_domain(points).positions;
        chart.derivatives = Eigen::VectorXcd::Constant(chart.positions.size(), {0.5, 1});
        chart.excluded.assign(points.size(), 0);
        ASSERT_GT(points.size(), 90'000u);
        SampledSpace sampled(chart, domain.singularities(), 0.4);
        sampled.set(space);
        const Eigen::VectorXcd c = Eigen::VectorXd::LinSpaced(space.size(), -1, 2).cast<Complex>();
        const Eigen::VectorXcd exact = space.combination({chart.positions, chart.derivatives}, c);
        const Eigen::ArrayXd sizes = exact.cwiseAbs().array() + exact.cwiseAbs().mean();
        EXPECT_LT(((sampled.combination(c) - exact).cwiseAbs().array() / sizes).maxCoeff(), 2e-3);
    }
}

TEST(LaurentSpace, NothingIsLeftOnADiskWithThreeMarks) {
    for (const RoundDomain& domain : {kDisk, with_marks(kDisk, {0.1, 1.0, 3.0})}) {
        const LaurentSpace space(domain);
        EXPECT_EQ(space.size(), 0);
        EXPECT_EQ(space.evaluate(in_domain({0.1, 0.2})).size(), 0);
    }
}

TEST(LaurentSpace, SaysWhenTheDegreeDoesNotSuffice) {
    LaurentOptions options;
    options.first_degree = options.largest_degree = 6;
    try {
        LaurentSpace({{}, {{-0.251, 0.25}, {0.251, 0.25}}, {}, {}}, options);
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.cause(), Cause::not_solved);
        EXPECT_NE(std::string(error.what()).find("3 functions"), std::string::npos) << error.what();
    }
}

TEST(LaurentSpace, RefusesImpossibleDomains) {
    const auto refused = [](const RoundDomain& domain, std::vector<int> indices) {
        try {
            domain.validate();
            ADD_FAILURE() << "accepted";
        } catch (const Error& error) {
            EXPECT_EQ(error.cause(), Cause::bad_option);
            EXPECT_EQ(error.indices(), indices) << error.what();
        }
    };
    refused({{}, {{0.5, 0.2}, {0.7, 0.2}}, {}, {}}, {0, 1});
    refused({{}, {{0.9, 0.2}}, {}, {}}, {0});
    refused({{}, {{0.5, -0.2}}, {}, {}}, {1});
    refused({{}, {}, {0.99}, {}}, {0});
    refused({{}, {}, {1.0, Complex(0, 1), 1.0}, {}}, {0, 2});
    refused({{}, {{0.5, 0.2}}, {}, {0.6}}, {0});
    refused({{}, {}, {}, {0.6, 0.6}}, {0, 1});
    refused({{}, {{Complex(NAN, 0), 0.2}}, {}, {}}, {1});
    EXPECT_THROW(LaurentSpace({}, {.tolerance = 0}), Error);
    EXPECT_THROW(LaurentSpace({}, {.first_degree = 3}), Error);
    EXPECT_THROW(LaurentSpace({}, {.first_degree = 30, .largest_degree = 20}), Error);
}

TEST(DimensionOfDifferentials, IsThatOfTheDoubledDomain) {
    EXPECT_EQ(dimension_of_differentials(0, 0), 0);
    EXPECT_EQ(dimension_of_differentials(0, 3), 0);
    EXPECT_EQ(dimension_of_differentials(0, 4), 1);
    EXPECT_EQ(dimension_of_differentials(0, 1, 1), 0);
    EXPECT_EQ(dimension_of_differentials(0, 0, 2), 1);
    EXPECT_EQ(dimension_of_differentials(1, 0), 1);
    EXPECT_EQ(dimension_of_differentials(1, 1), 1);
    EXPECT_EQ(dimension_of_differentials(1, 2), 2);
    EXPECT_EQ(dimension_of_differentials(1, 0, 1), 2);
    EXPECT_EQ(dimension_of_differentials(2, 0), 3);
    EXPECT_EQ(dimension_of_differentials(9, 5, 1), 31);
}

}  // namespace
}  // namespace beltrami
