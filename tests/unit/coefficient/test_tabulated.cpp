// The c-step and the certificate with spaces whose coefficients are real, and with spaces known at the samples only.
#include <gtest/gtest.h>

#include <cmath>

#include <beltrami/certificate/certificate.h>
#include <beltrami/charts/domain_chart.h>
#include <beltrami/charts/round_disk.h>
#include <beltrami/coefficient/coefficient_step.h>
#include <beltrami/coefficient/differential_quadrature.h>
#include <beltrami/differentials/laurent_space.h>
#include <beltrami/differentials/polynomial_space.h>
#include <beltrami/differentials/projected_space.h>
#include <beltrami/differentials/tabulated_space.h>
#include <beltrami/mesh/planar.h>
#include <beltrami/meshing/planar_domains.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/teichmuller/hamilton.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

/// A disk with two holes, the space of its own, and a Teichmüller coefficient of it.
struct TwoHoles {
    Surface surface;
    Chart chart;
    LaurentSpace space{*round_domain(surface, chart)};
    Eigen::VectorXcd exact = Eigen::VectorXcd::Zero(3);

    explicit TwoHoles(double edge_length = 0.06)
        : surface(circle_domain({}, {{{-0.4, 0.1}, 0.2}, {{0.35, 0}, 0.25}}, {.edge_length = edge_length})),
          chart(make_chart(surface, planar_coordinates(surface.mesh), true)) {
        exact << 0.6, -0.3, 0.9;
        exact.normalize();
    }
    Eigen::MatrixXcd values() const { return space.evaluate({chart.positions, chart.derivatives}); }
    Eigen::VectorXcd coefficient(double k) const { return teichmueller_coefficient(k, values() * exact); }
    /// A Teichmüller coefficient with noise of mean 0 that turns.
    Eigen::VectorXcd noisy(double k) const {
        Eigen::VectorXcd mu = coefficient(k);
        for (int s = 0; s < mu.size(); ++s) mu[s] += Complex(0.1 * std::sin(3 * s), 0.1 * std::cos(5 * s));
        return mu;
    }
};

