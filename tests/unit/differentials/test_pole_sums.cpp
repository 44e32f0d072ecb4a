#include <gtest/gtest.h>

#include <cmath>

#include <beltrami/base/parallel.h>
#include <beltrami/base/random.h>
#include <beltrami/differentials/pole_sums.h>

namespace beltrami {
namespace {

/// Polynomials, powers at a hole, lone poles, and what interrupts a run of powers.
const std::vector<Pole> kPoles{
    {0.0, 1.0, 0},         {0.0, 1.0, -1},       {0.0, 1.0, -2},         {{2, 1}, 0.5, 1},
    {{2, 1}, 0.5, 2},      {{2, 1}, 0.5, 3},     {{-1.2, 0.3}, 0.01, 1}, {{0, -1.5}, 0.2, 1},
    {0.0, 1.0, -3},        {0.0, 1.0, -4},       {{2, 1}, 0.5, 5},       {{2, 1}, 0.5, 6},
    {{0.1, 1.7}, 3.0, -1}, {{0.1, 1.7}, 3.0, 1}, {{1.1, 0}, 1e-5, 1},    {{1.1, 0}, 2e-5, 2}};

Complex value(const Pole& pole, Complex z) {
    return pole.power > 0 ? std::pow(pole.scale / (z - pole.centre), pole.power)
                          : std::pow((z - pole.centre) / pole.scale, -pole.power);
}

Eigen::VectorXcd random_vector(Random& random, int size) {
    Eigen::VectorXcd result(size);
    for (Complex& z : result) z = {random.uniform(-1, 1), random.uniform(-1, 1)};
    return result;
}

/// Numbers of points around the sizes of a block and of a chunk.
class PoleSums : public testing::TestWithParam<int> {
  protected:
    Random random{3};
    Eigen::VectorXcd z = random_vector(random, GetParam());
};
INSTANTIATE_TEST_SUITE_P(Points, PoleSums, testing::Values(1, 7, 255, 256, 257, 1024, 1025, 3000));

TEST_P(PoleSums, AreThoseOfTheFormula) {
    const auto count = static_cast<int>(kPoles.size());
    const Eigen::VectorXcd c = random_vector(random, count);
    Eigen::MatrixXcd weights(z.size(), 2);
    for (int column = 0; column < 2; ++column) weights.col(column) = random_vector(random, GetParam());
    const Eigen::MatrixXcd values = pole_values(kPoles, z);
    ASSERT_EQ(values.rows(), z.size());
    ASSERT_EQ(values.cols(), count);
    for (int j = 0; j < count; ++j)
        for (Eigen::Index i = 0; i < z.size(); ++i) {
            const Complex exact = value(kPoles[j], z[i]);
            EXPECT_LT(std::abs(values(i, j) - exact), 1e-13 * std::abs(exact) + 1e-300) << j << ' ' << i;
        }
    const Eigen::VectorXcd combination = pole_combination(kPoles, z, c);
    for (Eigen::Index i = 0; i < z.size(); ++i)
        EXPECT_LT(std::abs(combination[i] - (values.row(i) * c)(0)), 1e-13 * values.row(i).norm() * c.norm());
    const Eigen::MatrixXcd pairing = pole_pairing(kPoles, z, weights), exact = values.transpose() * weights;
    ASSERT_EQ(pairing.rows(), count);
    ASSERT_EQ(pairing.cols(), 2);
    for (int j = 0; j < count; ++j)
        for (int column = 0; column < 2; ++column)
            EXPECT_LT(std::abs(pairing(j, column) - exact(j, column)),
                      1e-13 * values.col(j).norm() * weights.col(column).norm());
}

TEST_P(PoleSums, DoNotDependOnTheNumberOfThreads) {
    const Eigen::VectorXcd c = random_vector(random, static_cast<int>(kPoles.size()));
    const Eigen::MatrixXcd weights = random_vector(random, GetParam());
    const int threads = thread_count();
    set_thread_count(1);
    const Eigen::VectorXcd combination = pole_combination(kPoles, z, c);
    const Eigen::MatrixXcd pairing = pole_pairing(kPoles, z, weights);
    set_thread_count(3);
    EXPECT_EQ(pole_combination(kPoles, z, c), combination);
    EXPECT_EQ(pole_pairing(kPoles, z, weights), pairing);
    set_thread_count(threads);
}

}  // namespace
}  // namespace beltrami
