#include <gtest/gtest.h>

#include <beltrami/charts/round_disk.h>
#include <beltrami/coefficient/dual_step.h>
#include <beltrami/differentials/polynomial_space.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

/// The c-step for μ on a disk mesh, summed over every sample.
DualProblem problem_of(const Surface& surface, const Chart& chart, const DifferentialSpace& space,
                       const Eigen::VectorXcd& mu) {
    DualProblem problem;
    problem.basis = space.evaluate({chart.positions, chart.derivatives});
    problem.complex_coefficients = space.complex_coefficients();
    problem.weights.resize(mu.size());
    problem.pairing = Eigen::VectorXcd::Zero(space.size());
    for (int s = 0; s < mu.size(); ++s) {
        const double size = std::norm(mu[s]), area = surface.operators.weights[s];
        problem.weights[s] = area * (1 + size) / (1 - size);
        problem.pairing += area / (1 - size) * mu[s] * problem.basis.row(s).transpose();
    }
    return problem;
}

struct DualSetting {
    Surface surface{disk(disk_rings_for_triangles(3000))};
    Chart chart = round_disk_chart(surface);
    PolynomialSpace space{6, 6};
    Eigen::VectorXcd exact = Eigen::VectorXcd::Zero(7);

    DualSetting() { exact << 1.0, Complex(0.3, 0.2), -0.2, 0, Complex(0, 0.1), 0, 0; }
    Eigen::VectorXcd teichmueller(double k) const {
        const Eigen::VectorXcd phi = space.combination({chart.positions, chart.derivatives}, exact);
        return k * phi.conjugate().cwiseQuotient(phi.cwiseAbs().cast<Complex>());
    }
};

TEST(DualStep, RecoversATeichmuellerCoefficientExactly) {
    const DualSetting setting;
    for (const double k : {0.05, 0.5, 0.9}) {
        const DualProblem problem = problem_of(setting.surface, setting.chart, setting.space, setting.teichmueller(k));
        const DualSolution solution = solve_dual(problem, {});
        EXPECT_NEAR(dilatation_of_pairing(2 * solution.pairing / solution.norm), k, 1e-12);
        const Eigen::VectorXcd direction = solution.coefficients.normalized();
        EXPECT_LT((direction - setting.exact.normalized()).norm(), 1e-7);
        EXPECT_LT(solution.newton_steps, 20);
    }
}

TEST(DualStep, IsTheMaximum) {
    const DualSetting setting;
    Eigen::VectorXcd mu = setting.teichmueller(0.4);
    for (int s = 0; s < mu.size(); ++s) mu[s] = 0.8 * mu[s] + Complex(0.1 * std::sin(s), 0.1 * std::cos(5 * s));
    const DualProblem problem = problem_of(setting.surface, setting.chart, setting.space, mu);
    const DualSolution solution = solve_dual(problem, {});
    const auto value = [&](const Eigen::VectorXcd& c) {
        return std::real((problem.pairing.transpose() * c)(0)) / problem.weights.dot((problem.basis * c).cwiseAbs());
    };
    const double best = value(solution.coefficients);
    EXPECT_NEAR(best, solution.pairing / solution.norm, 1e-12);
    std::srand(7);
    for (int trial = 0; trial < 200; ++trial)
        EXPECT_LE(value(solution.coefficients +
                        std::pow(10.0, -trial % 5) * Eigen::VectorXcd::Random(7) * solution.coefficients.norm()),
                  best + 1e-13);
}

/// N on the points of another problem.
class NormOf final : public DualNorm {
  public:
    explicit NormOf(const DualProblem& problem) : problem_(problem) {}
    Eigen::VectorXcd values(const Eigen::VectorXcd& c) const override { return problem_.basis * c; }
    double norm(const Eigen::VectorXcd& phi, double delta) const override {
        return problem_.weights.dot((phi.array().abs2() + delta * delta).sqrt().matrix());
    }
    Eigen::VectorXcd gradient(const Eigen::VectorXcd& phi, double delta) const override {
        return dual_gradient(problem_.basis, problem_.weights, phi, delta);
    }

