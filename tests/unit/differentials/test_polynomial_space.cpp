#include <gtest/gtest.h>

#include <beltrami/charts/round_disk.h>
#include <beltrami/differentials/polynomial_space.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

TEST(PolynomialSpace, IsOrthonormalOnTheDisk) {
    const Surface surface(disk(disk_rings_for_triangles(60000)));
    const Chart chart = round_disk_chart(surface);
    const PolynomialSpace space(6, 6);
    const Eigen::MatrixXcd values = space.evaluate({chart.positions, chart.derivatives});
    Eigen::MatrixXcd gram = Eigen::MatrixXcd::Zero(7, 7);
    for (int s = 0; s < values.rows(); ++s)
        gram += surface.operators.weights[s] * values.row(s).adjoint() * values.row(s);
    EXPECT_LT((gram - Eigen::MatrixXcd::Identity(7, 7)).cwiseAbs().maxCoeff(), 2e-3);
}

TEST(PolynomialSpace, CombinationIsTheProductWithTheBasis) {
    const PolynomialSpace space(9, 9);
    ChartPoints points{0.9 * Eigen::VectorXcd::Random(5000), Eigen::VectorXcd::Random(5000)};
    const Eigen::VectorXcd c = Eigen::VectorXcd::Random(space.size());
    EXPECT_LT((space.combination(points, c) - space.evaluate(points) * c).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(PolynomialSpace, PairingsAreProductsWithTheBasis) {
    const PolynomialSpace space(11, 11);
    ChartPoints points{0.7 * Eigen::VectorXcd::Random(4777), Eigen::VectorXcd::Random(4777)};
    const Eigen::MatrixXcd weights = Eigen::MatrixXcd::Random(4777, 2);
    const Eigen::MatrixXcd expected = space.evaluate(points).transpose() * weights;
    EXPECT_LT((space.pair(points, weights) - expected).cwiseAbs().maxCoeff(), 1e-10);
}

TEST(PolynomialSpace, PulledBackValuesTransformAsQuadraticDifferentials) {
    const PolynomialSpace space(4, 4);
    const ChartPoints in_domain{Eigen::VectorXcd::Random(10), Eigen::VectorXcd::Ones(10)};
    ChartPoints turned = in_domain;
    turned.derivatives *= std::polar(2.0, 0.6);
    EXPECT_LT((space.evaluate(turned) - std::polar(4.0, 1.2) * space.evaluate(in_domain)).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(PolynomialSpace, GrowsByAddingFunctionsUpToALimit) {
    const ChartPoints points{0.7 * Eigen::VectorXcd::Random(20), Eigen::VectorXcd::Ones(20)};
    std::unique_ptr<DifferentialSpace> space = PolynomialSpace::starting_space(PolynomialSpace::largest_degree(40000));
    int last = 0;
    while (space) {
        EXPECT_GT(space->size(), last);
        last = space->size();
        std::unique_ptr<DifferentialSpace> larger = space->refined();
        if (larger) {
            EXPECT_EQ(larger->evaluate(points).leftCols(last), space->evaluate(points));
        }
        space = std::move(larger);
    }
    EXPECT_GE(last, 30);
    EXPECT_LE(PolynomialSpace::largest_degree(100), 9);
    EXPECT_EQ(PolynomialSpace::largest_degree(1'000'000, 80), 80);
    EXPECT_EQ(PolynomialSpace::largest_degree(100, 80), PolynomialSpace::largest_degree(100));
}

}  // namespace
}  // namespace beltrami
