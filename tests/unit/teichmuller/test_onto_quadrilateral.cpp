#include <beltrami/teichmuller/onto_quadrilateral.h>

#include <gtest/gtest.h>

#include <cmath>

#include <beltrami/mesh/submesh.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

TargetDomain rectangle_target(double width, double height) {
    return target_domain(TargetCurve::polygon({{1, 1}, {1 + width, 1}, {1 + width, 1 + height}, {1, 1 + height}}), {});
}

/// Marks at the corners of a mesh that stands on its axes, counter-clockwise.
Correspondence corners(const Surface& source, const TargetDomain& target, const std::vector<Complex>& places) {
    Correspondence wanted;
    const Eigen::VectorXcd z = test::complex_positions(source.mesh);
    for (std::size_t i = 0; i < places.size(); ++i) {
        int best = 0;
        for (const int v : source.topology.boundary_loops[0])
            if (std::abs(z[v] - places[i]) < std::abs(z[best] - places[i])) best = v;
        wanted.marks.push_back(nearest_mark(target, best, target.outer.points()[i]));
    }
    return wanted;
}

TEST(OntoQuadrilateral, AffineMapsAreExact) {
    const Surface square(test::jittered_square(8));
    const TargetDomain target = rectangle_target(3, 1.5);
    const Correspondence wanted = corners(square, target, {{0, 0}, {1, 0}, {1, 1}, {0, 1}});
    const auto direct = quadrilateral_onto_rectangle(square, *target_model(target, 0.1), wanted);
    ASSERT_TRUE(direct);
    EXPECT_NEAR(direct->K, 2, 1e-9);
    EXPECT_NEAR(direct->K_lower, 2, 1e-9);
    EXPECT_NEAR(direct->K_upper, 2, 1e-9);
    EXPECT_NEAR(direct->K_max, 2, 1e-9);
    const Eigen::VectorXcd z = test::complex_positions(square.mesh);
    for (Eigen::Index v = 0; v < z.size(); ++v)
        EXPECT_NEAR(std::abs(direct->map[v] - Complex(1 + 3 * z[v].real(), 1 + 1.5 * z[v].imag())), 0, 1e-9);
    // The way through the whole solver is the same, but that it splits edges across the square first.
    const ExtremalMap whole = extremal_map(square, Constraints(target, wanted));
    EXPECT_EQ(whole.iterations, 0);
    ASSERT_TRUE(whole.split);
    ASSERT_GT(whole.map.size(), z.size());
    EXPECT_NEAR((whole.map.head(z.size()) - direct->map).cwiseAbs().maxCoeff(), 0, 1e-9);
}

/// A square with a finger of eight widths: its end is crowded to 1e-11 of the outline.
Mesh square_with_finger() {
    Mesh whole = test::square(40, 0, [](int, int) { return false; });
    std::vector<int> kept;
    for (int f = 0; f < whole.face_count(); ++f) {
        double x = 0, y = 0;
        for (const int v : whole.faces[f]) x += whole.positions(v, 0) / 3, y += whole.positions(v, 1) / 3;
        if (x < 0.2 || (y > 0.4 && y < 0.5)) kept.push_back(f);
    }
    return keep_faces(whole, kept).mesh;
}

TEST(OntoQuadrilateral, ACrowdedDiskHasAMapWithoutFoldsInAProvedBracket) {
    const Surface source(square_with_finger());
    const TargetDomain target = rectangle_target(1, 1);
    const Correspondence wanted = corners(source, target, {{0, 0}, {0.2, 0}, {0.2, 1}, {0, 1}});
    const ExtremalMap map = extremal_map(source, Constraints(target, wanted));
    EXPECT_EQ(map.iterations, 0);
    EXPECT_TRUE(map.distortion.flipped.empty());
    EXPECT_LE(map.K_lower_proved, map.K);
    EXPECT_LE(map.K, map.K_upper);
    EXPECT_LT(map.K_upper, 1.05 * map.K_lower_proved);
    EXPECT_LE(map.K, map.K_max);
    for (const LoopOnto& loop : map.loops) {
        EXPECT_NEAR(loop.area_ratio, 1, 1e-9);
        EXPECT_TRUE(std::is_sorted(loop.parameters.begin(), loop.parameters.end()));
    }
}

TEST(OntoQuadrilateral, ModuliOfTargets) {
    EXPECT_NEAR(target_modulus(rectangle_target(3, 1.5), {0, 3, 4.5, 7.5}).value_or(0), 2, 1e-12);
    EXPECT_NEAR(target_modulus(rectangle_target(3, 1.5), {3, 4.5, 7.5, 0}).value_or(0), 0.5, 1e-12);
    EXPECT_FALSE(target_modulus(rectangle_target(3, 1.5), {0.1, 3, 4.5, 7.5}));
    const TargetDomain circle = target_domain(TargetCurve::circle(0, 2), {});
    const double quarter = std::acos(-1.0);  // of the length
    EXPECT_NEAR(target_modulus(circle, {0.3, 0.3 + quarter, 0.3 + 2 * quarter, 0.3 + 3 * quarter}).value_or(0), 1,
                1e-12);
}

TEST(OntoQuadrilateral, WhatModuliProveOfOtherSlidingProblems) {
    // Rings, and disks with four marks on a circle: the iteration's K lies in the bracket.
    const Surface ring(annulus(0.3, 1, 40));
    const ExtremalMap of_ring =
        extremal_map(ring, target_domain(TargetCurve::circle(0, 1), {TargetCurve::circle(0, 0.6)}));
    const double K = std::log(0.3) / std::log(0.6);
    EXPECT_NEAR(of_ring.K_lower_proved, K, 0.03 * K);
    EXPECT_LE(of_ring.K_lower_proved, of_ring.K);
    EXPECT_LE(of_ring.K, of_ring.K_upper);
    const Surface square(test::jittered_square(12));
    const TargetDomain circle = target_domain(TargetCurve::circle(0, 1), {});
    Correspondence wanted;
    const Eigen::VectorXcd z = test::complex_positions(square.mesh);
    for (const int v : square.topology.boundary_loops[0])
        if (std::abs(std::abs(z[v].real() - 0.5) - 0.5) < 1e-9 && std::abs(std::abs(z[v].imag() - 0.5) - 0.5) < 1e-9)
            wanted.marks.push_back(nearest_mark(circle, v, Complex(1.4 * (z[v].real() - 0.5), z[v].imag() - 0.5)));
    ASSERT_EQ(wanted.marks.size(), 4u);
    const ExtremalMap of_square = extremal_map(square, Constraints(circle, wanted));
    EXPECT_GT(of_square.K_lower_proved, 1.1);
    EXPECT_LE(of_square.K_lower_proved, of_square.K);
    EXPECT_LE(of_square.K, of_square.K_upper);
}

}  // namespace
}  // namespace beltrami