  private:
    const DualProblem& problem_;
};

TEST(DualStep, TheMinimumIsThatOfTheNormWhateverTheQuadratureOfTheHessian) {
    const DualSetting setting;
    Eigen::VectorXcd mu = setting.teichmueller(0.4);
    for (int s = 0; s < mu.size(); ++s) mu[s] += Complex(0.05 * std::sin(s), 0.05 * std::cos(5 * s));
    const DualProblem fine = problem_of(setting.surface, setting.chart, setting.space, mu);
    const Eigen::VectorXcd exact = solve_dual(fine, {}).coefficients;

    const SampleClusters clusters = cluster_samples(setting.surface.operators, setting.chart, {}, 0.3, 150);
    DualProblem coarse = fine;
    coarse.basis = setting.space.evaluate(clusters.points);
    coarse.weights = Eigen::VectorXd::Zero(coarse.basis.rows());
    for (int s = 0; s < mu.size(); ++s)
        coarse.weights[clusters.cluster[s]] += clusters.squared[s] * (1 + std::norm(mu[s])) / (1 - std::norm(mu[s]));
    const Eigen::VectorXcd other = solve_dual(coarse, {}).coefficients;
    const double apart = (other / other.norm() - exact / exact.norm()).norm();
    const NormOf norm(fine);
    const DualSolution solution = solve_dual(coarse, {}, {.norm = &norm});
    const Eigen::VectorXcd& c = solution.coefficients;
    EXPECT_TRUE(solution.converged);
    EXPECT_LT(coarse.basis.rows(), 300);
    EXPECT_LT((c / c.norm() - exact / exact.norm()).norm(), 1e-3 * apart + 1e-10);
}

/// Counts how often the norm is looked at.
class CountedNorm final : public DualNorm {
  public:
    explicit CountedNorm(const DualNorm& norm) : norm_(norm) {}
    Eigen::VectorXcd values(const Eigen::VectorXcd& c) const override {
        ++passes;
        return norm_.values(c);
    }
    double norm(const Eigen::VectorXcd& phi, double delta) const override { return norm_.norm(phi, delta); }
    Eigen::VectorXcd gradient(const Eigen::VectorXcd& phi, double delta) const override {
        ++passes;
        return norm_.gradient(phi, delta);
    }
    mutable int passes = 0;

  private:
    const DualNorm& norm_;
};

TEST(DualStep, FewStepsFromNearAndFewLooksAtTheFineNorm) {
    const DualSetting setting;
    Eigen::VectorXcd mu = setting.teichmueller(0.4);
    for (int s = 0; s < mu.size(); ++s) mu[s] += Complex(0.05 * std::sin(s), 0.05 * std::cos(5 * s));
    DualProblem problem = problem_of(setting.surface, setting.chart, setting.space, mu);
    problem.rounding = 0.01;
    const Eigen::VectorXcd exact = solve_dual(problem, {}).coefficients.normalized();
    Eigen::VectorXcd near = exact;
    for (int j = 0; j < near.size(); ++j) near[j] += 0.05 * std::polar(1.0, 2.0 * j);
    const DualSolution own = solve_dual(problem, near, {.step = 0.01});
    EXPECT_TRUE(own.converged);
    EXPECT_LE(own.newton_steps, 4);
    EXPECT_LT((own.coefficients.normalized() - exact).norm(), 0.01);

    const SampleClusters clusters = cluster_samples(setting.surface.operators, setting.chart, {}, 0.3, 150);
    DualProblem coarse = problem;
    coarse.basis = setting.space.evaluate(clusters.points);
    coarse.weights = Eigen::VectorXd::Zero(coarse.basis.rows());
    for (int s = 0; s < mu.size(); ++s)
        coarse.weights[clusters.cluster[s]] += clusters.squared[s] * (1 + std::norm(mu[s])) / (1 - std::norm(mu[s]));
    const NormOf norm(problem);
    const CountedNorm counted(norm);
    const DualSolution fine = solve_dual(coarse, near, {.step = 0.01, .norm = &counted});
    EXPECT_TRUE(fine.converged);
    EXPECT_LE(counted.passes, 7);
    EXPECT_LT((fine.coefficients.normalized() - exact).norm(), 0.01);
}

