#include <beltrami/solve/laplacian.h>

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include <beltrami/generate/grids.h>
#include <beltrami/operators/surface.h>

namespace beltrami {
namespace {

using detail::Laplacian;

class Laplacians : public testing::TestWithParam<Cells> {
  protected:
    const Surface source_{rectangle(2, 1, 8, 5, GetParam())};
    const Operators& operators_ = source_.operators;
    double x(int v) const { return source_.mesh.positions(v, 0); }
    /// The two sides where x is 0 or 2.
    std::vector<char> sides() const {
        std::vector<char> held(static_cast<std::size_t>(operators_.vertex_count));
        for (int v = 0; v < operators_.vertex_count; ++v) held[v] = x(v) < 1e-9 || x(v) > 2 - 1e-9;
        return held;
    }
    Eigen::VectorXd some_function() const {
        return Eigen::VectorXd::NullaryExpr(operators_.vertex_count, [](Eigen::Index v) { return std::sin(3.0 * v); });
    }
};
INSTANTIATE_TEST_SUITE_P(TrianglesAndQuads, Laplacians, testing::Values(Cells::triangles, Cells::quads));

TEST_P(Laplacians, ExtendsLinearFunctionsAndTakesTheirEnergy) {
    const std::vector<char> held = sides();
    const Laplacian laplacian(operators_, held);
    Eigen::MatrixXd values = Eigen::MatrixXd::Constant(operators_.vertex_count, 2, 99);
    for (int v = 0; v < operators_.vertex_count; ++v)
        if (held[v]) values.row(v) << x(v), 3 - 5 * x(v);
    const Eigen::MatrixXd u = laplacian.extend(values);
    for (int v = 0; v < operators_.vertex_count; ++v) {
        EXPECT_NEAR(u(v, 0), x(v), 1e-13);
        EXPECT_NEAR(u(v, 1), 3 - 5 * x(v), 1e-12);
    }
    EXPECT_NEAR(laplacian.energy(u.col(0)), 2, 1e-12);
    EXPECT_NEAR(laplacian.energy(u.col(1)), 50, 1e-11);
    EXPECT_EQ(laplacian.factorization_count(), 1);
}

TEST_P(Laplacians, SolvesForForces) {
    const std::vector<char> held = sides();
    const Laplacian laplacian(operators_, held);
    const Eigen::VectorXd force = some_function(), u = laplacian.solve(force), applied = laplacian.apply(u);
    for (int v = 0; v < operators_.vertex_count; ++v) {
        if (held[v])
            EXPECT_EQ(u[v], 0);
        else
            EXPECT_NEAR(applied[v], force[v], 1e-12);
    }
    EXPECT_NEAR(laplacian.energy(u), u.dot(applied), 1e-11);
}

TEST_P(Laplacians, OtherWeightsScaleTheSolution) {
    Laplacian laplacian(operators_, sides(), 2);
    const Eigen::VectorXd force = some_function(), before = laplacian.solve(force);
    std::vector<double> weights = operators_.weights;
    for (double& w : weights) w *= 4;
    laplacian.factorize(weights);
    EXPECT_LT((4 * laplacian.solve(force) - before).norm(), 1e-12 * before.norm());
    EXPECT_EQ(laplacian.factorization_count(), 2);
}

/// Signs that are those of the vertices at all their corners only rename u_v to −u_v.
TEST_P(Laplacians, SignsOfWholeVerticesTurnTheirValues) {
    const auto turned = [](int v) { return v % 3 == 0 ? -1.0 : 1.0; };
    std::vector<signed char> signs;
    for (const int v : operators_.vertices) signs.push_back(static_cast<signed char>(turned(v)));
    const Laplacian plain(operators_, sides()), signed_one(operators_, sides(), 1, signs);
    const Eigen::VectorXd force = some_function();
    Eigen::VectorXd turned_force = force;
    for (int v = 0; v < operators_.vertex_count; ++v) turned_force[v] *= turned(v);
    const Eigen::VectorXd u = plain.solve(force), turned_u = signed_one.solve(turned_force);
    const Eigen::VectorXd applied = plain.apply(force), turned_applied = signed_one.apply(turned_force);
    for (int v = 0; v < operators_.vertex_count; ++v) {
        EXPECT_NEAR(turned_u[v], turned(v) * u[v], 1e-12);
        EXPECT_NEAR(turned_applied[v], turned(v) * applied[v], 1e-12);
    }
    EXPECT_NEAR(signed_one.energy(turned_u), plain.energy(u), 1e-11);
    const Eigen::VectorXd extended = plain.extend(force), turned_extended = signed_one.extend(turned_force);
    for (int v = 0; v < operators_.vertex_count; ++v) EXPECT_NEAR(turned_extended[v], turned(v) * extended[v], 1e-12);
}

TEST(Laplacian, VerticesInNoFaceAreZero) {
    Mesh mesh = rectangle(1, 1, 2, 2);
    mesh.positions.conservativeResize(mesh.positions.rows() + 1, Eigen::NoChange);
    mesh.positions.bottomRows(1).setConstant(5);
    const Surface source(std::move(mesh));
    std::vector<char> held(static_cast<std::size_t>(source.operators.vertex_count), 0);
    held[0] = 1;
    const Laplacian laplacian(source.operators, held);
    const Eigen::VectorXd u = laplacian.solve(Eigen::VectorXd::Ones(source.operators.vertex_count));
    EXPECT_EQ(u[u.size() - 1], 0);
    EXPECT_GT(u[1], 0);
}

}  // namespace
}  // namespace beltrami
