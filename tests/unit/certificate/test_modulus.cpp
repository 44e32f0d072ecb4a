#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <beltrami/certificate/edge_corner_bound.h>
#include <beltrami/certificate/modulus.h>
#include <beltrami/constraints/boundary_corners.h>
#include <beltrami/meshing/planar_domains.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

TEST(Modulus, EllipticRatio) {
    EXPECT_NEAR(elliptic_ratio(0.5, 0.5), 1, 1e-15);
    EXPECT_NEAR(elliptic_ratio(0.25, 0.75), 2.156515647499643 / 1.685750354812596, 1e-14);  // DLMF 19.2
    EXPECT_NEAR(elliptic_ratio(1e-12, 1 - 1e-12), std::log(16e12) / std::numbers::pi, 1e-9);
    EXPECT_NEAR(elliptic_ratio(1e-12, 1) * elliptic_ratio(1, 1e-12), 1, 1e-12);
}

TEST(Modulus, ARectangleIsExact) {
    Mesh mesh = test::jittered_square(7);
    mesh.positions.col(0) *= 3;
    const Surface surface(mesh);
    std::vector<Complex> images;
    for (const int v : surface.topology.boundary_loops[0])
        images.emplace_back(surface.mesh.positions(v, 0), surface.mesh.positions(v, 1));
    const auto rectangle = rectangle_image(images);
    ASSERT_TRUE(rectangle);
    EXPECT_NEAR(rectangle->modulus, 3, 1e-14);
    const ModulusBracket bracket = quadrilateral_modulus(
        surface.operators, sides_between(surface.topology.boundary_loops[0], rectangle->positions));
    EXPECT_NEAR(bracket.lower, 3, 1e-11);
    EXPECT_NEAR(bracket.upper, 3, 1e-11);
    images[2] *= Complex(1, 1e-6);
    EXPECT_FALSE(rectangle_image(images) && surface.mesh.positions(surface.topology.boundary_loops[0][2], 0) > 0);
}

TEST(Modulus, ArcsOfADisk) {
    const Surface surface(disk(24));
    const auto& loop = surface.topology.boundary_loops[0];
    const std::array<int, 4> positions{3, 20, 70, 100};
    std::array<double, 4> t;
    const auto angle = [&](int p) { return std::arg(test::complex_positions(surface.mesh)[loop[p]]); };
    for (int i = 0; i < 4; ++i) {
        t[i] = angle(positions[i]);
        while (i > 0 && t[i] < t[i - 1]) t[i] += 2 * std::numbers::pi;
    }
    const double exact = disk_modulus(t);
    const ModulusBracket bracket = quadrilateral_modulus(surface.operators, sides_between(loop, positions));
    EXPECT_LT(bracket.lower, bracket.upper);
    EXPECT_GT(exact, 0.98 * bracket.lower);
    EXPECT_LT(exact, 1.02 * bracket.upper);
    EXPECT_LT(bracket.upper / bracket.lower, 1.1);
}

TEST(Modulus, Rings) {
    DomainOptions options;
    options.edge_length = 0.05;
    const Surface surface(circle_domain({}, {{{0.2, 0.1}, 0.3}}, options));
    const double exact = round_ring_modulus(0, 1, {0.2, 0.1}, 0.3);
    const ModulusBracket bracket = ring_modulus(surface);
    EXPECT_LT(bracket.lower, bracket.upper);
    EXPECT_NEAR(bracket.lower, exact, 0.01 * exact);
    EXPECT_NEAR(bracket.upper, exact, 0.01 * exact);
    EXPECT_NEAR(round_ring_modulus(0, 1, 0, 0.25), std::log(4) / (2 * std::numbers::pi), 1e-14);
    // Twice as long in the direction of a cylinder: K of an affine map in logarithmic coordinates.
    EXPECT_NEAR(modulus_ratio(bracket, {2 * exact, 2 * exact}), 2, 0.02);
    EXPECT_NEAR(modulus_ratio({2 * exact, 2 * exact}, bracket), 2, 0.02);
}

TEST(EdgeCornerBound, OneTriangleAndAKink) {
    // A triangle of angles 90, 45, 45 degrees to an equilateral one: the angles alone.
    Mesh mesh;
    mesh.positions = Positions(3, 2);
    mesh.positions << 0, 0, 1, 0, 0, 1;
    mesh.faces.add({0, 1, 2});
    const Surface triangle(mesh);
    Eigen::VectorXcd image(3);
    for (int i = 0; i < 3; ++i) image[i] = std::polar(1.0, 2 * std::numbers::pi * i / 3);
    const EdgeCornerBound corner = edge_corner_bound(triangle, image);
    const double s = std::sqrt(3.0), leg = s, hypotenuse = s / std::sqrt(2.0), pi = std::numbers::pi;
    double expected = corner_bound(pi / 2, pi / 3, leg, leg, 1);
    expected = std::max(expected, corner_bound(pi / 4, pi / 3, hypotenuse, leg, 1));
    EXPECT_NEAR(corner.K, expected, 1e-12);

    // Another speed on one edge of a straight side: a bound by the shear alone, however short the edge is.
    const Surface square(test::jittered_square(8));
    Eigen::VectorXcd map = test::complex_positions(square.mesh);
    EXPECT_NEAR(edge_corner_bound(square, map).K, 1, 1e-12);
    map[4] += 0.05;  // of 1/8
    const EdgeCornerBound kink = edge_corner_bound(square, map);
    EXPECT_EQ(kink.vertex, 4);
    EXPECT_NEAR(kink.K, corner_bound(pi, pi, 1 - 0.4, 1 + 0.4, 1), 1e-12);
}

}  // namespace
}  // namespace beltrami
