#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>

#include <beltrami/differentials/rational_space.h>

namespace beltrami {
namespace {

/// Two holes, a corner on the unit circle and a pin.
Singularities all_kinds() {
    Singularities result;
    result.holes = {{{0.35, 0.1}, 0.2, 10}, {{-0.4, -0.35}, 0.15, 6}};
    result.corners = {{{0, 1}, {0, 1}, 0.5, 0.01}};
    result.pins = {{-0.3, 0.45}};
    return result;
}

/// Midpoints of a grid over the disk without the holes.
RationalSpace::Quadrature grid(const Singularities& singularities, double step = 0.025) {
    std::vector<Complex> points;
    for (double y = -1 + step / 2; y < 1; y += step)
        for (double x = -1 + step / 2; x < 1; x += step) {
            const Complex z(x, y);
            bool inside = std::abs(z) < 1;
            for (const auto& hole : singularities.holes) inside = inside && std::abs(z - hole.centre) > hole.radius;
            if (inside) points.push_back(z);
        }
    const auto n = static_cast<Eigen::Index>(points.size());
    return {Eigen::Map<const Eigen::VectorXcd>(points.data(), n), Eigen::VectorXd::Constant(n, step * step)};
}

ChartPoints in_domain(const Eigen::VectorXcd& points) {
    return {points, Eigen::VectorXcd::Ones(points.size())};
}
ChartPoints one_point(Complex z) {
    return in_domain(Eigen::VectorXcd::Constant(1, z));
}

/// Largest value of a basis function at a place.
double largest(const DifferentialSpace& space, Complex z) {
    return space.evaluate(one_point(z)).cwiseAbs().maxCoeff();
}

/// Every space from the first to the last.
std::vector<std::unique_ptr<DifferentialSpace>> tower(const Singularities& singularities, int largest_degree) {
    std::vector<std::unique_ptr<DifferentialSpace>> spaces;
    spaces.push_back(RationalSpace::starting_space(singularities, grid(singularities), largest_degree));
    while (std::unique_ptr<DifferentialSpace> larger = spaces.back()->refined()) spaces.push_back(std::move(larger));
    return spaces;
}

/// Power with which a function of the space grows towards a place: log₂ of the ratio at distances 2ε and ε.
double order_of_pole(const DifferentialSpace& space, Complex at, double distance) {
    const Complex direction = std::polar(1.0, 0.3);
    return std::log2(largest(space, at + distance * direction) / largest(space, at + 2 * distance * direction));
}

TEST(RationalSpace, IsOrthonormalOnItsQuadratureAtEverySize) {
    const Singularities singularities = all_kinds();
    const RationalSpace::Quadrature quadrature = grid(singularities);
    for (const auto& space : tower(singularities, 20)) {
        const Eigen::MatrixXcd values =
            quadrature.weights.cwiseSqrt().cast<Complex>().asDiagonal() * space->evaluate(in_domain(quadrature.points));
        const auto n = values.cols();
        ASSERT_EQ(n, space->size());
        EXPECT_LT((values.adjoint() * values - Eigen::MatrixXcd::Identity(n, n)).cwiseAbs().maxCoeff(), 1e-10);
    }
}

TEST(RationalSpace, GrowsByAddingFunctions) {
    const auto spaces = tower(all_kinds(), 20);
    const ChartPoints points = in_domain(0.1 * Eigen::VectorXcd::Random(50));
    ASSERT_GE(spaces.size(), 3u);
    for (std::size_t i = 1; i < spaces.size(); ++i) {
        const int before = spaces[i - 1]->size();
        EXPECT_GT(spaces[i]->size(), before);
        const Eigen::MatrixXcd old = spaces[i - 1]->evaluate(points);
        EXPECT_LT((spaces[i]->evaluate(points).leftCols(before) - old).cwiseAbs().maxCoeff(),
                  1e-10 * old.cwiseAbs().maxCoeff());
    }
    // Degrees 0 … 8, four powers at each hole, the pin; in the end degree 20, 10 and 6 powers, the corner's poles.
    EXPECT_EQ(spaces.front()->size(), 9 + 8 + 1);
    const int end = 21 + 16 + 1 + RationalSpace::corner_poles;
    EXPECT_LE(spaces.back()->size(), end);
    EXPECT_GE(spaces.back()->size(), end - 4);
    for (const auto& space : spaces) EXPECT_TRUE(space->complex_coefficients());
}

TEST(RationalSpace, ALargestDegreeBelowTheFirstOneIsKept) {
    const auto spaces = tower({}, 3);
    EXPECT_EQ(spaces.size(), 1u);
    EXPECT_EQ(spaces[0]->size(), 4);
}

TEST(RationalSpace, FunctionsThatDependOnOthersAreLeftOut) {
    Singularities twice = all_kinds();
    twice.pins.push_back(twice.pins[0]);
    const auto once = tower(all_kinds(), 12), doubled = tower(twice, 12);
    ASSERT_EQ(once.size(), doubled.size());
    for (std::size_t i = 0; i < once.size(); ++i) EXPECT_EQ(once[i]->size(), doubled[i]->size());
    // A pin so near the first that nothing new is left beside both.
    twice.pins[1] = twice.pins[0] + 1e-9;
    EXPECT_EQ(tower(twice, 12)[0]->size(), once[0]->size());
    twice.pins[1] = twice.pins[0] + 0.3;
    EXPECT_EQ(tower(twice, 12)[0]->size(), once[0]->size() + 1);
}

TEST(RationalSpace, PolesAreWhereTheyBelong) {
    const Singularities singularities = all_kinds();
    const auto spaces = tower(singularities, 20);
    const DifferentialSpace &first = *spaces.front(), &last = *spaces.back();
    // A simple pole at the pin, one of the largest power at each hole's centre.
    for (const auto& space : spaces) EXPECT_NEAR(order_of_pole(*space, singularities.pins[0], 1e-7), 1, 1e-3);
    for (const auto& hole : singularities.holes) {
        EXPECT_NEAR(order_of_pole(first, hole.centre, 1e-4), 4, 1e-2);
        EXPECT_NEAR(order_of_pole(last, hole.centre, 1e-4), hole.largest_power, 1e-2);
    }
    // Simple poles outside the corner at the distances of Gopal & Trefethen, no nearer than the finest.
    const auto& corner = singularities.corners[0];
    int resolved = 0;
    for (int j = 0; j < RationalSpace::corner_poles; ++j) {
        const double root = std::sqrt(RationalSpace::corner_poles);
        const double distance =
            corner.reach * std::exp(-4 * (root - std::sqrt(double(RationalSpace::corner_poles - j))));
        const Complex pole = corner.vertex + distance * corner.outward;
        if (distance < corner.finest) {
            EXPECT_NEAR(order_of_pole(last, pole, 1e-8), 0, 1e-3) << j;
            continue;
        }
        ++resolved;
        EXPECT_NEAR(order_of_pole(last, pole, 1e-8 * distance), 1, 1e-3) << j;
        EXPECT_NEAR(order_of_pole(first, pole, 1e-8 * distance), 0, 1e-3) << j;
    }
    EXPECT_GE(resolved, 3);
    EXPECT_LT(resolved, RationalSpace::corner_poles);
    // None elsewhere.
    for (const Complex z : {Complex(0.1, -0.2), Complex(-0.9, 0), Complex(0.6, 0.6)})
        EXPECT_NEAR(order_of_pole(last, z, 1e-6), 0, 1e-3);
}

TEST(RationalSpace, IsPreliminaryUntilCornersHaveTheirPoles) {
    const auto spaces = tower(all_kinds(), 20);
    EXPECT_TRUE(spaces[0]->preliminary());
    for (std::size_t i = 1; i < spaces.size(); ++i) EXPECT_FALSE(spaces[i]->preliminary());
    // Also where nothing but the poles is to be added.
    Singularities corner;
    corner.corners = all_kinds().corners;
    const auto small = tower(corner, 2);
    ASSERT_EQ(small.size(), 2u);
    EXPECT_TRUE(small[0]->preliminary());
    EXPECT_GT(small[1]->size(), small[0]->size());
    Singularities smooth = all_kinds();
    smooth.corners.clear();
    EXPECT_FALSE(tower(smooth, 10)[0]->preliminary());
}

TEST(RationalSpace, TheLargestSpaceIsTheOneThatGrowsToTheEnd) {
    const Singularities singularities = all_kinds();
    const RationalSpace::Quadrature quadrature = grid(singularities);
    std::unique_ptr<DifferentialSpace> grown = RationalSpace::starting_space(singularities, quadrature, 12);
    while (auto larger = grown->refined()) grown = std::move(larger);
    const std::unique_ptr<DifferentialSpace> whole = RationalSpace::largest_space(singularities, quadrature, 12);
    EXPECT_FALSE(whole->preliminary());
    EXPECT_EQ(whole->refined(), nullptr);
    ASSERT_EQ(whole->size(), grown->size());
    // Both bases are orthonormal: their products are those of one space exactly if they are a unitary matrix.
    const Eigen::MatrixXcd a = whole->evaluate(in_domain(quadrature.points)),
                           b = grown->evaluate(in_domain(quadrature.points));
    const Eigen::MatrixXcd products = a.adjoint() * quadrature.weights.asDiagonal() * b;
    const Eigen::MatrixXcd identity = Eigen::MatrixXcd::Identity(whole->size(), whole->size());
    EXPECT_LT((products.adjoint() * products - identity).norm(), 1e-7);
}

TEST(RationalSpace, CombinationIsTheProductWithTheBasis) {
    const auto spaces = tower(all_kinds(), 20);
    const DifferentialSpace& space = *spaces.back();
    ChartPoints points{0.1 * Eigen::VectorXcd::Random(3000), Eigen::VectorXcd::Random(3000)};
    const Eigen::VectorXcd c = Eigen::VectorXcd::Random(space.size());
    const Eigen::VectorXcd expected = space.evaluate(points) * c;
    EXPECT_LT((space.combination(points, c) - expected).cwiseAbs().maxCoeff(), 1e-10 * expected.cwiseAbs().maxCoeff());
    EXPECT_LT((space.generators(points) * space.of_generators(c) - expected).cwiseAbs().maxCoeff(),
              1e-10 * expected.cwiseAbs().maxCoeff());
    const Eigen::MatrixXcd weights = Eigen::MatrixXcd::Random(3000, 2);
    const Eigen::MatrixXcd paired = space.evaluate(points).transpose() * weights;
    EXPECT_LT((space.from_generators(space.generators(points).transpose() * weights) - paired).cwiseAbs().maxCoeff(),
              1e-9 * paired.cwiseAbs().maxCoeff());
}

TEST(RationalSpace, PulledBackValuesTransformAsQuadraticDifferentials) {
    const auto spaces = tower(all_kinds(), 12);
    const ChartPoints plain = in_domain(0.1 * Eigen::VectorXcd::Random(20));
    ChartPoints turned = plain;
    turned.derivatives *= std::polar(2.0, 0.6);
    const Eigen::MatrixXcd expected = std::polar(4.0, 1.2) * spaces.back()->evaluate(plain);
    EXPECT_LT((spaces.back()->evaluate(turned) - expected).cwiseAbs().maxCoeff(),
              1e-10 * expected.cwiseAbs().maxCoeff());
}

// A function with a branch point at the corner is approximated root-exponentially by poles, poorly by polynomials.
TEST(RationalSpace, PolesApproximateABranchPoint) {
    Singularities corner;
    corner.corners = {{{0, 1}, {0, 1}, 1.0, 1e-3}};
    const RationalSpace::Quadrature quadrature = grid(corner);
    const Complex i(0, 1);
    const Eigen::VectorXcd target = quadrature.points.unaryExpr([&](Complex z) { return std::pow(1.0 + i * z, 0.5); });
    const auto remainder = [&](const DifferentialSpace& space) {
        const Eigen::MatrixXcd values = space.evaluate(in_domain(quadrature.points));
        const Eigen::VectorXcd c = values.adjoint() * quadrature.weights.cast<Complex>().asDiagonal() * target;
        return std::sqrt(quadrature.weights.dot((target - values * c).cwiseAbs2()));
    };
    const auto with = tower(corner, 8), without = tower({}, 16);
    EXPECT_LE(with.back()->size(), without.back()->size());
    EXPECT_LT(remainder(*with.back()), 0.02 * remainder(*without.back()));
}

}  // namespace
}  // namespace beltrami
