#include <gtest/gtest.h>

#include <random>

#include <beltrami/base/error.h>
#include <beltrami/linear/element_system.h>

namespace beltrami {
namespace {

/// A grid of nodes with one or two unknowns each, large enough for supernodes, whose elements are its squares.
struct Grid {
    explicit Grid(int of_side, int of_node = 2) : side(of_side), unknowns(of_node) {
        for (int y = 0; y + 1 < side; ++y)
            for (int x = 0; x + 1 < side; ++x) {
                for (const int node : {y * side + x, y * side + x + 1, (y + 1) * side + x + 1, (y + 1) * side + x})
                    nodes.push_back(node % 7 == 3 ? -1 : node);  // some are eliminated
                offsets.push_back(static_cast<int>(nodes.size()));
            }
    }
    ElementSystem system() const { return {offsets, nodes, side * side, 3, unknowns}; }
    /// Adds random positive definite elements.
    /// @param whole the same matrix, dense
    void fill(ElementSystem& system, unsigned seed, Eigen::MatrixXd& whole) const {
        const int size = unknowns * side * side;
        whole = Eigen::MatrixXd::Zero(size, size);
        fill(system, seed, [&](int i, int j, double value) { whole(i, j) += value; });
    }
    /// @param tell (row, column, value) of all that is added
    template <class Tell>
    void fill(ElementSystem& system, unsigned seed, const Tell& tell) const {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> uniform(-1, 1);
        const int corners = 4 * unknowns;
        system.clear();
        for (int e = 0; e < system.element_count(); ++e) {
            Eigen::MatrixXd root(corners, corners);
            for (double& value : root.reshaped()) value = uniform(random);
            const Eigen::MatrixXd own = root * root.transpose();
            std::vector<double> lower;
            for (int i = 0; i < corners; ++i)
                for (int j = 0; j <= i; ++j) lower.push_back(own(i, j));
            system.add(e, lower);
            const auto at = [&](int i) {
                return unknowns * nodes[static_cast<std::size_t>(4 * e + i / unknowns)] + i % unknowns;
            };
            for (int i = 0; i < corners; ++i)
                for (int j = 0; j < corners; ++j)
                    if (at(i) >= 0 && at(j) >= 0) tell(at(i), at(j), own(i, j));
        }
        for (int u = 0; u < unknowns * side * side; ++u) {
            system.add_to_diagonal(u, 0.1);
            tell(u, u, 0.1);
        }
    }
    int side, unknowns;
    std::vector<int> offsets{0}, nodes;
};

TEST(Multifrontal, SolvesAsADenseFactorDoesForOneMatrixAfterAnother) {
    for (const int side : {2, 5, 30}) {
        const Grid grid(side);
        ElementSystem system = grid.system();
        Eigen::MatrixXd whole;
        for (const unsigned seed : {1U, 2U}) {
            grid.fill(system, seed, whole);
            system.factorize();
            const Eigen::MatrixXd rhs = Eigen::MatrixXd::Random(whole.rows(), 2), x = system.solve(rhs),
                                  expected = whole.llt().solve(rhs);
            EXPECT_LT((x - expected).norm(), 1e-11 * expected.norm()) << side;
            EXPECT_LT(system.last_residual(), 1e-14);
        }
    }
}

TEST(Multifrontal, RefusesWhatIsNotPositiveDefiniteAndTakesTheNextMatrix) {
    const Grid grid(30);
    ElementSystem system = grid.system();
    Eigen::MatrixXd whole;
    grid.fill(system, 3, whole);
    const int unknown = 2 * 400;
    system.add_to_diagonal(unknown, -2 * system.diagonal(unknown));
    EXPECT_THROW(system.factorize(), Error);
    grid.fill(system, 3, whole);
    system.factorize();
    const Eigen::MatrixXd rhs = Eigen::MatrixXd::Ones(whole.rows(), 1);
    EXPECT_LT((whole * system.solve(rhs) - rhs).norm(), 1e-10 * rhs.norm());
}

TEST(Multifrontal, TakesSystemsOfOneUnknownANodeFromTheirSecondMatrixOn) {
    const Grid grid(80, 1);
    const auto nobody = [](int, int, double) {};
    ElementSystem system = grid.system();
    for (const unsigned seed : {1U, 2U, 3U}) {
        grid.fill(system, seed, nobody);
        system.factorize();
        ElementSystem fresh = grid.system();
        grid.fill(fresh, seed, nobody);
        fresh.factorize();
        const Eigen::MatrixXd rhs = Eigen::MatrixXd::Random(80 * 80, 2), expected = fresh.solve(rhs);
        EXPECT_LT((system.solve(rhs) - expected).norm(), 1e-11 * expected.norm());
        EXPECT_LT(system.last_residual(), 1e-14);
    }
}

TEST(Multifrontal, PreconditionsConjugateGradients) {
    const Grid grid(30);
    ElementSystem system = grid.system();
    Eigen::MatrixXd whole;
    grid.fill(system, 4, whole);
    system.factorize();
    for (int u = 0; u < whole.rows(); ++u) {
        system.add_to_diagonal(u, 0.01);
        whole(u, u) += 0.01;
    }
    const Eigen::MatrixXd rhs = Eigen::MatrixXd::Ones(whole.rows(), 1);
    Eigen::MatrixXd x = Eigen::MatrixXd::Ones(whole.rows(), 1);
    ASSERT_TRUE(system.solve_near(rhs, x, 1e-8, 20));
    const Eigen::MatrixXd expected = whole.llt().solve(rhs);
    EXPECT_LT((x - expected).norm(), 1e-6 * expected.norm());
}

}  // namespace
}  // namespace beltrami
