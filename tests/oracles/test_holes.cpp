// Exact compositions on domains with holes, in the plane, bent, of quads, with a metric of their own, inside out.
#include <gtest/gtest.h>

#include <beltrami/base/error.h>

#include "support/extremal.h"

namespace beltrami {
namespace {

using test::expect_sound;
using test::solve;
using test::Solved;

Mesh three_holes(double edge_length) {
    DomainOptions options;
    options.edge_length = edge_length;
    options.hole_edge_length = edge_length / 2;
    return circle_domain({}, {{{0.4, 0.2}, 0.2}, {{-0.4, 0.3}, 0.15}, {{0.0, -0.5}, 0.25}}, options);
}

bench::Problem composition_on(Mesh mesh) {
    return bench::with_exact_map("composition", "", std::move(mesh), test::exact_composition, 0.5);
}

void expect_composition(const Solved& solved, double k_tolerance, double vertex_tolerance) {
    expect_sound(solved.result);
    EXPECT_EQ(solved.result.termination, Termination::converged);
    EXPECT_NEAR(solved.result.k, 0.5, k_tolerance);
    EXPECT_LE(solved.result.K_lower, 3.0);
    EXPECT_GE(solved.result.K_lower, 3.0 * 0.99);
    EXPECT_GE(solved.result.K_max, 3.0);
    EXPECT_LT(solved.vertex_error, vertex_tolerance);
    for (const HoleTurns& hole : solved.result.homotopy.holes) EXPECT_TRUE(hole.meaningful);
}

TEST(LargeCompositionWithHoles, ThreeHolesConverge) {
    // Measured orders: 1.8 and 2.0.
    const Solved coarse = solve(composition_on(three_holes(0.04))), fine = solve(composition_on(three_holes(0.02)));
    expect_composition(coarse, 2e-4, 4e-3);
    expect_composition(fine, 5e-5, 1e-3);
    EXPECT_TRUE(fine.result.bounds[0].rigorous);
    EXPECT_GE(std::log2((0.5 - coarse.result.k) / (0.5 - fine.result.k)), 1.7);
    EXPECT_GE(std::log2(coarse.vertex_error / fine.vertex_error), 1.8);
}

TEST(CompositionWithHoles, Three) {
    expect_composition(solve(composition_on(three_holes(0.08))), 1e-3, 0.01);
}

TEST(LargeCompositionWithHoles, TwentySeven) {
    const Solved solved = solve(composition_on(bench::holes_27(0.08).mesh));
    EXPECT_EQ(solved.result.homotopy.holes.size(), 27u);
    expect_composition(solved, 4e-4, 6e-3);
}

TEST(CompositionWithHoles, QuadsOfARing) {
    double last = 0;
    for (const int around : {40, 80}) {
        const int layers = around / 4;
        Mesh mesh;
        mesh.positions.resize(around * (layers + 1), 2);
        for (int j = 0; j <= layers; ++j)
            for (int i = 0; i < around; ++i) {
                const Complex z = std::polar(std::pow(0.4, 1 - double(j) / layers), 2 * std::numbers::pi * i / around);
                mesh.positions.row(j * around + i) << z.real(), z.imag();
            }
        for (int j = 0; j < layers; ++j)
            for (int i = 0; i < around; ++i) {
                const int next = (i + 1) % around;
                mesh.faces.add({j * around + i, (j + 1) * around + i, (j + 1) * around + next, j * around + next});
            }
        const Solved solved = solve(composition_on(mesh));
        expect_composition(solved, 1e-4, 0.02);
        EXPECT_FALSE(solved.result.bounds[0].rigorous) << "quads have no proof";
        EXPECT_TRUE(last == 0 || std::log2(last / solved.vertex_error) > 1.7);
        last = solved.vertex_error;
    }
}

Mesh one_hole(double edge_length) {
    DomainOptions options;
    options.edge_length = edge_length;
    return circle_domain({}, {{{0.3, 0.2}, 0.3}}, options);
}

// Rolled up onto a cylinder the plane's metric stays the same, up to the chords.
TEST(CompositionWithHoles, OnABentPlane) {
    double last = 0;
    for (const double edge_length : {0.06, 0.03}) {
        const bench::Problem flat = composition_on(one_hole(edge_length));
        bench::Problem bent = flat;
        bent.mesh.positions.resize(flat.mesh.vertex_count(), 3);
        for (int v = 0; v < flat.mesh.vertex_count(); ++v) {
            const double x = flat.mesh.positions(v, 0);
            bent.mesh.positions.row(v) << std::sin(x), flat.mesh.positions(v, 1), std::cos(x);
        }
        const Solved solved = solve(bent);
        expect_composition(solved, 1e-3, 0.01);
        EXPECT_TRUE(last == 0 || std::log2(last / solved.vertex_error) > 1.5);
        last = solved.vertex_error;
    }
}

TEST(CompositionWithHoles, ACustomMetricIsTheSurfaceThatHasIt) {
    const Mesh flat = one_hole(0.07);
    Mesh bump = flat;
    bump.positions.resize(flat.vertex_count(), 3);
    for (int v = 0; v < flat.vertex_count(); ++v) {
        const Complex z = bench::place(flat, v);
        bump.positions.row(v) << z.real(), z.imag(), 0.5 * std::exp(-4 * std::norm(z - Complex(-0.3, 0)));
    }
    const Surface in_space(bump), with_metric(flat, corner_positions(bump));
    const BoundaryCondition boundary = test::boundary_values(in_space, test::exact_composition);
    const ExtremalMap expected = extremal_map(in_space, boundary), found = extremal_map(with_metric, boundary);
    expect_sound(expected);
    EXPECT_GT(std::abs(expected.k - 0.5), 1e-3) << "the metric must matter";
    EXPECT_NEAR(found.k, expected.k, 1e-9);
    EXPECT_NEAR(found.K_lower, expected.K_lower, 1e-8);
    EXPECT_LT((found.map - expected.map).cwiseAbs().maxCoeff(), 1e-7);
}

// The metric of the exact map's own images: with it the map is an isometry, so conformal.
TEST(CompositionWithHoles, AMetricThatMakesTheMapConformal) {
    const Mesh mesh = one_hole(0.07);
    Mesh image = mesh;
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        const Complex w = test::exact_composition(bench::place(mesh, v));
        image.positions.row(v) << w.real(), w.imag();
    }
    const Surface source(mesh, corner_positions(image));
    const ExtremalMap result = extremal_map(source, test::boundary_values(Surface(mesh), test::exact_composition));
    expect_sound(result);
    EXPECT_LT(result.k, 1e-9);
    EXPECT_LT((result.map - test::complex_positions(image)).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(OuterLoop, ARingTurnedInsideOut) {
    const double K = std::log(0.3) / std::log(0.5);
    const auto inverted = [=](Complex z) { return 1.0 / (z * std::pow(std::abs(z), K - 1)); };
    const Solved straight = solve(bench::ring(0.06));
    const Solved solved =
        solve(bench::with_exact_map("inverted", "", straight.problem.mesh, inverted, *straight.problem.exact_k), {}, 1);
    expect_sound(solved.result);
    EXPECT_EQ(solved.result.homotopy.outer_loop, 1);
    EXPECT_EQ(solved.result.homotopy.holes[0].loop, 0);
    EXPECT_NEAR(solved.result.k, *solved.problem.exact_k, 1e-4);
    EXPECT_LE(solved.result.K_lower, K);
    EXPECT_LT(solved.vertex_error, 1e-4);
    // With the wrong loop outside the boundary values are refused.
    EXPECT_THROW(extremal_map(solved.problem.mesh, solved.problem.boundary), Error);
}

TEST(OuterLoop, OneOfThreeHolesGoesOutside) {
    Mesh mesh = three_holes(0.05);
    const Complex centre = test::exact_composition({0.4, 0.2});
    const Topology shape = topology(mesh);
    int outer_loop = 0;
    for (int loop = 1; loop < 4; ++loop)
        if (std::abs(std::abs(bench::place(mesh, shape.boundary_loops[loop][0]) - Complex(0.4, 0.2)) - 0.2) < 1e-9)
            outer_loop = loop;
    ASSERT_GT(outer_loop, 0);
    // A Möbius map after the composition: K stays 3.
    const Solved solved = solve(bench::with_exact_map(
                                    "inverted", "", std::move(mesh),
                                    [=](Complex z) { return 1.0 / (test::exact_composition(z) - centre); }, 0.5),
                                {}, outer_loop);
    expect_sound(solved.result);
    EXPECT_NEAR(solved.result.k, 0.5, 2e-3);
    EXPECT_LE(solved.result.K_lower, 3.0);
    EXPECT_GE(solved.result.K_lower, 2.95);
}

}  // namespace
}  // namespace beltrami
