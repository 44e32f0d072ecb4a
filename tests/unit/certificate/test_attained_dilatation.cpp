#include <beltrami/certificate/attained_dilatation.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include <Eigen/LU>
#include <Eigen/SVD>

#include <beltrami/certificate/proved_bounds.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

using Quad = std::array<Complex, 4>;

Surface one_quad(const Quad& corners, double height = 0) {
    Mesh mesh;
    mesh.positions.resize(4, height == 0 ? 2 : 3);
    for (int i = 0; i < 4; ++i) {
        mesh.positions(i, 0) = corners[i].real();
        mesh.positions(i, 1) = corners[i].imag();
        if (height != 0) mesh.positions(i, 2) = i == 2 ? height : 0;
    }
    mesh.faces.add({0, 1, 2, 3});
    return Surface(std::move(mesh));
}

constexpr Quad kSquare = {Complex(0, 0), Complex(1, 0), Complex(1, 1), Complex(0, 1)};

AttainedDilatation attained(const Surface& source, const Quad& images) {
    const Eigen::VectorXcd map = Eigen::Map<const Eigen::VectorXcd>(images.data(), 4);
    return attained_dilatation(source, map, distortion(source.operators, map));
}

/// K of f∘x⁻¹ at a place, from the singular values of its matrix.
double at(const Quad& x, const Quad& f, double s, double t) {
    const auto matrix = [&](const Quad& q) {
        const Complex along = (1 - t) * (q[1] - q[0]) + t * (q[2] - q[3]),
                      up = (1 - s) * (q[3] - q[0]) + s * (q[2] - q[1]);
        Eigen::Matrix2d m;
        m << along.real(), up.real(), along.imag(), up.imag();
        return m;
    };
    const Eigen::Matrix2d derivative = matrix(f) * matrix(x).inverse();
    const auto values = Eigen::JacobiSVD<Eigen::Matrix2d>(derivative).singularValues();
    return values[0] / values[1];
}

TEST(AttainedDilatation, OfTrianglesIsTheLargestOfAFace) {
    const Surface source(test::jittered_square(5));
    Eigen::VectorXcd map = test::complex_positions(source.mesh);
    map.real() *= 2.5;
    const Distortion measured = distortion(source.operators, map);
    const AttainedDilatation result = attained_dilatation(source, map, measured);
    EXPECT_EQ(result.K, measured.K_max());
    EXPECT_TRUE(result.rigorous);
}

TEST(AttainedDilatation, OfAnAffineQuadIsExact) {
    const AttainedDilatation result = attained(one_quad(kSquare), {Complex(0, 0), {3, 0}, {3, 1}, {0, 1}});
    EXPECT_NEAR(result.K, 3, 1e-12);
    EXPECT_TRUE(result.rigorous);
}

/// A square to a trapezoid of which one side is short: at its end K is larger than at any Gauss point.
TEST(AttainedDilatation, IsThatOfTheWorstCornerAndNoLessThanWhatIsProved) {
    const Surface source = one_quad(kSquare);
    for (const double side : {0.3, 0.1, 0.01, 0.001}) {
        const Quad images{Complex(0, 0), {1, 0}, {1, side}, {0, 1}};
        const AttainedDilatation result = attained(source, images);
        const double worst = at(kSquare, images, 1, 1);
        EXPECT_TRUE(result.rigorous);
        EXPECT_GE(result.K, worst * (1 - 1e-12));
        EXPECT_LE(result.K, worst * 1.0011);
        const Eigen::VectorXcd map = Eigen::Map<const Eigen::VectorXcd>(images.data(), 4);
        const ProvedBounds proved = bounds_of_map(source, map);
        EXPECT_GT(proved.K(), 2);
        EXPECT_LE(proved.K(), result.K);
        EXPECT_TRUE(std::any_of(proved.bounds.begin(), proved.bounds.end(), [&](const Bound& bound) {
            return bound.kind == Bound::Kind::attained && bound.K == result.K && bound.rigorous;
        }));
    }
}

TEST(AttainedDilatation, BoundsBilinearMapsOfBilinearQuads) {
    std::mt19937 random(7);  // NOLINT(cert-msc51-cpp): the same quads on each run
    std::uniform_real_distribution<double> shift(-0.28, 0.28);
    for (int round = 0; round < 30; ++round) {
        Quad x = kSquare, f = kSquare;
        for (int i = 0; i < 4; ++i) {
            x[i] += Complex(shift(random), shift(random));
            f[i] += Complex(shift(random), shift(random));
        }
        const AttainedDilatation result = attained(one_quad(x), f);
        ASSERT_TRUE(result.rigorous) << round;
        double sampled = 1;
        constexpr int kSteps = 40;
        for (int i = 0; i <= kSteps; ++i)
            for (int j = 0; j <= kSteps; ++j)
                sampled = std::max(sampled, at(x, f, i / static_cast<double>(kSteps), j / static_cast<double>(kSteps)));
        EXPECT_GE(result.K, sampled * (1 - 1e-12)) << round;
        EXPECT_LE(result.K, sampled * 1.005) << round;
    }
}

/// Folded in a corner that no Gauss point sees, and bent in space: nothing is proved.
TEST(AttainedDilatation, IsAnEstimateWhereNothingIsProved) {
    const AttainedDilatation folded = attained(one_quad(kSquare), {Complex(0, 0), {1, 0}, {0.48, 0.48}, {0, 1}});
    EXPECT_FALSE(folded.rigorous);
    EXPECT_TRUE(std::isfinite(folded.K));
    const AttainedDilatation bent = attained(one_quad(kSquare, 0.5), kSquare);
    EXPECT_FALSE(bent.rigorous);
    EXPECT_GT(bent.K, 1);
    const AttainedDilatation flipped = attained(one_quad(kSquare), {Complex(0, 0), {0, 1}, {1, 1}, {1, 0}});
    EXPECT_TRUE(std::isinf(flipped.K));
}

}  // namespace
}  // namespace beltrami
