#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <beltrami/base/error.h>
#include <beltrami/plane/polygon.h>

namespace beltrami {
namespace {

TEST(Polygon, SignedArea) {
    EXPECT_EQ(signed_area({0, 2, {2, 1}, {0, 1}}), 2.0);
    EXPECT_EQ(signed_area({{0, 1}, {2, 1}, 2, 0}), -2.0);
    EXPECT_EQ(signed_area({0, 2, {1, 0.5}, {0, 2}}), 1.5);  // a reflex corner
    EXPECT_EQ(signed_area({0, {1, 1}}), 0.0);
    EXPECT_EQ(signed_area(std::vector<Complex>{}), 0.0);
    EXPECT_EQ(signed_area(1, {1, 4}, -1), 4.0);
    EXPECT_EQ(signed_area(1, -1, {1, 4}), -4.0);
}

TEST(Polygon, AreaFarFromTheOrigin) {
    std::vector<Complex> square{0, 1, {1, 1}, {0, 1}};
    for (Complex& z : square) z += Complex(1e9, -3e9);
    EXPECT_EQ(signed_area(square), 1.0);
    EXPECT_EQ(signed_area(square[0], square[1], square[2]), 0.5);
}

TEST(Polygon, SimpleOnesPass) {
    EXPECT_NO_THROW(require_simple_polygon({0, 1, {0, 1}}));
    EXPECT_NO_THROW(require_simple_polygon({0, 1, 2, {1, 1}})) << "a straight corner";
    std::vector<Complex> star;
    for (int i = 0; i < 40; ++i) star.push_back(std::polar(i % 2 ? 1.0 : 0.2, i * std::numbers::pi / 20));
    EXPECT_NO_THROW(require_simple_polygon(star));
}

TEST(Polygon, OthersAreRefusedByName) {
    const auto named = [](const std::vector<Complex>& polygon) {
        try {
            require_simple_polygon(polygon);
        } catch (const Error& error) {
            EXPECT_EQ(error.cause(), Cause::bad_boundary);
            return error.indices();
        }
        ADD_FAILURE() << "nothing was thrown";
        return std::vector<int>{};
    };
    EXPECT_EQ(named({0, 1}), std::vector<int>{});
    EXPECT_EQ(named({0, {0, 1}, 1}), std::vector<int>{}) << "clockwise";
    EXPECT_EQ(named({0, 1, 1, {0, 1}}), (std::vector{1, 2}));
    EXPECT_EQ(named({0, 1, {0, 1}, 0}), (std::vector{3, 0}));
    EXPECT_EQ(named({0, 3, {3, 3}, {1, -1}}), (std::vector{0, 2}));
    EXPECT_EQ(named({0, 4, 3, {0, 4}}).size(), 2u) << "straight back";
}

}  // namespace
}  // namespace beltrami
