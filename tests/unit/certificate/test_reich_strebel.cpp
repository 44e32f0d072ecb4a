// The Reich-Strebel integrals of any map and any φ, against closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include <beltrami/base/error.h>
#include <beltrami/certificate/certificate.h>
#include <beltrami/certificate/refined_problem.h>
#include <beltrami/generate/round_domains.h>
#include <beltrami/mesh/planar.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/solve/beltrami_solver.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

Complex one(Complex) {
    return 1;
}

/// x + iy ↦ Kx + iy: μ = (K−1)/(K+1), extremal between rectangles, with φ = 1.
Eigen::VectorXcd stretched(const Mesh& mesh, double K) {
    Eigen::VectorXcd map = test::complex_positions(mesh);
    map.real() *= K;
    return map;
}

Eigen::VectorXcd coefficient(const Surface& source, const Eigen::VectorXcd& map) {
    return beltrami_coefficient(source.operators, map);
}

TEST(ReichStrebel, OfAnAffineMapOfASquareIsExact) {
    for (const Mesh& mesh : {test::jittered_square(6), test::quad_square(5, 0.2), test::mixed_square(4)}) {
        const Surface source(mesh);
        const QuadraticDifferential phi = differential_of(source, one);
        const Eigen::VectorXcd map = stretched(mesh, 3);
        const ReichStrebel found = reich_strebel(source, phi, derivatives(source.operators, map));
        ASSERT_TRUE(found.valid && found.resolved);
        EXPECT_NEAR(found.lower, 3, 1e-12);
        EXPECT_NEAR(found.estimate, 3, 1e-12);
        EXPECT_NEAR(found.upper, 3, 1e-12);
        EXPECT_EQ(found.lower, reich_strebel(source, phi, coefficient(source, map)).lower);
        EXPECT_EQ(proves(source, phi), all_triangles(mesh));
        // |1 ∓ μφ/|φ||² for φ = −1 and φ = i, with μ = ½.
        EXPECT_NEAR(reich_strebel(source, differential_of(source, [](Complex) { return Complex(-1); }),
                                  coefficient(source, map))
                        .lower,
                    1.0 / 3, 1e-12);
        EXPECT_NEAR(reich_strebel(source, differential_of(source, [](Complex) { return Complex(0, 1); }),
                                  coefficient(source, map))
                        .lower,
                    0.75 / 1.25, 1e-12);
    }
}

TEST(ReichStrebel, OfARadialStretchConvergesFromBelow) {
    // r → r³ on .3 < r < 1: K = 3 = K*, φ = 1/z².
    double last = 0;
    for (const int around : {24, 48, 96}) {
        const Surface source(annulus(0.3, 1, around));
        Eigen::VectorXcd map = test::complex_positions(source.mesh);
        for (Complex& z : map) z *= std::norm(z);
        const QuadraticDifferential phi = differential_of(source, [](Complex z) { return 1.0 / (z * z); });
        EXPECT_TRUE(proves(source, phi));
        const ReichStrebel found = reich_strebel(source, phi, coefficient(source, map));
        ASSERT_TRUE(found.valid && found.resolved);
        EXPECT_LT(found.lower, found.estimate);
        EXPECT_LT(found.estimate, found.upper);
        const double error = std::abs(found.lower - 3);
        if (last > 0) {
            EXPECT_GT(std::log2(last / error), 1.9) << around;
        }
        last = error;
        // Any other map in the class has the same bound on K* or a smaller one, up to the polygon.
        const Eigen::VectorXcd other =
            harmonic_map(source, test::boundary_values(source, [](Complex z) { return z * std::norm(z); }));
        EXPECT_LT(reich_strebel(source, phi, coefficient(source, other)).lower, found.lower);
    }
    EXPECT_LT(last, 5e-3);
}

