#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <beltrami/meshing/planar_domains.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/unfold/branch_points.h>
#include <beltrami/unfold/displacement_start.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

TEST(BranchPoints, AreWhereAMapWindsTwice) {
    const Surface surface(disk(8));
    const Eigen::VectorXcd z = test::complex_positions(surface.mesh);
    ASSERT_LT(std::abs(z[0]), 1e-12);  // the centre
    EXPECT_TRUE(branch_points(surface, z).empty());
    const Eigen::VectorXcd square = z.cwiseProduct(z);
    EXPECT_EQ(branch_points(surface, square), std::vector{0});
    EXPECT_TRUE(distortion(surface.operators, square).flipped.empty());
    // On the boundary an angle of more than a turn is no branch.
    EXPECT_TRUE(branch_points(surface, (z.array() + 1.0).square().matrix()).empty());
    // Nor is a fold.
    EXPECT_TRUE(branch_points(surface, z.conjugate()).empty());
}

TEST(BranchPoints, OfQuads) {
    // Six around a vertex.
    Mesh star;
    star.positions = Positions::Zero(13, 3);
    for (int i = 0; i < 12; ++i) {
        const Complex z = std::polar(i % 2 ? 2 / std::sqrt(3.0) : 1.0, std::numbers::pi * i / 6);
        star.positions.row(1 + i) << z.real(), z.imag(), 0;
        if (i % 2 == 0) star.faces.add({0, 1 + i, 2 + i, 1 + (i + 2) % 12});
    }
    const Surface surface(star);
    const Eigen::VectorXcd z = test::complex_positions(surface.mesh);
    EXPECT_TRUE(branch_points(surface, z).empty());
    EXPECT_EQ(branch_points(surface, z.cwiseProduct(z)), std::vector{0});
}

TEST(DisplacementStart, IsTheSimilarityThatTheDataAllow) {
    const Surface surface(test::jittered_square(7));
    const Eigen::VectorXcd z = test::complex_positions(surface.mesh);
    const auto similarity = [](Complex w) { return Complex(0.3, 2) * w + Complex(5, -1); };
    BoundaryCondition boundary;
    const auto& loop = surface.topology.boundary_loops[0];
    for (std::size_t i = 0; i < loop.size(); i += 3) boundary.pin(loop[i], similarity(z[loop[i]]));
    const Eigen::VectorXcd map = displacement_start(surface, z, boundary);
    for (Eigen::Index v = 0; v < z.size(); ++v) EXPECT_LT(std::abs(map[v] - similarity(z[v])), 1e-12);
}

TEST(DisplacementStart, ContinuesNaturallyWhereTheBoundaryIsFree) {
    // (1.5 x, y) on two sides: the real part of the displacement is linear in x, which is harmonic, and its normal
    // derivative vanishes on the other sides.
    const Surface surface(test::jittered_square(9));
    const Eigen::VectorXcd z = test::complex_positions(surface.mesh);
    const auto affine = [](Complex w) { return Complex(1.5 * w.real(), w.imag()); };
    BoundaryCondition sides;
    for (const int v : surface.topology.boundary_loops[0])
        if (z[v].real() == 0 || z[v].real() == 1) sides.pin(v, affine(z[v]));
    int line = -1;  // a vertex inside that is held to the line on which it lies
    for (int v = 0; v < z.size(); ++v)
        if (!surface.topology.on_boundary[v]) line = v;
    sides.pin_to_line(line, affine(z[line]) + Complex(0, 3), {0, -2});
    const Eigen::VectorXcd map = displacement_start(surface, z, sides);
    for (const int v : sides.vertices) EXPECT_LT(std::abs(map[v] - affine(z[v])), 1e-12);
    EXPECT_NEAR(map[line].real(), affine(z[line]).real(), 1e-12);
    EXPECT_TRUE(distortion(surface.operators, map).flipped.empty());
    for (Eigen::Index v = 0; v < z.size(); ++v) EXPECT_NEAR(map[v].real(), affine(z[v]).real(), 1e-12) << v;
}

}  // namespace
}  // namespace beltrami
