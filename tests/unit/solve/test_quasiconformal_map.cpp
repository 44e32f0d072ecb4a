#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Geometry>

#include <beltrami/base/error.h>
#include <beltrami/generate/round_domains.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/solve/beltrami_solver.h>
#include <beltrami/solve/quasiconformal_map.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

using test::complex_positions;

/// f = z + .2 z̄² + .1 z²: ∂f = 1 + .2z, ∂̄f = .4 z̄, one-to-one on the unit disk and the unit square.
Complex smooth(Complex z) {
    return z + 0.2 * std::conj(z) * std::conj(z) + 0.1 * z * z;
}
Complex smooth_coefficient(Complex z) {
    return 0.4 * std::conj(z) / (1.0 + 0.2 * z);
}

/// A coefficient at the samples: of triangles at their barycentres, of quads at the Gauss points.
Eigen::VectorXcd at_the_samples(const Surface& surface, const Eigen::VectorXcd& z, Complex (&mu)(Complex)) {
    Eigen::VectorXcd result(surface.operators.sample_count());
    constexpr double g = 0.57735026918962576451, corner[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    int of_face = 0;
    for (int s = 0; s < result.size(); ++s) {
        of_face = s > 0 && surface.operators.faces[s] == surface.operators.faces[s - 1] ? of_face + 1 : 0;
        const auto stencil = surface.operators.stencil(s);
        Complex place = 0;
        for (std::size_t j = 0; j < stencil.size(); ++j) {
            const double weight = stencil.size() == 3 ? 1.0 / 3
                                                      : 0.25 * (1 + g * corner[of_face][0] * corner[j][0]) *
                                                            (1 + g * corner[of_face][1] * corner[j][1]);
            place += weight * z[stencil[j]];
        }
        result[s] = mu(place);
    }
    return result;
}

double error_on(const Mesh& mesh) {
    const Surface surface(mesh);
    const Eigen::VectorXcd z = complex_positions(mesh), exact = z.unaryExpr(&smooth);
    const Eigen::VectorXcd map = quasiconformal_map(surface, at_the_samples(surface, z, smooth_coefficient),
                                                    test::boundary_values(surface, smooth));
    EXPECT_TRUE(distortion(surface.operators, map).flipped.empty());
    return (map - exact).cwiseAbs().maxCoeff();
}

void expect_second_order(const std::vector<double>& errors) {
    EXPECT_LT(errors.back(), 2e-4);
    for (std::size_t i = 0; i + 1 < errors.size(); ++i) EXPECT_GT(std::log2(errors[i] / errors[i + 1]), 1.8) << i;
}

TEST(QuasiconformalMap, IsOfSecondOrderOnTriangles) {
    expect_second_order({error_on(disk(12)), error_on(disk(24)), error_on(disk(48))});
}

TEST(QuasiconformalMap, IsOfSecondOrderOnQuads) {
    const auto irregular = [](int n) { return test::quad_square(n, 0.6 / n); };
    expect_second_order({error_on(irregular(12)), error_on(irregular(24)), error_on(irregular(48))});
}

TEST(QuasiconformalMap, ReadsTheCoefficientInTheFramesOfTheSamples) {
    const Mesh flat = test::jittered_square(10);
    const Surface plane(flat);
    const Eigen::VectorXcd z = complex_positions(flat), mu = at_the_samples(plane, z, smooth_coefficient);
    const BoundaryCondition boundary = test::boundary_values(plane, smooth);
    const Eigen::VectorXcd expected = quasiconformal_map(plane, mu, boundary);

    Mesh tilted = flat;
    tilted.positions.resize(flat.vertex_count(), 3);
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
    for (int v = 0; v < flat.vertex_count(); ++v) tilted.positions.row(v) = (turn * flat.point(v)).transpose();
    const Surface space(tilted);
    ASSERT_FALSE(space.in_plane());
    Eigen::VectorXcd turned = mu;
    for (int f = 0; f < flat.face_count(); ++f)
        turned[f] = change_frame(mu[f], std::arg(z[flat.faces[f][1]] - z[flat.faces[f][0]]));
    EXPECT_LT((quasiconformal_map(space, turned, boundary) - expected).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_GT((quasiconformal_map(space, mu, boundary) - expected).cwiseAbs().maxCoeff(), 1e-2);
}

TEST(QuasiconformalMap, FindsAPiecewiseLinearMapByItsCoefficient) {
    // A metric in space; the whole boundary prescribed, or it is free with pins on it and inside.
    const Surface surface(test::bump(900));
    Eigen::VectorXcd given(surface.mesh.vertex_count());
    for (int v = 0; v < given.size(); ++v)
        given[v] = smooth({surface.mesh.positions(v, 0), surface.mesh.positions(v, 1)});
    const Distortion measured = distortion(surface.operators, given);
    ASSERT_TRUE(measured.flipped.empty());
    BoundaryCondition whole, some;
    for (const int v : surface.topology.boundary_loops[0]) whole.pin(v, given[v]);
    for (const int v : {0, 17, 200}) some.pin(v, given[v]);
    EXPECT_LT((quasiconformal_map(surface, measured.mu, whole) - given).cwiseAbs().maxCoeff(), 1e-11);
    EXPECT_LT((quasiconformal_map(surface, measured.mu, some) - given).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(QuasiconformalMap, WithoutACoefficientIsHarmonic) {
    const Surface surface(test::mixed_square(9));
    const BoundaryCondition boundary = test::boundary_values(surface, test::three_lobes);
    const Eigen::VectorXcd zero = Eigen::VectorXcd::Zero(surface.operators.sample_count());
    EXPECT_LT((quasiconformal_map(surface, zero, boundary) - harmonic_map(surface, boundary)).cwiseAbs().maxCoeff(),
              1e-13);
}

TEST(QuasiconformalMap, RefusesWhatIsNoCoefficient) {
    const Surface surface(test::jittered_square(4));
    const BoundaryCondition boundary = test::boundary_values(surface, smooth);
    const auto refused = [&](const Eigen::VectorXcd& mu, Cause cause, const std::vector<int>& indices) {
        try {
            quasiconformal_map(surface, mu, boundary);
            ADD_FAILURE() << "accepted";
        } catch (const Error& error) {
            EXPECT_EQ(error.cause(), cause);
            EXPECT_EQ(error.indices(), indices) << error.what();
        }
    };
    Eigen::VectorXcd mu = Eigen::VectorXcd::Constant(surface.operators.sample_count(), 0.3);
    refused(mu.head(5), Cause::bad_option, {});
    mu[3] = Complex(0, -1);
    mu[7] = std::numeric_limits<double>::quiet_NaN();
    refused(mu, Cause::bad_option, {3, 7});
}

TEST(QuasiconformalMap, NamesWhatIsNotDetermined) {
    const Surface surface(test::jittered_square(4));
    const Eigen::VectorXcd mu = Eigen::VectorXcd::Constant(surface.operators.sample_count(), 0.3);
    EXPECT_THROW(quasiconformal_map(surface, mu, {}), Error);
    BoundaryCondition nowhere;
    nowhere.pin(1000, 0.0);
    EXPECT_THROW(quasiconformal_map(surface, mu, nowhere), Error);
}

}  // namespace
}  // namespace beltrami
