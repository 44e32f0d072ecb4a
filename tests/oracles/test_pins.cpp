// Prescribed points and lines inside.
#include <gtest/gtest.h>

#include <algorithm>

#include "support/extremal.h"

namespace beltrami {
namespace {

using test::expect_sound;
using test::solve;
using test::Solved;

/// The exact composition on a disk with inner vertices pinned to their exact images, the first displaced.
bench::Problem pinned(double edge_length, Complex displacement = 0) {
    bench::Problem problem = bench::exact_composition(edge_length);
    for (const Complex at : {Complex(0.3, 0.3), Complex(-0.4, 0.1), Complex(0.1, -0.5)}) {
        const int v = test::inner_vertex_near(problem.mesh, at);
        problem.boundary.pin(v, (*problem.exact)[v] + displacement);
        displacement = 0;
    }
    return problem;
}

TEST(Pins, OfTheExactMapChangeNothing) {
    for (const auto& [edge_length, k_tolerance] : {std::pair(0.04, 1e-4), std::pair(0.02, 2e-5)}) {
        const Solved without = solve(bench::exact_composition(edge_length)), with = solve(pinned(edge_length));
        expect_sound(with.result);
        EXPECT_EQ(with.result.termination, Termination::converged);
        EXPECT_NEAR(with.result.k, without.result.k, k_tolerance);
        EXPECT_NEAR(with.result.K_lower, without.result.K_lower, 10 * k_tolerance);
        EXPECT_LE(with.vertex_error, 1.05 * without.vertex_error);
        EXPECT_LT((with.result.map - without.result.map).cwiseAbs().maxCoeff(), 2 * without.vertex_error);
    }
}

TEST(Pins, DisplacedOnesRaiseK) {
    double last = solve(bench::exact_composition(0.04)).result.k;
    for (const double far : {0.05, 0.1, 0.2}) {
        const bench::Problem problem = pinned(0.04, far);
        const ExtremalMap result = solve(problem).result;
        expect_sound(result);
        EXPECT_GT(result.k, last) << far;
        for (std::size_t i = 0; i < problem.boundary.vertices.size(); ++i)
            EXPECT_EQ(result.map[problem.boundary.vertices[i]], problem.boundary.images[i]);
        last = result.k;
        if (far == 0.2) {
            // More than the K of the freer problem, and proved.
            EXPECT_GT(result.K_lower, 3.0);
            EXPECT_TRUE(result.bounds[0].rigorous);
        }
    }
}

/// The vertices of a diameter, on which the exact map is real.
bench::Problem on_the_axis(double edge_length, bool as_lines) {
    bench::Problem problem = bench::exact_composition(edge_length);
    const Topology shape = topology(problem.mesh);
    for (int v = 0; v < problem.mesh.vertex_count(); ++v) {
        const Complex z = bench::place(problem.mesh, v);
        if (shape.on_boundary[v] || std::abs(z.imag()) > 1e-12 || std::abs(z.real()) > 0.7) continue;
        if (as_lines)
            problem.boundary.pin_to_line(v, {0.5, 0}, {-2, 0});
        else
            problem.boundary.pin(v, (*problem.exact)[v]);
    }
    return problem;
}

TEST(Pins, LinesOfTheExactMapChangeNothing) {
    for (const double edge_length : {0.08, 0.04}) {
        const Solved without = solve(bench::exact_composition(edge_length));
        const bench::Problem problem = on_the_axis(edge_length, true);
        ASSERT_GE(problem.boundary.lines.size(), 19u);
        const Solved with = solve(problem);
        expect_sound(with.result);
        EXPECT_EQ(with.result.termination, Termination::converged);
        // By symmetry the axis stays on itself without lines as well.
        EXPECT_NEAR(with.result.k, without.result.k, 1e-6);
        // φ may jump across it, and does as far as the mesh's noise asks for it.
        EXPECT_LT((with.result.map - without.result.map).cwiseAbs().maxCoeff(), 0.1 * without.vertex_error);
        for (const auto& line : problem.boundary.lines) EXPECT_LT(std::abs(with.result.map[line.vertex].imag()), 1e-12);
    }
}

TEST(Pins, LinesInAnyDirection) {
    const Solved without = solve(bench::exact_composition(0.04));
    bench::Problem problem = bench::exact_composition(0.04);
    const Complex direction = std::polar(3.0, 0.8);
    for (const Complex at : {Complex(0.3, 0.3), Complex(-0.4, 0.1), Complex(0.1, -0.5)}) {
        const int v = test::inner_vertex_near(problem.mesh, at);
        problem.boundary.pin_to_line(v, (*problem.exact)[v] + 0.2 * direction, direction);
    }
    const Solved with = solve(problem);
    expect_sound(with.result);
    EXPECT_NEAR(with.result.k, without.result.k, 1e-5);
    EXPECT_LE(with.vertex_error, 1.05 * without.vertex_error);
    for (const auto& line : problem.boundary.lines) {
        const Complex along = (with.result.map[line.vertex] - line.point) / line.direction;
        EXPECT_LT(std::abs(along.imag()), 1e-12);
    }
    // Lines beside where the exact map goes are obeyed too.
    for (auto& line : problem.boundary.lines) line.point += 0.1 * Complex(0, 1) * direction / 3.0;
    const Solved beside = solve(problem);
    expect_sound(beside.result);
    for (const auto& line : problem.boundary.lines) {
        const Complex along = (beside.result.map[line.vertex] - line.point) / line.direction;
        EXPECT_LT(std::abs(along.imag()), 1e-12);
    }
}

TEST(Pins, AWholeCurve) {
    for (const double edge_length : {0.06, 0.03}) {
        const Solved without = solve(bench::exact_composition(edge_length)),
                     with = solve(on_the_axis(edge_length, false));
        expect_sound(with.result);
        EXPECT_NEAR(with.result.k, without.result.k, edge_length > 0.05 ? 2e-4 : 2e-5);
        EXPECT_LE(with.vertex_error, 1.05 * without.vertex_error);
    }
}

}  // namespace
}  // namespace beltrami
