#include <beltrami/teichmuller/crowding.h>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <beltrami/charts/boundary_values.h>
#include <beltrami/charts/round_disk.h>
#include <beltrami/solve/dirichlet_solver.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

/// The quarters of the rim to the right and to the left go to arcs of an angle, those between to what is left.
BoundaryCondition quarters(const Surface& source, const Eigen::VectorXcd& chart, double angle) {
    constexpr double kQuarter = std::numbers::pi / 2;
    BoundaryCondition boundary;
    for (const int v : source.topology.boundary_loops[0]) {
        const double t = (std::arg(chart[v]) + std::numbers::pi) / kQuarter, whole = std::floor(t), part = t - whole;
        const bool even = std::fmod(whole, 2) == 0;
        const double begun = std::ceil(whole / 2) * angle + std::floor(whole / 2) * (2 * kQuarter - angle);
        boundary.pin(v, std::polar(1.0, begun + part * (even ? angle : 2 * kQuarter - angle)));
    }
    return boundary;
}

TEST(Crowding, OfQuartersInArcsOfOneDegree) {
    const Surface source(test::bump(2'000));
    const Chart chart = round_disk_chart(source);
    for (const auto& [angle, crowds] : {std::pair(1.5, false), {1.0, false}, {0.01, true}}) {
        const Eigen::VectorXcd harmonic = harmonic_map(source, quarters(source, chart.vertices, angle));
        EXPECT_EQ(values_crowd(source, chart, harmonic), crowds) << angle;
    }
}

TEST(Crowding, WhatStandsForTheChartHidesNothing) {
    const Surface source(test::bump(500));
    Chart chart = round_disk_chart(source);
    chart.excluded[3] = 1;
    const Eigen::VectorXcd harmonic = harmonic_map(source, boundary_to_disk(source, 0.2));
    const Chart frames = uncrowded(source, chart, harmonic);
    EXPECT_EQ(frames.vertices, chart.vertices);
    EXPECT_EQ(frames.excluded[3], 0);
    EXPECT_FALSE(frames.exact);
    double area = 0;
    for (int s = 0; s < source.operators.sample_count(); ++s)
        area += source.operators.weights[s] * std::norm(frames.derivatives[s]);
    EXPECT_NEAR(area, std::numbers::pi, 1e-9);
    const auto first = source.mesh.faces[0];
    EXPECT_LT(std::abs(frames.positions[0] - (harmonic[first[0]] + harmonic[first[1]] + harmonic[first[2]]) / 3.0),
              1e-12);
}

TEST(Crowding, ProductsAreOrthonormalAndHoldTheHopfDifferential) {
    const Surface source(test::bump(2'000));
    const BeltramiSolver solver = dirichlet_solver(source);
    const Eigen::VectorXcd harmonic = harmonic_map(source, boundary_to_disk(source, 0));
    const TabulatedSpace space = form_product_space(source.operators, rim_nodes(source, harmonic), solver);
    ASSERT_TRUE(space.complex_coefficients());
    EXPECT_GT(space.size(), 10);
    const Eigen::MatrixXcd& values = *space.tabulated();
    const auto areas = Eigen::Map<const Eigen::VectorXd>(source.operators.weights.data(), values.rows());
    const Eigen::MatrixXcd gram = values.adjoint() * areas.asDiagonal() * values;
    EXPECT_LT((gram - Eigen::MatrixXcd::Identity(gram.rows(), gram.cols())).cwiseAbs().maxCoeff(), 1e-10);
    // The rim goes to the circle by its length, so the first of the harmonic functions is the map itself.
    Eigen::VectorXcd square(values.rows());
    for (int s = 0; s < values.rows(); ++s) {
        const Complex dz = source.operators.derivatives(s, harmonic)[0];
        square[s] = dz * dz;
    }
    const Eigen::VectorXcd left = square - values * (values.adjoint() * areas.asDiagonal() * square);
    EXPECT_LT(std::sqrt(areas.dot(left.cwiseAbs2())), 0.01 * std::sqrt(areas.dot(square.cwiseAbs2())));
}

}  // namespace
}  // namespace beltrami