TEST(RealCoefficients, AreFoundExactly) {
    const TwoHoles setting;
    for (const int clusters : {100'000, 300})
        for (const double k : {0.05, 0.5, 0.9}) {
            CoefficientStep step(setting.surface, setting.chart, {}, 0, clusters);
            step.set_space(setting.space);
            const CoefficientStep::Result result = step.solve(setting.coefficient(k), {});
            EXPECT_TRUE(result.converged);
            EXPECT_LT(result.newton_steps, 20);
            EXPECT_EQ(result.direction.imag().cwiseAbs().maxCoeff(), 0);
            EXPECT_NEAR(result.k, k, 1e-5);
            EXPECT_LT((result.direction - setting.exact).norm(), 2e-3);
        }
}

TEST(RealCoefficients, AreThoseOfTheMaximumAmongRealOnes) {
    const TwoHoles setting;
    const Eigen::VectorXcd mu = setting.noisy(0.4);
    DualProblem problem{setting.values(), {}, Eigen::VectorXcd::Zero(3), false};
    problem.weights.resize(mu.size());
    for (int s = 0; s < mu.size(); ++s) {
        const double square = std::norm(mu[s]), area = setting.surface.operators.weights[s];
        problem.weights[s] = area * (1 + square) / (1 - square);
        problem.pairing += area / (1 - square) * mu[s] * problem.basis.row(s).transpose();
    }
    const DualSolution solution = solve_dual(problem, {});
    EXPECT_TRUE(solution.converged);
    const auto value = [&](const Eigen::VectorXcd& c) {
        return std::real((problem.pairing.transpose() * c)(0)) / problem.weights.dot((problem.basis * c).cwiseAbs());
    };
    const double best = value(solution.coefficients);
    std::srand(3);
    for (int trial = 0; trial < 200; ++trial) {
        const Eigen::VectorXd other = Eigen::VectorXd::Random(3) * std::pow(10.0, -trial % 5);
        EXPECT_LE(value(solution.coefficients + other.cast<Complex>() * solution.coefficients.norm()), best + 1e-13);
    }
    // More is to be had with complex ones, which would be wrong.
    problem.complex_coefficients = true;
    EXPECT_GT(value(solve_dual(problem, {}).coefficients), best * (1 + 1e-6));
}

TEST(RealCoefficients, OneFunctionNeedsNoStep) {
    const Surface surface(annulus(0.5, 1, 40));
    const Chart chart = make_chart(surface, planar_coordinates(surface.mesh), true);
    const LaurentSpace space(*round_domain(surface, chart));
    CoefficientStep step(surface, chart, {}, 0, 100'000);
    step.set_space(space);
    for (const double sign : {1.0, -1.0}) {
        const Eigen::VectorXcd phi = sign * space.evaluate({chart.positions, chart.derivatives}).col(0);
        const CoefficientStep::Result result = step.solve(teichmueller_coefficient(0.3, phi), {});
        EXPECT_TRUE(result.converged);
        EXPECT_NEAR(result.k, 0.3, 1e-12);
        EXPECT_EQ(result.direction[0], sign);
        EXPECT_EQ(result.newton_steps, 0);
    }
}

TEST(RealCoefficients, OfNoFunctionsThereIsNothing) {
    const Surface surface(disk(10));
    const Chart chart = make_chart(surface, planar_coordinates(surface.mesh), true);
    const LaurentSpace space{RoundDomain()};
    CoefficientStep step(surface, chart, {}, 0, 100'000);
    step.set_space(space);
    const CoefficientStep::Result result =
        step.solve(Eigen::VectorXcd::Constant(surface.operators.sample_count(), 0.3), {});
    EXPECT_EQ(result.k, 0);
    EXPECT_EQ(result.phi.cwiseAbs().maxCoeff(), 0);
}

TEST(Tabulated, TheCoefficientStepIsThatOfTheSpaceItself) {
    const TwoHoles setting;
    const TabulatedSpace table(setting.values());
    const Eigen::VectorXcd mu = setting.noisy(0.4);
    for (const int clusters : {100'000, 300}) {
        CoefficientStep step(setting.surface, setting.chart, {}, 0, clusters);
        step.set_least_rounding(0.026);  // of both; left alone, tables round less
        step.set_space(setting.space);
        const CoefficientStep::Result of_space = step.solve(mu, {});
        step.set_space(table);
        const CoefficientStep::Result of_table = step.solve(mu, {});
        EXPECT_TRUE(of_table.converged);
        EXPECT_NEAR(of_table.k, of_space.k, 1e-9);
        EXPECT_LT((of_table.direction - of_space.direction).norm(), 1e-5);
        EXPECT_LT((of_table.phi - of_space.phi).norm(), 1e-5 * of_space.phi.norm());
    }
}

/// Functions that change from face to face: their means over clusters all but vanish, and with them the Hessian there.
TEST(Tabulated, FunctionsThatMeansHideAskForTheHessianOfAllSamples) {
    const TwoHoles setting;
    const Eigen::MatrixXcd smooth = setting.values();
    const Eigen::Index samples = smooth.rows(), rough = 6;
    Eigen::MatrixXcd values(samples, 3 + rough);
    values.leftCols(3) = smooth;
    for (Eigen::Index s = 0; s < samples; ++s)
        for (Eigen::Index j = 0; j < rough; ++j)
            values(s, 3 + j) = smooth(s, j % 3) * std::polar(1.0, std::fmod((2.0 + j) * s * s, 97));
    const TabulatedSpace table(values, Coefficients::complex);
    Eigen::VectorXcd exact(3 + rough);
    for (Eigen::Index j = 0; j < exact.size(); ++j) exact[j] = std::polar(j < 3 ? 1.0 : 0.05, 1.0 + 2.0 * j);
    exact.normalize();
    Eigen::VectorXcd mu = teichmueller_coefficient(0.4, values * exact);
    for (Eigen::Index s = 0; s < samples; ++s) mu[s] += Complex(0.1 * std::sin(3 * s), 0.1 * std::cos(5 * s));
    CoefficientStep all(setting.surface, setting.chart, {}, 0, 1'000'000),
        few(setting.surface, setting.chart, {}, 0, 300);
    all.set_space(table);
    few.set_space(table);
    const CoefficientStep::Result wanted = all.solve(mu, {}), found = few.solve(mu, {});
    EXPECT_TRUE(wanted.converged);
    EXPECT_TRUE(found.converged);
    EXPECT_LE(found.newton_steps, 30);  // 50 and more with the Hessian of the clusters alone
    EXPECT_LT((found.direction - wanted.direction).norm(), 1e-3);
    EXPECT_NEAR(found.k, wanted.k, 1e-6);
}

/// The annulus .5 … 1 onto .3 … 1 by z|z|^(κ−1): the extremal map with sliding boundary, k = (κ−1)/(κ+1) = .2692640.
TEST(SlidingRing, EverySpaceSeesTheDilatationOfTheRadialStretch) {
    const double kappa = std::log(0.3) / std::log(0.5), k = (kappa - 1) / (kappa + 1);
    EXPECT_NEAR(k, 0.2692640, 4e-7);
    double last_exact = 0, last_projected = 0;
    for (const double edge_length : {0.08, 0.04}) {
        const Surface surface(circle_domain({}, {{{0, 0}, 0.5}}, {.edge_length = edge_length}));
        const Chart chart = plane_chart(surface);
        Eigen::VectorXcd map = planar_coordinates(surface.mesh);
        for (Complex& z : map) z *= std::pow(std::abs(z), kappa - 1);
        const Eigen::VectorXcd mu = beltrami_coefficient(surface.operators, map);
        const LaurentSpace exact(*round_domain(surface, chart));
        const TabulatedSpace projected = projected_space(surface, chart).space;
        const auto found = [&](const DifferentialSpace& space) {
            CoefficientStep step(surface, chart, {}, 0, 100'000);
            step.set_space(space);
            const CoefficientStep::Result result = step.solve(mu, {});
            const ReichStrebel bound = reich_strebel(surface, chart, space, result.direction, mu);
            EXPECT_EQ(bound.resolved, &space == &exact);
            EXPECT_NEAR(bound.lower, (1 + k) / (1 - k), 0.01);
            return std::abs(result.k - k);
        };
        const double of_exact = found(exact), of_projected = found(projected);
        if (last_exact > 0) {
            EXPECT_GT(std::log2(last_exact / of_exact), 1.6);
            EXPECT_GT(std::log2(last_projected / of_projected), 1.6);
        }
        last_exact = of_exact;
        last_projected = of_projected;
    }
    EXPECT_LT(last_exact, 2e-4);
    EXPECT_LT(last_projected, 2e-4);
}

TEST(Tabulated, MeansOverClustersTendToValuesAtTheirCentres) {
    double last = 0;
    for (const int count : {300, 1200}) {
        const TwoHoles setting(0.02);
        const SampleClusters clusters = cluster_samples(setting.surface.operators, setting.chart, {}, 0.3, count);
        const Eigen::MatrixXcd means = means_over_clusters(setting.values(), clusters, setting.chart),
                               exact = setting.space.evaluate(clusters.points);
        const double error = (means - exact).norm() / exact.norm();
        if (last > 0) {
            EXPECT_GT(last / error, 3);  // second order in the edge of a cluster
        }
        last = error;
    }
    EXPECT_LT(last, 5e-3);
}

TEST(Tabulated, NoChartIsNeeded) {
    // A surface in space: values in the samples' frames, which have nothing to do with each other.
    const Surface surface(test::bump(2000));
    const Chart round = round_disk_chart(surface), none = chart_of_frames(surface);
    const PolynomialSpace space(4, 4);
    const Eigen::MatrixXcd values = space.evaluate({round.positions, round.derivatives});
    const TabulatedSpace table(values, Coefficients::complex);
    Eigen::VectorXcd c(5);
    c << 1, Complex(0.5, 1), 0, Complex(-1, 0.2), 0.3;
    c.normalize();
    const Eigen::VectorXcd mu = teichmueller_coefficient(0.35, values * c);
    CoefficientStep with(surface, round, {}, 0, 100'000), without(surface, none, {}, 0, 300);
    with.set_space(space);
    without.set_space(table);
    const CoefficientStep::Result one = with.solve(mu, {}), other = without.solve(mu, {});
    EXPECT_TRUE(other.converged);
    EXPECT_NEAR(other.k, 0.35, 1e-5);
    EXPECT_LT((one.direction - other.direction).norm(), 1e-3);
    EXPECT_LT((other.direction - c * other.direction.dot(c) / std::abs(other.direction.dot(c))).norm(), 1e-3);
    EXPECT_TRUE(reich_strebel(surface, none, table, c, mu).valid);
}

TEST(Tabulated, ReichStrebelIntegralsAreEstimates) {
    double last = 0;
    for (const double edge_length : {0.1, 0.05}) {
        const TwoHoles setting(edge_length);
        const TabulatedSpace table(setting.values());
        const Eigen::VectorXcd mu = setting.noisy(0.4);
        const ReichStrebel exact = reich_strebel(setting.surface, setting.chart, setting.space, setting.exact, mu),
                           estimate = reich_strebel(setting.surface, setting.chart, table, setting.exact, mu);
        EXPECT_TRUE(exact.valid && exact.resolved);
        EXPECT_TRUE(estimate.valid);
        EXPECT_FALSE(estimate.resolved);
        const double error = std::abs(estimate.lower - exact.lower);
        EXPECT_GT(error, 0);
        if (last > 0) {
            EXPECT_GT(last / error, 2.5);
        }
        last = error;
    }
    EXPECT_LT(last, 0.01);
}

TEST(Tabulated, TheQuadratureVisitsEverySampleOnce) {
    for (const bool quads : {false, true}) {
        const Surface surface(quads ? test::quad_square(6, 0.1) : test::mixed_square(6));
        Chart chart = make_chart(surface, planar_coordinates(surface.mesh), true);
        chart.excluded[3] = 1;
        // φ = z at the samples: the places have to be the samples' own.
        const TabulatedSpace table(chart.positions);
        std::vector<FacePoint> points;
        EXPECT_EQ(visit_quadrature(surface, chart, table, Eigen::VectorXcd::Ones(1),
                                   [&](const FacePoint& p) { points.push_back(p); }),
                  1);
        ASSERT_EQ(static_cast<int>(points.size()), surface.operators.sample_count() - 1);
        const ChartPoints places = chart_points(surface, chart, points);
        for (std::size_t i = 0; i < points.size(); ++i) {
            EXPECT_EQ(points[i].phi, chart.positions[points[i].sample]);
            EXPECT_EQ(points[i].weight, surface.operators.weights[points[i].sample]);
            EXPECT_LT(std::abs(places.positions[static_cast<int>(i)] - points[i].phi), 1e-14);
        }
    }
}

}  // namespace
}  // namespace beltrami
