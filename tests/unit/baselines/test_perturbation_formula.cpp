#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include <beltrami/base/error.h>
#include <beltrami/baselines/perturbation_formula.h>
#include <beltrami/generate/grids.h>
#include <beltrami/generate/round_domains.h>
#include <beltrami/generate/sphere.h>
#include <beltrami/operators/distortion.h>

namespace beltrami {
namespace {

/// ρ = c on the unit disk moves w to c(w̄ − w) to first order: it keeps 0 and 1.
TEST(PerturbationMotion, IsTheIntegralOfAConstant) {
    const Complex c(0.3, 0.2);
    std::array<double, 2> errors{};
    for (int i = 0; i < 2; ++i) {
        const Surface source(disk(12 << i));
        const Eigen::VectorXcd& z = *source.coordinate();
        const Eigen::VectorXcd motion =
            perturbation_motion(source.mesh.faces, z, Eigen::VectorXcd::Constant(source.mesh.face_count(), c));
        for (Eigen::Index v = 0; v < z.size(); ++v)
            if (std::abs(z[v]) < 0.8)
                errors[i] = std::max(errors[i], std::abs(motion[v] - c * (std::conj(z[v]) - z[v])));
        EXPECT_EQ(motion[0], 0.0);
    }
    EXPECT_LT(errors[0], 0.03);
    EXPECT_LT(errors[1], 0.6 * errors[0]);
}

TEST(PerturbationFlow, ComesNearTheMapOfACoefficient) {
    Mesh mesh = rectangle(2, 2, 20, 20);
    mesh.positions.array() -= 1;
    const Surface source(mesh);
    const Eigen::VectorXcd& z = *source.coordinate();
    Eigen::VectorXcd exact(z.size());
    for (Eigen::Index v = 0; v < z.size(); ++v) {
        const double x = 1 - z[v].real() * z[v].real(), y = 1 - z[v].imag() * z[v].imag();
        exact[v] = z[v] * std::polar(1.0, x * x * y * y);
    }
    const PerturbationFlow flow = perturbation_flow(source, beltrami_coefficient(source.operators, exact));
    EXPECT_TRUE(flow.converged);
    EXPECT_GT((z - exact).cwiseAbs().maxCoeff(), 0.2);
    EXPECT_LT((flow.map - exact).cwiseAbs().maxCoeff(), 0.03);
    EXPECT_TRUE(distortion(source.operators, flow.map).flipped.empty());
}

TEST(PerturbationFlow, IsForTrianglesInThePlane) {
    const Surface sphere(octahedral_sphere(1)), quads(rectangle(1, 1, 2, 2, Cells::quads));
    for (const Surface* source : {&sphere, &quads})
        EXPECT_THROW(perturbation_flow(*source, Eigen::VectorXcd::Zero(source->operators.sample_count())), Error);
}

}  // namespace
}  // namespace beltrami
