#include <gtest/gtest.h>

#include <beltrami/base/error.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/operators/frames.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

Mesh turned(const Mesh& mesh, double angle) {
    Mesh result = mesh;
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        const Complex z = std::polar(1.0, angle) * Complex(mesh.positions(v, 0), mesh.positions(v, 1));
        result.positions.row(v).head(2) << z.real(), z.imag();
    }
    return result;
}

/// The same mesh in another plane of space.
Mesh in_space(const Mesh& mesh) {
    Mesh result = mesh;
    result.positions.resize(mesh.vertex_count(), 3);
    const Eigen::RowVector3d x = Eigen::RowVector3d(1, 2, -1).normalized(),
                             y = Eigen::RowVector3d(1, 0, 1).normalized();
    for (int v = 0; v < mesh.vertex_count(); ++v)
        result.positions.row(v) = mesh.positions(v, 0) * x + mesh.positions(v, 1) * y;
    return result;
}

Eigen::VectorXcd image_of(const Mesh& mesh) {
    return test::complex_positions(mesh).unaryExpr([](Complex z) { return z + 0.3 * z * z + 0.2 * std::conj(z); });
}

TEST(Frames, CoefficientsAlongTheFirstEdgeDoNotDependOnTheFrame) {
    for (const Mesh& mesh : {test::jittered_square(6), test::mixed_square(6)}) {
        const Eigen::VectorXcd map = image_of(mesh);
        const auto coefficient = [&](const Mesh& of) {
            const Surface surface(of);
            return mu_along_first_edge(surface, beltrami_coefficient(surface.operators, map));
        };
        const Eigen::VectorXcd mu = coefficient(mesh);
        EXPECT_LT((coefficient(turned(mesh, 0.7)) - mu).cwiseAbs().maxCoeff(), 1e-13);
        EXPECT_LT((coefficient(in_space(mesh)) - mu).cwiseAbs().maxCoeff(), 1e-13);
        // In the plane's own frame it turns.
        const Surface surface(mesh);
        EXPECT_GT((mu - beltrami_coefficient(surface.operators, map)).cwiseAbs().maxCoeff(), 0.1);
    }
}

TEST(Frames, DifferentialsTurnAgainstCoefficients) {
    // μ φ/|φ| is a number without a frame.
    const Surface surface(test::mixed_square(5));
    const Eigen::VectorXcd mu = beltrami_coefficient(surface.operators, image_of(surface.mesh));
    const Eigen::VectorXcd phi = Eigen::VectorXcd::Random(mu.size());
    const Eigen::VectorXcd product = mu_along_first_edge(surface, mu).cwiseProduct(phi_along_first_edge(surface, phi));
    EXPECT_LT((product - mu.cwiseProduct(phi)).cwiseAbs().maxCoeff(), 1e-14);
}

TEST(Frames, CoefficientsOfFacesComeBack) {
    const Surface surface(test::jittered_square(6));
    const Eigen::VectorXcd mu = beltrami_coefficient(surface.operators, image_of(surface.mesh));
    EXPECT_EQ(mu_at_samples(surface, mu), mu);
    EXPECT_EQ(mu_at_samples(surface, mu, CoefficientFrame::plane), mu);
    const Eigen::VectorXcd along = mu_along_first_edge(surface, mu);
    EXPECT_LT((mu_at_samples(surface, along, CoefficientFrame::first_edge) - mu).cwiseAbs().maxCoeff(), 1e-15);
    const Surface space(in_space(surface.mesh));
    EXPECT_EQ(mu_at_samples(space, along, CoefficientFrame::first_edge), along);
    EXPECT_THROW(mu_at_samples(space, along, CoefficientFrame::plane), Error);
    EXPECT_THROW(mu_at_samples(surface, mu.head(3)), Error);
}

TEST(Frames, QuadsHaveOneCoefficientForAllSamples) {
    const Surface surface(test::quad_square(4, 0.2));
    const Eigen::VectorXcd given = 0.3 * Eigen::VectorXcd::Random(surface.mesh.face_count());
    const Eigen::VectorXcd mu = mu_at_samples(surface, given);
    ASSERT_EQ(mu.size(), 4 * given.size());
    for (int s = 0; s < mu.size(); ++s) EXPECT_EQ(mu[s], given[surface.operators.faces[s]]);
}

}  // namespace
}  // namespace beltrami
