#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include <beltrami/plane/increasing.h>

namespace beltrami {
namespace {

TEST(RaiseToNeighbours, LeavesWhatIsLikeItsNeighboursHoweverSmall) {
    std::vector<double> steps;
    for (int i = 0; i < 40; ++i) steps.push_back(std::pow(10.0, -0.05 * std::min(i, 40 - i) * 5));
    const std::vector<double> given = steps;
    raise_to_neighbours(steps, 0.1);
    EXPECT_EQ(steps, given);
}

TEST(RaiseToNeighbours, GivesAPartOfTheMeanAround) {
    std::vector<double> steps(20, 1.0);
    steps[7] = 0;
    steps[0] = 1e-9;
    raise_to_neighbours(steps, 0.2);
    EXPECT_NEAR(steps[7], 0.2 * 8 / 9, 1e-15);
    EXPECT_NEAR(steps[0], 0.2 * 8 / 9, 1e-9);
    EXPECT_EQ(steps[1], 1);
}

TEST(RaiseToNeighbours, LooksFurtherWhereAllAroundIsNothing) {
    std::vector<double> steps(40, 0.0);
    steps[0] = 1;
    raise_to_neighbours(steps, 0.1);
    EXPECT_EQ(steps[0], 1);
    for (int i = 1; i < 40; ++i) EXPECT_GT(steps[i], 0) << i;
    EXPECT_GT(steps[3], steps[12]);
}

TEST(MakeIncreasing, PoolsWhatRunsBackwards) {
    std::vector<double> values{0, 1, 3, 2.5, 4, 5}, arc(7);
    std::iota(arc.begin(), arc.end(), 0.0);
    make_increasing(values, 6, arc);
    for (std::size_t i = 0; i + 1 < values.size(); ++i) EXPECT_LT(values[i], values[i + 1]);
    EXPECT_EQ(values[1], 1);
    EXPECT_EQ(values[5], 5);
}

}  // namespace
}  // namespace beltrami
