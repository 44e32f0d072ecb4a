#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <random>

#include <beltrami/generate/grids.h>
#include <beltrami/operators/surface.h>
#include <beltrami/solve/coupled_system.h>

namespace beltrami {
namespace {

/// Random positive definite derivatives of every sample, in the system and in dense matrices.
struct RandomParts {
    Eigen::MatrixXd hessian;
    Eigen::VectorXd gradient;

    RandomParts(const Operators& operators, const std::vector<Freedom>& freedoms, CoupledSystem& system) {
        const Eigen::Index n = 2 * operators.vertex_count;
        hessian = Eigen::MatrixXd::Zero(n, n);
        gradient = Eigen::VectorXd::Zero(n);
        std::mt19937 random(5);
        std::normal_distribution<double> normal;
        system.set_zero();
        for (int s = 0; s < operators.sample_count(); ++s) {
            const auto stencil = operators.stencil(s);
            const Eigen::Index m = 2 * static_cast<Eigen::Index>(stencil.size());
            const Eigen::MatrixXd root = Eigen::MatrixXd::NullaryExpr(m, m, [&] { return normal(random); });
            const Eigen::MatrixXd part = root * root.transpose();
            const Eigen::VectorXd slope = Eigen::VectorXd::NullaryExpr(m, [&] { return normal(random); });
            std::vector<double> lower;
            for (Eigen::Index i = 0; i < m; ++i)
                for (Eigen::Index j = 0; j <= i; ++j) lower.push_back(part(i, j));
            system.add(s, slope.data(), lower.data());
            const auto place = [&](Eigen::Index i) { return 2 * stencil[i / 2] + i % 2; };
            for (Eigen::Index i = 0; i < m; ++i) {
                gradient[place(i)] += slope[i];
                for (Eigen::Index j = 0; j < m; ++j) hessian(place(i), place(j)) += part(i, j);
            }
        }
        for (std::size_t v = 0; v < freedoms.size(); ++v) {
            if (freedoms[v] != Freedom::fixed) continue;
            for (Eigen::Index i = 2 * static_cast<Eigen::Index>(v), end = i + 2; i < end; ++i) {
                hessian.row(i).setZero();
                hessian.col(i).setZero();
                hessian(i, i) = 1;
                gradient[i] = 0;
            }
        }
    }
};

class CoupledSystems : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(TrianglesAndQuads, CoupledSystems, testing::Bool());

TEST_P(CoupledSystems, TakesTheNewtonStepOfADenseMatrix) {
    const Surface source(GetParam() ? rectangle(1, 1, 4, 3, Cells::quads) : rectangle(1, 1, 4, 3));
    const Operators& operators = source.operators;
    std::vector<Freedom> freedoms(static_cast<std::size_t>(operators.vertex_count), Freedom::free);
    for (const int v : {0, 3, 7, 12}) freedoms[v] = Freedom::fixed;
    CoupledSystem system(operators, freedoms, 2);
    for (const double factor : {1.0, 3.0}) {
        RandomParts random(operators, freedoms, system);
        if (factor != 1) {
            system.scale_diagonal(factor);
            for (Eigen::Index i = 0; i < random.hessian.rows(); ++i)
                if (freedoms[i / 2] != Freedom::fixed) random.hessian(i, i) *= factor;
        }
        const CoupledSystem::Step step = system.solve();
        const Eigen::VectorXd exact = random.hessian.ldlt().solve(-random.gradient);
        ASSERT_EQ(step.direction.size(), operators.vertex_count);
        for (Eigen::Index v = 0; v < step.direction.size(); ++v)
            EXPECT_LT(std::abs(step.direction[v] - Complex(exact[2 * v], exact[2 * v + 1])), 1e-10 * exact.norm()) << v;
        EXPECT_NEAR(step.slope, random.gradient.dot(exact), 1e-10 * std::abs(step.slope));
        EXPECT_LT(step.slope, 0);
    }
    EXPECT_EQ(system.factorization_count(), 2);
}

}  // namespace
}  // namespace beltrami
