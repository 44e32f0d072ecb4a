#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <random>
#include <utility>

#include <beltrami/base/error.h>
#include <beltrami/base/parallel.h>
#include <beltrami/linear/anderson.h>
#include <beltrami/linear/dense.h>
#include <beltrami/linear/symmetric_solver.h>

namespace beltrami {
namespace {

using detail::SymmetricSolver;

/// The Laplacian of an n×n grid graph plus `shift` on the diagonal, as lower triangle.
SymmetricSolver::Matrix grid_laplacian(int n, double shift) {
    std::vector<Eigen::Triplet<double>> entries;
    const auto link = [&](int a, int b) {
        entries.emplace_back(a, a, 1.0);
        entries.emplace_back(b, b, 1.0);
        entries.emplace_back(std::max(a, b), std::min(a, b), -1.0);
    };
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            entries.emplace_back(i * n + j, i * n + j, shift);
            if (i + 1 < n) link(i * n + j, (i + 1) * n + j);
            if (j + 1 < n) link(i * n + j, i * n + j + 1);
        }
    SymmetricSolver::Matrix matrix(n * n, n * n);
    matrix.setFromTriplets(entries.begin(), entries.end());
    return matrix;
}

Eigen::MatrixXd dense(const SymmetricSolver::Matrix& lower) {
    return Eigen::MatrixXd(lower).selfadjointView<Eigen::Lower>();
}

class Orderings : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(FewAndMany, Orderings, testing::Values(1, 100));

TEST_P(Orderings, SolvesAndKeepsTheAnalysis) {
    SymmetricSolver solver(grid_laplacian(12, 0.1), GetParam());
    const Eigen::MatrixXd rhs = Eigen::MatrixXd::Random(144, 3);
    for (const double factor : {1.0, 7.0}) {
        solver.matrix().coeffs() *= factor;
        solver.factorize();
        const Eigen::MatrixXd exact = dense(std::as_const(solver).matrix()).ldlt().solve(rhs);
        EXPECT_LT((solver.solve(rhs) - exact).norm(), 1e-11 * exact.norm());
        EXPECT_LT(solver.last_residual(), 1e-13);
    }
    EXPECT_EQ(solver.factorization_count(), 2);
}

TEST_P(Orderings, OrdersBlocksOfUnknownsAsOne) {
    // Two unknowns in place of every one of the grid.
    const SymmetricSolver::Matrix one = grid_laplacian(12, 0.1);
    std::vector<Eigen::Triplet<double>> entries;
    for (int c = 0; c < one.cols(); ++c)
        for (SymmetricSolver::Matrix::InnerIterator it(one, c); it; ++it)
            for (int i = 0; i < 2; ++i)
                for (int j = 0; j < 2; ++j) {
                    const int row = 2 * static_cast<int>(it.row()) + i, column = 2 * c + j;
                    if (row >= column) entries.emplace_back(row, column, i == j ? it.value() : 0.1 * it.value());
                }
    SymmetricSolver::Matrix matrix(288, 288);
    matrix.setFromTriplets(entries.begin(), entries.end());
    SymmetricSolver solver(matrix, GetParam(), 2);
    solver.factorize();
    const Eigen::MatrixXd rhs = Eigen::MatrixXd::Random(288, 3), exact = dense(matrix).ldlt().solve(rhs);
    EXPECT_LT((solver.solve(rhs) - exact).norm(), 1e-11 * exact.norm());
}

TEST(SymmetricSolver, NamesWhatNothingConstrains) {
    // Two grids; only the first is held.
    const auto one = grid_laplacian(4, 0.0);
    std::vector<Eigen::Triplet<double>> entries{{0, 0, 1.0}};
    for (int c = 0; c < 16; ++c)
        for (SymmetricSolver::Matrix::InnerIterator it(one, c); it; ++it) {
            entries.emplace_back(it.row(), c, it.value());
            entries.emplace_back(16 + it.row(), 16 + c, it.value());
        }
    SymmetricSolver::Matrix matrix(32, 32);
    matrix.setFromTriplets(entries.begin(), entries.end());
    SymmetricSolver solver(matrix, 1);
    try {
        solver.factorize();
        FAIL() << "a singular matrix was factorised";
    } catch (const Error& error) {
        EXPECT_EQ(error.cause(), Cause::not_solved);
        ASSERT_EQ(error.indices().size(), 16u);
        for (const int row : error.indices()) EXPECT_GE(row, 16);
    }
}

TEST(SymmetricSolver, RefusesIndefiniteAndNotFinite) {
    SymmetricSolver indefinite(grid_laplacian(5, -1.0), 1);
    EXPECT_THROW(indefinite.factorize(), Error);
    SymmetricSolver nan(grid_laplacian(5, 1.0), 1);
    nan.matrix().coeffs()[3] = std::nan("");
    EXPECT_THROW(nan.factorize(), Error);
}

TEST(SymmetricSolver, EmptySystem) {
    SymmetricSolver solver(SymmetricSolver::Matrix(0, 0), 1);
    solver.factorize();
    EXPECT_EQ(solver.solve(Eigen::MatrixXd(0, 2)).cols(), 2);
}

TEST(SymmetricSolver, SolvesNearbyMatricesWithAnOldFactor) {
    SymmetricSolver solver(grid_laplacian(20, 0.05), 3);
    const Eigen::MatrixXd rhs = Eigen::MatrixXd::Random(400, 2);
    solver.factorize();
    Eigen::MatrixXd x = solver.solve(rhs);
    std::mt19937 random(1);
    for (Eigen::Index i = 0; i < 400; ++i)
        solver.matrix().coeffRef(i, i) += 1e-3 * static_cast<double>(random()) / random.max();
    ASSERT_TRUE(solver.solve_near(rhs, x, 1e-12, 12));
    const Eigen::MatrixXd exact = dense(std::as_const(solver).matrix()).ldlt().solve(rhs);
    EXPECT_LT((x - exact).norm(), 1e-10 * exact.norm());
    EXPECT_EQ(solver.factorization_count(), 1);

    // Far away it gives up within the steps allowed.
    for (Eigen::Index i = 0; i < 400; ++i) solver.matrix().coeffRef(i, i) += 100.0 * static_cast<double>(i % 7);
    EXPECT_FALSE(solver.solve_near(rhs, x, 1e-12, 4));
}

TEST(SymmetricSolver, NearbySolutionsOfALargeSystemAreExactInAnyUnitAndWithAnyThreads) {
    // Large enough for a supernodal factor with subtrees; the tiniest unit does not fit into single precision.
    const int side = 110, n = side * side, threads = thread_count();
    for (const double unit : {1.0, 1e25, 1e-120}) {
        SymmetricSolver solver(grid_laplacian(side, 0.2), 2);
        solver.matrix().coeffs() *= unit;
        solver.factorize();
        for (Eigen::Index i = 0; i < n; ++i) solver.matrix().coeffRef(i, i) *= 1 + 0.05 * std::sin(0.1 * i);
        for (const int columns : {1, 2, 3}) {
            Eigen::MatrixXd rhs(n, columns);
            for (int j = 0; j < columns; ++j)
                for (int i = 0; i < n; ++i) rhs(i, j) = unit * std::pow(10.0, -30 * j) * std::cos(0.01 * (j + 1) * i);
            std::vector<Eigen::MatrixXd> found;
            for (const int count : {1, 4}) {
                set_thread_count(count);
                Eigen::MatrixXd x = rhs / unit;
                ASSERT_TRUE(solver.solve_near(rhs, x, 1e-12, 20)) << unit << " " << columns;
                found.push_back(x);
            }
            set_thread_count(threads);
            EXPECT_EQ(found[0], found[1]);
            const Eigen::MatrixXd& x = found[0];
            const Eigen::MatrixXd residual = std::as_const(solver).matrix().selfadjointView<Eigen::Lower>() * x - rhs;
            for (int j = 0; j < columns; ++j)
                EXPECT_LT(residual.col(j).cwiseAbs().maxCoeff(), 1e-10 * rhs.col(j).cwiseAbs().maxCoeff());
        }
        EXPECT_EQ(solver.factorization_count(), 1);
    }
}

TEST(Dense, GramMatrix) {
    const Eigen::MatrixXd A = Eigen::MatrixXd::Random(37, 11);
    const Eigen::MatrixXd expected = (A.transpose() * A).triangularView<Eigen::Lower>();
    EXPECT_LT((gram_lower(A) - expected).norm(), 1e-13);
    EXPECT_EQ(gram_lower(Eigen::MatrixXd(0, 3)), Eigen::MatrixXd::Zero(3, 3));
}

TEST(AndersonAcceleration, SolvesLinearFixedPointsInFewSteps) {
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(4, 4);
    A.diagonal() << 0.9, -0.8, 0.7, 0.5;
    A(0, 1) = 0.3;
    const Eigen::VectorXd b = Eigen::VectorXd::Ones(4);
    const Eigen::VectorXd fixed = (Eigen::MatrixXd::Identity(4, 4) - A).fullPivLu().solve(b);
    AndersonAcceleration anderson(5);
    Eigen::VectorXd x = Eigen::VectorXd::Zero(4), plain = x;
    for (int step = 0; step < 7; ++step) {
        x = anderson.next(x, A * x + b);
        plain = A * plain + b;
    }
    EXPECT_LT((x - fixed).norm(), 1e-9);
    EXPECT_GT((plain - fixed).norm(), 1e-1);
}

}  // namespace
}  // namespace beltrami
