#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include <beltrami/base/error.h>
#include <beltrami/locate/planar_locator.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/solve/composition.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

using test::complex_positions;

TEST(PlanarLocator, FindsEveryPointWhereItIs) {
    for (const Mesh& mesh : {test::jittered_square(11), test::mixed_square(8), disk(9)}) {
        const PlanarLocator locator(mesh);
        const Eigen::VectorXcd z = complex_positions(mesh);
        std::mt19937 random(3);
        std::uniform_real_distribution<double> weight(0, 1);
        for (int f = 0; f < mesh.face_count(); ++f) {
            const auto v = mesh.faces[f];
            double a = weight(random), b = weight(random), c = weight(random);
            const Complex p = (a * z[v[0]] + b * z[v[1]] + c * z[v[2]]) / (a + b + c);
            const auto place = locator.locate(p);
            ASSERT_TRUE(place);
            EXPECT_NEAR(std::abs(place->interpolate(z) - p), 0, 1e-13);
            if (v.size() == 3) {
                EXPECT_EQ(place->face, f);
            }
        }
        for (const Complex corner : z) EXPECT_TRUE(locator.locate(corner));
    }
}

TEST(PlanarLocator, TakesPointsOutsideToTheBoundary) {
    const PlanarLocator locator(test::jittered_square(5));
    const Eigen::VectorXcd z = complex_positions(test::jittered_square(5));
    EXPECT_FALSE(locator.locate({0.5, 1.001}));
    EXPECT_FALSE(locator.locate({40, -3}));
    EXPECT_NEAR(std::abs(locator.nearest({0.5, 1.3}).interpolate(z) - Complex(0.5, 1)), 0, 1e-14);
    EXPECT_NEAR(std::abs(locator.nearest({-2, -2}).interpolate(z)), 0, 1e-14);
}

TEST(PlanarLocator, RefusesSurfacesInSpace) {
    EXPECT_THROW(PlanarLocator(test::bump(100)), Error);
}

TEST(ComposeMaps, IsExactForLinearMapsAndSecondOrderElse) {
    const auto f = [](Complex z) {
        return Complex(0.5, 0.5) + 0.3 * (z - Complex(0.5, 0.5)) + Complex(0, 0.05) * z * z;
    };
    const auto g = [](Complex w) { return std::exp(w) + 0.2 * std::conj(w); };
    const Eigen::VectorXcd fz = complex_positions(test::jittered_square(6)).unaryExpr([&](Complex z) { return f(z); });
    double last = 0;
    for (const int n : {10, 20, 40}) {
        const Mesh middle = test::jittered_square(n);
        const Eigen::VectorXcd w = complex_positions(middle);
        const Eigen::VectorXcd linear = compose_maps(fz, middle, Complex(0, 2) * w + 0.5 * w.conjugate());
        EXPECT_LT((linear - (Complex(0, 2) * fz + 0.5 * fz.conjugate())).cwiseAbs().maxCoeff(), 1e-13);
        const Eigen::VectorXcd composed = compose_maps(fz, middle, w.unaryExpr([&](Complex x) { return g(x); }));
        const double error = (composed - fz.unaryExpr([&](Complex x) { return g(x); })).cwiseAbs().maxCoeff();
        if (last > 0) {
            EXPECT_GT(std::log2(last / error), 1.5);
        }
        last = error;
    }
}

TEST(ComposeMaps, AgreesWithTheCompositionOfCoefficients) {
    // f and g affine: μ of the composed map is the composition of their coefficients.
    const Mesh source = test::jittered_square(6);
    const Eigen::VectorXcd z = complex_positions(source);
    const Complex p(0.5, 0.2), q(0.1, 0.15), r(1.1, -0.3), s(0.2, 0.4);
    Mesh middle = source;
    const Eigen::VectorXcd fz = p * z + q * z.conjugate();
    for (int v = 0; v < source.vertex_count(); ++v) middle.positions.row(v) << fz[v].real(), fz[v].imag();
    const Eigen::VectorXcd composed = compose_maps(fz, middle, r * fz + s * fz.conjugate());
    for (const Complex mu : beltrami_coefficient(operators(source), composed))
        EXPECT_NEAR(std::abs(mu - compose_coefficients(q / p, s / r, p)), 0, 1e-11);
}

TEST(ComposeMaps, NamesPointsThatLieOutside) {
    const Mesh middle = test::jittered_square(4);
    Eigen::VectorXcd f(3);
    f << 0.5, Complex(0.5, 1.0000001), Complex(3, 3);
    try {
        compose_maps(f, middle, complex_positions(middle));
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.indices(), std::vector<int>{2});
    }
}

}  // namespace
}  // namespace beltrami
