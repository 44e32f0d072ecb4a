#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <beltrami/base/random.h>
#include <beltrami/generate/sphere.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/operators/surface.h>
#include <beltrami/solve/sphere_barrier.h>

namespace beltrami {
namespace {

/// The sphere pulled towards its equator, without folds.
Positions squashed(const Positions& sphere, double amount) {
    Positions result = sphere;
    for (Eigen::Index v = 0; v < sphere.rows(); ++v) {
        result(v, 2) *= amount;
        result(v, 0) += 0.1 * std::sin(3 * sphere(v, 1));
        result.row(v).normalize();
    }
    return result;
}

SphereBarrier barrier_of(const Surface& surface, std::vector<Freedom> freedoms, const Eigen::VectorXcd& sigma) {
    return {surface.operators, std::move(freedoms), sigma, surface.operators.weights};
}

std::vector<Freedom> all_free(const Surface& surface) {
    return std::vector<Freedom>(static_cast<std::size_t>(surface.mesh.vertex_count()), Freedom::free);
}

TEST(SphereBarrier, IsTheMeanOfItsTermAndInfiniteWhereAFaceIsFlipped) {
    const Surface surface(icosahedral_sphere(2));
    Eigen::VectorXcd sigma(surface.operators.sample_count());
    for (int s = 0; s < sigma.size(); ++s) sigma[s] = std::polar(0.2, 0.1 * s);
    const SphereBarrier barrier = barrier_of(surface, all_free(surface), sigma);
    Positions points = squashed(surface.mesh.positions, 0.7);
    // From the coefficients of the one routine that measures.
    const Eigen::VectorXcd mu = beltrami_coefficient(surface.operators, points, points);
    double expected = 0;
    for (int s = 0; s < mu.size(); ++s) {
        const double d2 = std::norm((mu[s] - sigma[s]) / (1.0 - std::conj(sigma[s]) * mu[s]));
        expected += surface.operators.weights[s] * d2 / (1 - d2) / surface.operators.area();
    }
    EXPECT_NEAR(barrier.value(points), expected, 1e-12 * expected);
    points.row(20) *= -1;
    EXPECT_EQ(barrier.value(points), std::numeric_limits<double>::infinity());
}

TEST(SphereBarrier, StepsLeadBackToAConformalMap) {
    const Surface surface(icosahedral_sphere(3));
    SphereBarrier barrier =
        barrier_of(surface, all_free(surface), Eigen::VectorXcd::Zero(surface.operators.sample_count()));
    Positions points = squashed(surface.mesh.positions, 0.4);
    const double before = barrier.value(points);
    for (int step = 0; step < 8; ++step) {
        const auto taken = barrier.step(points);
        EXPECT_GE(taken.length, 0);
    }
    EXPECT_GT(before, 0.1);
    EXPECT_LT(barrier.value(points), 1e-4 * before);
    EXPECT_LT((points.rowwise().norm().array() - 1).abs().maxCoeff(), 1e-14);
}

TEST(SphereBarrier, ReachesAWantedCoefficientWithPins) {
    // σ is the coefficient of a known map; pinned at three vertices the map itself is the minimum, with F = 0.
    const Surface surface(icosahedral_sphere(3));
    const Positions wanted = squashed(surface.mesh.positions, 0.8);
    std::vector<Freedom> freedoms = all_free(surface);
    for (const int v : {0, 5, 11}) freedoms[v] = Freedom::fixed;
    Positions points = wanted;
    Random random(6);
    for (int v = 0; v < surface.mesh.vertex_count(); ++v) {
        if (freedoms[v] == Freedom::fixed) continue;
        for (int d = 0; d < 3; ++d) points(v, d) += random.uniform(-0.02, 0.02);
        points.row(v).normalize();
    }
    SphereBarrier barrier = barrier_of(surface, freedoms, beltrami_coefficient(surface.operators, wanted, wanted));
    EXPECT_LT(barrier.value(wanted), 1e-20);
    ASSERT_LT(barrier.value(points), 10);
    for (int step = 0; step < 12; ++step) barrier.step(points);
    EXPECT_LT((points - wanted).cwiseAbs().maxCoeff(), 1e-6);
    EXPECT_EQ(points.row(5), wanted.row(5));
}

TEST(SphereBarrier, TheChangeOfTheCoefficientIsItsDerivative) {
    const Surface surface(icosahedral_sphere(2));
    const Positions points = squashed(surface.mesh.positions, 0.7);
    Positions motion = Positions::Zero(points.rows(), 3);
    for (Eigen::Index v = 0; v < points.rows(); ++v) {
        const Eigen::RowVector3d p = points.row(v), way(std::sin(3 * p.y()), p.z(), p.x() * p.x());
        motion.row(v) = way - way.dot(p) * p;
    }
    const auto coefficient = [&](double time) {
        Positions moved = points + time * motion;
        moved.rowwise().normalize();
        return beltrami_coefficient(surface.operators, moved, moved);
    };
    constexpr double h = 1e-5;
    const Eigen::VectorXcd mu = coefficient(0), slope = (coefficient(h) - coefficient(-h)) / (2 * h),
                           change = coefficient_change(surface.operators, points, motion);
    for (Eigen::Index s = 0; s < mu.size(); ++s)
        EXPECT_LT(std::abs((1 - std::norm(mu[s])) * change[s] - slope[s]), 1e-7);
}

}  // namespace
}  // namespace beltrami
