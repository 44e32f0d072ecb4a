#include <gtest/gtest.h>

#include <cmath>

#include <beltrami/differentials/argument_principle.h>

namespace beltrami {
namespace {

/// The square [0, 1]² in 2 n² triangles.
PlaneTriangles square(int n) {
    PlaneTriangles result;
    result.points.resize((n + 1) * (n + 1));
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) result.points[j * (n + 1) + i] = Complex(i, j) / static_cast<double>(n);
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const int a = j * (n + 1) + i, b = a + 1, c = b + n + 1, d = a + n + 1;
            result.triangles.push_back({a, b, c});
            result.triangles.push_back({a, c, d});
        }
    return result;
}

PlaneFunction each(Complex (*f)(Complex)) {
    return [f](const Eigen::VectorXcd& z) { return Eigen::VectorXcd(z.unaryExpr([f](Complex p) { return f(p); })); };
}

TEST(ArgumentPrinciple, FindsZerosInsideOnEdgesAndAtPoints) {
    const PlaneTriangles region = square(8);
    const auto f = [](Complex z) {
        return (z - Complex(0.31, 0.47)) * (z - Complex(0.5, 0.3)) * std::pow(z - Complex(0.25, 0.75), 3) *
               (z - Complex(1.2, 0.5));
    };
    const std::vector<PlaneZero> found = zeros_and_poles_in(region, each(f), {});
    ASSERT_EQ(found.size(), 3u);
    const std::pair<Complex, int> expected[] = {{{0.31, 0.47}, 1}, {{0.5, 0.3}, 1}, {{0.25, 0.75}, 3}};
    for (const auto& [at, order] : expected) {
        int seen = 0;
        for (const PlaneZero& zero : found)
            if (std::abs(zero.at - at) < (order == 1 ? 1e-12 : 1e-4)) {
                EXPECT_EQ(zero.order, order);
                ++seen;
            }
        EXPECT_EQ(seen, 1) << at;
    }
}

TEST(ArgumentPrinciple, TellsZerosInOneTriangleApartAsFarAsItSays) {
    // An edge is 1/4: a fiftieth of it is .005.
    const PlaneTriangles region = square(4);
    const auto apart = [](Complex z) { return (z - Complex(0.60, 0.55)) * (z - Complex(0.60, 0.558)); };
    EXPECT_EQ(zeros_and_poles_in(region, each(apart), {}).size(), 2u);
    const auto close = [](Complex z) { return (z - Complex(0.60, 0.55)) * (z - Complex(0.60, 0.551)); };
    const std::vector<PlaneZero> found = zeros_and_poles_in(region, each(close), {});
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].order, 2);
}

TEST(ArgumentPrinciple, FindsPolesWhereTheyMayBe) {
    const PlaneTriangles region = square(4);
    const auto f = [](Complex z) { return (z - Complex(0.55, 0.5)) / (z - 0.5 - Complex(0, 0.5)); };
    const std::vector<PlaneZero> found = zeros_and_poles_in(region, each(f), {6, 12});  // .25 + .25 i, .5 + .5 i
    ASSERT_EQ(found.size(), 2u);
    int sum = 0;
    for (const PlaneZero& zero : found) {
        sum += zero.order;
        EXPECT_NEAR(std::abs(zero.at - Complex(zero.order < 0 ? 0.5 : 0.55, 0.5)), 0, 1e-12);
    }
    EXPECT_EQ(sum, 0);
}

TEST(ArgumentPrinciple, OfACircle) {
    EXPECT_EQ(turns_on_circle(each([](Complex z) { return z * z * (z - 3.0); }), 0, 1), 2);
    EXPECT_EQ(turns_on_circle(each([](Complex z) { return (z - 0.99) / (z * z); }), 0, 1), -1);
    EXPECT_FALSE(turns_on_circle(each([](Complex z) { return z - 1.0; }), 0, 1));
    EXPECT_FALSE(turns_on_circle(each([](Complex z) { return std::sqrt(z); }), 0, 1));
}

}  // namespace
}  // namespace beltrami
