#include <beltrami/linear/element_system.h>

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <random>
#include <stdexcept>
#include <utility>
#include <vector>

#include <beltrami/base/error.h>

namespace beltrami {
namespace {

const std::vector<int> kOffsets{0, 3, 6, 8, 12}, kNodes{0, 1, 2, 2, -1, 1, 3, 0, 4, 2, 3, 0};
constexpr int kNodeCount = 5;

/// Random positive definite matrices of the elements above, and their sum in a dense matrix.
struct Elements {
    std::vector<std::vector<double>> lower;
    Eigen::MatrixXd sum;

    Elements(int block, unsigned seed) : sum(Eigen::MatrixXd::Zero(block * kNodeCount, block * kNodeCount)) {
        std::mt19937 random(seed);
        std::normal_distribution<double> normal;
        for (std::size_t e = 0; e + 1 < kOffsets.size(); ++e) {
            const int nodes = kOffsets[e + 1] - kOffsets[e], n = block * nodes;
            const Eigen::MatrixXd root = Eigen::MatrixXd::NullaryExpr(n, n, [&] { return normal(random); });
            const Eigen::MatrixXd matrix = root * root.transpose();
            std::vector<double>& values = lower.emplace_back();
            for (int i = 0; i < n; ++i)
                for (int j = 0; j <= i; ++j) values.push_back(matrix(i, j));
            const auto place = [&](int i) {
                const int node = kNodes[kOffsets[e] + i / block];
                return node < 0 ? -1 : block * node + i % block;
            };
            for (int i = 0; i < n; ++i)
                for (int j = 0; j < n; ++j)
                    if (place(i) >= 0 && place(j) >= 0) sum(place(i), place(j)) += matrix(i, j);
        }
    }
};

ElementSystem system_of(int block, int factorizations = 5) {
    return {kOffsets, kNodes, kNodeCount, factorizations, block};
}

void add(const Elements& elements, ElementSystem& system) {
    for (int e = 0; e < system.element_count(); ++e) system.add(e, elements.lower[e]);
}

void expect_matrix(ElementSystem& system, const Eigen::MatrixXd& expected) {
    system.factorize();
    const Eigen::MatrixXd inverse = system.solve(Eigen::MatrixXd::Identity(expected.rows(), expected.cols()));
    EXPECT_LT((inverse * expected - Eigen::MatrixXd::Identity(expected.rows(), expected.cols())).norm(), 1e-10);
    EXPECT_LT(system.last_residual(), 1e-13);
}

class Blocks : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(OneAndTwo, Blocks, testing::Values(1, 2));

TEST_P(Blocks, AddsElementsWhereTheyBelongAsOftenAsTheyChange) {
    ElementSystem system = system_of(GetParam());
    EXPECT_EQ(system.element_count(), 4);
    EXPECT_EQ(system.unknown_count(), GetParam() * kNodeCount);
    EXPECT_EQ(system.nodes(1)[1], -1);
    for (const unsigned seed : {1u, 2u}) {
        const Elements elements(GetParam(), seed);
        system.clear();
        add(elements, system);
        expect_matrix(system, elements.sum);
    }
    EXPECT_EQ(system.factorization_count(), 2);
}

TEST_P(Blocks, ChangesItsDiagonal) {
    ElementSystem system = system_of(GetParam());
    const Elements elements(GetParam(), 3);
    add(elements, system);
    Eigen::MatrixXd expected = elements.sum;
    for (int u = 0; u < system.unknown_count(); ++u) {
        EXPECT_NEAR(system.diagonal(u), expected(u, u), 1e-12 * expected(u, u));
        system.add_to_diagonal(u, 0.25 * u);
        expected(u, u) += 0.25 * u;
    }
    system.scale_diagonal(1.5);
    expected.diagonal() *= 1.5;
    expect_matrix(system, expected);
}

TEST_P(Blocks, CombinesMatricesThatStandAside) {
    ElementSystem system = system_of(GetParam());
    const Elements first(GetParam(), 4), second(GetParam(), 5);
    ElementSystem::Values a(system), b(system);
    for (int e = 0; e < system.element_count(); ++e) {
        system.add(e, first.lower[e], a);
        system.add(e, second.lower[e], b);
    }
    system.set(a, 0.3, b);
    expect_matrix(system, first.sum + 0.3 * second.sum);
    system.set(b);
    expect_matrix(system, second.sum);
    b.clear();
    system.set(a, 7, b);
    expect_matrix(system, first.sum);
}

TEST_P(Blocks, SolvesNearbyMatricesWithAnOldFactor) {
    ElementSystem system = system_of(GetParam());
    const Elements elements(GetParam(), 6);
    add(elements, system);
    const Eigen::MatrixXd rhs = Eigen::MatrixXd::Ones(system.unknown_count(), 2);
    Eigen::MatrixXd x = rhs, expected = elements.sum;
    EXPECT_FALSE(system.solve_near(rhs, x, 1e-12, 20)) << "without a factor";
    system.factorize();
    system.add_to_diagonal(0, 1e-3 * expected(0, 0));
    expected(0, 0) *= 1.001;
    ASSERT_TRUE(system.solve_near(rhs, x, 1e-12, 20));
    EXPECT_LT((expected * x - rhs).norm(), 1e-9);
    EXPECT_EQ(system.factorization_count(), 1);
}

TEST(ElementSystem, SolvesOnlyWhatWasFactorised) {
    ElementSystem system = system_of(1);
    const Eigen::MatrixXd rhs = Eigen::MatrixXd::Ones(kNodeCount, 1);
    const Elements elements(1, 7);
    add(elements, system);
    EXPECT_THROW(system.solve(rhs), std::logic_error);
    system.factorize();
    EXPECT_NO_THROW(system.solve(rhs));
    system.add(0, elements.lower[0]);
    EXPECT_THROW(system.solve(rhs), std::logic_error);
    EXPECT_THROW(ElementSystem(kOffsets, kNodes, kNodeCount, 1, 3), std::logic_error);
}

TEST(ElementSystem, NamesUnknownsOfNoElement) {
    // Node 4 is in no element.
    ElementSystem system({0, 2, 4, 6}, {0, 1, 1, 2, 2, 3}, 5, 1);
    for (int e = 0; e < 3; ++e) system.add(e, std::vector<double>{2, -1, 2});
    try {
        system.factorize();
        FAIL() << "a singular matrix was factorised";
    } catch (const Error& error) {
        EXPECT_EQ(error.cause(), Cause::not_solved);
        EXPECT_EQ(error.indices(), std::vector<int>{4});
    }
    system.add_to_diagonal(4, 2);
    system.factorize();
    EXPECT_NEAR(system.solve(Eigen::MatrixXd::Ones(5, 1))(4, 0), 0.5, 1e-15);
}

TEST(ElementSystem, CanBeMovedAndBeEmpty) {
    ElementSystem first = system_of(2);
    const Elements elements(2, 8);
    add(elements, first);
    ElementSystem second = std::move(first);
    expect_matrix(second, elements.sum);
    ElementSystem empty({0, 2}, {-1, -1}, 0, 1);
    empty.add(0, std::vector<double>{1, 2, 3});
    empty.factorize();
    EXPECT_EQ(empty.solve(Eigen::MatrixXd(0, 2)).cols(), 2);
    EXPECT_EQ(empty.factorization_count(), 0);
}

}  // namespace
}  // namespace beltrami