/// More points than are taken at once, and a different δ at each.
TEST(DualStep, TheHessianIsTheDerivativeOfTheGradient) {
    constexpr Eigen::Index kPoints = 9'000, kFunctions = 3;
    std::srand(3);
    const Eigen::MatrixXcd basis = Eigen::MatrixXcd::Random(kPoints, kFunctions);
    const Eigen::VectorXd weights = Eigen::VectorXd::Random(kPoints).cwiseAbs();
    const Eigen::VectorXd delta = Eigen::VectorXd::Random(kPoints).cwiseAbs() + Eigen::VectorXd::Constant(kPoints, 0.1);
    const auto gradient = [&](const Eigen::VectorXcd& c) {
        const Eigen::VectorXcd phi = basis * c;
        const Eigen::VectorXcd directions =
            (weights.array() / (phi.array().abs2() + delta.array().square()).sqrt()).cast<Complex>() *
            phi.array().conjugate();
        const Eigen::VectorXcd along = basis.transpose() * directions;
        Eigen::VectorXd real(2 * kFunctions);
        real << along.real(), -along.imag();
        return real;
    };
    const Eigen::VectorXcd c = Eigen::VectorXcd::Random(kFunctions), phi = basis * c;
    const Eigen::MatrixXd lower = dual_hessian(basis, true, weights, phi, delta, Eigen::VectorXd::Zero(kPoints));
    const Eigen::MatrixXd hessian = lower.selfadjointView<Eigen::Lower>();
    constexpr double kStep = 1e-5;
    for (Eigen::Index j = 0; j < 2 * kFunctions; ++j) {
        Eigen::VectorXcd way = Eigen::VectorXcd::Zero(kFunctions);
        way[j % kFunctions] = j < kFunctions ? Complex(kStep) : Complex(0, kStep);
        const Eigen::VectorXd difference = (gradient(c + way) - gradient(c - way)) / (2 * kStep);
        EXPECT_LT((difference - hessian.col(j)).norm(), 2e-4 * hessian.col(j).norm());
    }
}

TEST(DualStep, NothingToSee) {
    const DualSetting setting;
    const DualProblem problem = problem_of(setting.surface, setting.chart, setting.space,
                                           Eigen::VectorXcd::Zero(setting.surface.operators.sample_count()));
    EXPECT_EQ(solve_dual(problem, {}).pairing, 0.0);
}

TEST(DualStep, WrongStartsDoNotMatter) {
    const DualSetting setting;
    const DualProblem problem = problem_of(setting.surface, setting.chart, setting.space, setting.teichmueller(0.3));
    const Eigen::VectorXcd c = solve_dual(problem, -setting.exact).coefficients;
    EXPECT_LT((c.normalized() - setting.exact.normalized()).norm(), 1e-7);
}

TEST(DilatationOfPairing, InvertsItsFormula) {
    for (const double k : {0.0, 1e-9, 0.3, 0.99}) EXPECT_NEAR(dilatation_of_pairing(2 * k / (1 + k * k)), k, 1e-14);
}

TEST(Clusters, ShareTheWholeAreaAndTurnWithTheirPhase) {
    const DualSetting setting;
    const SampleClusters clusters = cluster_samples(setting.surface.operators, setting.chart, {}, 0.0, 200);
    double total = 0;
    for (const double a : clusters.squared) total += a;
    EXPECT_NEAR(total, setting.surface.operators.area(), 1e-12);
    Chart turned = setting.chart;
    turned.positions *= std::polar(1.0, 1.1);
    const SampleClusters again = cluster_samples(setting.surface.operators, turned, {}, 1.1, 200);
    EXPECT_EQ(clusters.cluster, again.cluster);
}

}  // namespace
}  // namespace beltrami