TEST(ReichStrebel, DoesNotSeeScaleSimilaritiesAndNumbers) {
    const Mesh mesh = annulus(0.4, 1, 30);
    const Surface source(mesh);
    const auto map_of = [](Complex z) { return z * std::abs(z) + 0.1 * std::conj(z); };
    Eigen::VectorXcd map = test::complex_positions(mesh);
    for (Complex& z : map) z = map_of(z);
    const auto phi = [](Complex z) { return 1.0 / (z * z) + 0.3 * z; };
    const Eigen::VectorXcd mu = coefficient(source, map);
    const double lower = reich_strebel(source, differential_of(source, phi), mu).lower;
    const auto scaled = [&](Complex z) { return 2.5e7 * phi(z); };
    EXPECT_NEAR(reich_strebel(source, differential_of(source, scaled), mu).lower, lower, 1e-13);

    // z → a z + b of the source, z → c z + d of the image; φ is dz²'s: divided by a².
    const Complex a = std::polar(3.0, 0.7), b(5, -2);
    Mesh moved = mesh;
    const Eigen::VectorXcd z = test::complex_positions(mesh);
    for (int v = 0; v < mesh.vertex_count(); ++v)
        moved.positions.row(v) << (a * z[v] + b).real(), (a * z[v] + b).imag();
    const Surface elsewhere(moved);
    const auto there = [&](Complex w) { return phi((w - b) / a) / (a * a); };
    const Eigen::VectorXcd image = (Complex(0, 2) * map).array() + Complex(1, 1);
    EXPECT_NEAR(reich_strebel(elsewhere, differential_of(elsewhere, there), coefficient(elsewhere, image)).lower, lower,
                1e-12);

    Mesh backwards = mesh;  // vertices and faces counted from the end
    const int n = mesh.vertex_count();
    backwards.positions = mesh.positions.colwise().reverse();
    backwards.faces = {};
    for (int f = mesh.face_count() - 1; f >= 0; --f) {
        const auto v = mesh.faces[f];
        backwards.faces.add({n - 1 - v[0], n - 1 - v[1], n - 1 - v[2]});
    }
    const Surface renumbered(backwards);
    EXPECT_NEAR(reich_strebel(renumbered, differential_of(renumbered, phi),
                              coefficient(renumbered, Eigen::VectorXcd(map.reverse())))
                    .lower,
                lower, 1e-12);
}

TEST(ReichStrebel, OfATableIsAnEstimate) {
    const Surface source(test::jittered_square(6));
    const Eigen::VectorXcd mu = coefficient(source, stretched(source.mesh, 2));
    const QuadraticDifferential table =
        differential_of(source, Eigen::VectorXcd(Eigen::VectorXcd::Ones(source.operators.sample_count())));
    const ReichStrebel found = reich_strebel(source, table, mu);
    EXPECT_TRUE(found.valid);
    EXPECT_FALSE(found.resolved);
    EXPECT_FALSE(proves(source, table));
    EXPECT_NEAR(found.lower, 2, 1e-12);
}

TEST(ReichStrebel, OfNothingSaysNothing) {
    const Surface source(test::jittered_square(4)), finer(test::jittered_square(5));
    const Eigen::VectorXcd mu = coefficient(source, stretched(source.mesh, 2));
    EXPECT_EQ(reich_strebel(source, QuadraticDifferential(), mu).lower, 1);
    const QuadraticDifferential phi = differential_of(source, one);
    Eigen::VectorXcd folded = mu;
    folded[3] = 1.5;
    EXPECT_FALSE(reich_strebel(source, phi, folded).valid);
    EXPECT_FALSE(reich_strebel(source, QuadraticDifferential(), folded).valid);
    EXPECT_THROW(reich_strebel(finer, phi, mu), Error);
    const QuadraticDifferential table = differential_of(source, Eigen::VectorXcd(mu));
    EXPECT_THROW(reich_strebel(finer, table, coefficient(finer, stretched(finer.mesh, 2))), Error);
}

}  // namespace
}  // namespace beltrami
