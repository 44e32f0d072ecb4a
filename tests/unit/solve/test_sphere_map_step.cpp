#include <beltrami/solve/sphere_map_step.h>

#include <gtest/gtest.h>

#include <beltrami/generate/sphere.h>
#include <beltrami/operators/distortion.h>

namespace beltrami {
namespace {

TEST(SphereMapStep, ComesToTheCoefficientOfAMapWithItsPins) {
    const Surface surface(icosahedral_sphere(3));
    Positions wanted = surface.mesh.positions;
    wanted.col(2) *= 0.8;
    wanted.rowwise().normalize();
    const Eigen::VectorXcd mu = beltrami_coefficient(surface.operators, wanted, wanted);
    const std::vector<int> pins{0, 5, 11};
    Positions start = surface.mesh.positions;
    for (const int v : pins) start.row(v) = wanted.row(v);
    SphereMapStep step(surface, pins, start);
    step.weigh(Eigen::VectorXcd::Ones(mu.size()));
    const std::any before = step.snapshot();
    for (int i = 0; i < 12; ++i) step.solve(mu, 0);
    EXPECT_LT((step.points() - wanted).cwiseAbs().maxCoeff(), 1e-6);
    EXPECT_LT((beltrami_coefficient(step.derivatives()) - mu).cwiseAbs().maxCoeff(), 1e-5);
    EXPECT_EQ(step.factorization_count(), 12);
    step.restore(before);
    EXPECT_EQ(step.points(), start);
}

}  // namespace
}  // namespace beltrami
