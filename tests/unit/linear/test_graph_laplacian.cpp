#include <beltrami/linear/graph_laplacian.h>

#include <gtest/gtest.h>

#include <complex>
#include <vector>

namespace beltrami {
namespace {

/// Conductors in a row between two held ends: of 1, of 2 and 3 side by side, of 4; and one from a vertex to itself.
struct Row {
    GraphLaplacian laplacian{{{0, 1}, {1, 2}, {2, 1}, {3, 2}, {2, 2}}, {1, 0, 0, 1}};
    Row() { laplacian.set(std::vector<double>{1, 2, 3, 4, 5}); }
    /// Resistances from vertex 0 on.
    static constexpr double to1 = 1, to2 = to1 + 1.0 / 5, to3 = to2 + 1.0 / 4;
};

TEST(GraphLaplacian, ExtendsValuesAsConductorsInARowDo) {
    Row row;
    row.laplacian.factorize();
    using Complex = std::complex<double>;
    const Complex from(0, 3), to(1, 4), unread(9, 9);
    const Eigen::VectorXcd u = row.laplacian.extend(Eigen::Vector4cd(from, unread, unread, to));
    EXPECT_EQ(u[0], from);
    EXPECT_EQ(u[3], to);
    EXPECT_LT(std::abs(u[1] - (from + (to - from) * Row::to1 / Row::to3)), 1e-14);
    EXPECT_LT(std::abs(u[2] - (from + (to - from) * Row::to2 / Row::to3)), 1e-14);
}

TEST(GraphLaplacian, WhatIsPutInFlowsOutWhereItIsHeld) {
    Row row;
    row.laplacian.factorize();
    Eigen::VectorXd load(4);
    load << 7, 0, 1, 7;  // that of held vertices is ignored
    const Eigen::VectorXd u = row.laplacian.solve(load), flux = row.laplacian.flux(u);
    EXPECT_EQ(u[0], 0);
    EXPECT_EQ(u[3], 0);
    EXPECT_NEAR(flux[0], (Row::to3 - Row::to2) / Row::to3, 1e-15);
    EXPECT_NEAR(flux[3], Row::to2 / Row::to3, 1e-15);
    EXPECT_EQ(flux[1], 0);
    EXPECT_EQ(flux[2], 0);
}

TEST(GraphLaplacian, ShiftsItsDiagonal) {
    Row row;
    EXPECT_NEAR(row.laplacian.mean_diagonal(), (6 + 9) / 2.0, 1e-15);
    row.laplacian.shift_diagonal(0.5);
    row.laplacian.factorize();
    Eigen::Vector4d load(0, 1, 0, 0);
    const Eigen::VectorXd u = row.laplacian.solve(load);
    const double determinant = 6.5 * 9.5 - 5 * 5;  // of (6.5 −5; −5 9.5)
    EXPECT_NEAR(u[1], 9.5 / determinant, 1e-15);
    EXPECT_NEAR(u[2], 5 / determinant, 1e-15);
}

TEST(GraphLaplacian, WithNothingLeftToSolveGivesTheValues) {
    GraphLaplacian laplacian({{0, 1}}, {1, 1});
    laplacian.set(std::vector<double>{1});
    laplacian.factorize();
    EXPECT_EQ(laplacian.unknown_count(), 0);
    EXPECT_EQ(laplacian.extend(Eigen::Vector2cd(3, 4)), Eigen::Vector2cd(3, 4));
}

}  // namespace
}  // namespace beltrami
