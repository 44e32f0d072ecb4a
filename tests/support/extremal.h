#pragma once

// Extremal problems with closed forms, and what every solution has to satisfy.

#include <gtest/gtest.h>

#include <beltrami/teichmuller/extremal_map.h>

#include "problems/construct.h"
#include "problems/problems.h"
#include "support/meshes.h"

namespace beltrami::test {

/// A problem of the bench with its solution.
struct Solved {
    bench::Problem problem;
    ExtremalMap result;
    double vertex_error = 0;  ///< largest distance from the exact map; 0 where none is known
    double exact_K = 0;       ///< of the continuous problem; 0 where unknown
};

inline Solved solve(bench::Problem problem, const ExtremalOptions& options = {}, int outer_loop = 0) {
    Constraints constraints(problem.boundary);
    constraints.correspondence.turns = problem.turns;
    constraints.correspondence.outer_loop = outer_loop;
    Solved solved{std::move(problem), {}};
    solved.result = extremal_map(solved.problem.mesh, constraints, options);
    if (solved.problem.exact)
        solved.vertex_error =
            (solved.result.map.head(solved.problem.exact->size()) - *solved.problem.exact).cwiseAbs().maxCoeff();
    if (solved.problem.exact_k) solved.exact_K = dilatation(*solved.problem.exact_k);
    return solved;
}

/// What holds whatever the problem: one-to-one, K_lower ≤ K ≤ K_max, the boundary obeyed.
inline void expect_sound(const ExtremalMap& result) {
    EXPECT_TRUE(result.one_to_one()) << result.distortion.flipped.size() << " flipped";
    EXPECT_LE(1.0, result.K_lower);
    EXPECT_LE(result.K_lower, result.K);
    EXPECT_LE(result.K, result.K_max);
    EXPECT_EQ(result.boundary_residual, 0.0);
    EXPECT_NEAR(result.K, dilatation(result.k), 1e-9 * result.K);
}

/// The annulus .05 < |z| < 1 with r → r^κ and the outer circle so many turns ahead of the inner one; K in closed form.
inline bench::Problem twisted_annulus(double kappa, int turns, int around, double jitter = 0) {
    const double inner = 0.05, s = 2 * std::numbers::pi * turns / -std::log(inner);
    const double sum = kappa * kappa + s * s + 1, root = std::sqrt(sum * sum - 4 * kappa * kappa);
    const double K = (sum + root) / (2 * kappa);
    JitterOptions displaced;
    displaced.amplitude = jitter;
    bench::Problem problem = bench::with_exact_map(
        "twisted_annulus", "", annulus(inner, 1, around, 0, displaced),
        [=](Complex z) {
            const double log_r = std::log(std::abs(z));
            return std::polar(std::exp(kappa * log_r), std::arg(z) + s * log_r);
        },
        (K - 1) / (K + 1));
    problem.turns = {0, -turns};
    return problem;
}

/// The vertex of the mesh, not on the boundary, that is nearest to a place.
inline int inner_vertex_near(const Mesh& mesh, Complex at) {
    const Topology shape = topology(mesh);
    int best = -1;
    for (int v = 0; v < mesh.vertex_count(); ++v)
        if (!shape.on_boundary[v] &&
            (best < 0 || std::abs(bench::place(mesh, v) - at) < std::abs(bench::place(mesh, best) - at)))
            best = v;
    return best;
}

/// The problem with source and image moved by similarities z → a z + b and w → c w + d.
inline bench::Problem moved(bench::Problem problem, Complex a, Complex b, Complex c, Complex d) {
    for (int v = 0; v < problem.mesh.vertex_count(); ++v) {
        const Complex z = a * bench::place(problem.mesh, v) + b;
        problem.mesh.positions(v, 0) = z.real();
        problem.mesh.positions(v, 1) = z.imag();
    }
    for (Complex& image : problem.boundary.images) image = c * image + d;
    for (auto& line : problem.boundary.lines) {
        line.point = c * line.point + d;
        line.direction *= c;
    }
    return problem;
}

/// The problem with vertices shuffled, faces in the reverse order and each begun at another corner.
inline bench::Problem renumbered(const bench::Problem& problem) {
    const int n = problem.mesh.vertex_count();
    std::vector<int> order(n);
    for (int v = 0; v < n; ++v) order[v] = v;
    for (int v = 0; v < n; ++v) std::swap(order[v], order[(v * 7919LL + 13) % n]);
    bench::Problem result = problem;
    result.mesh.faces = {};
    for (int v = 0; v < n; ++v) result.mesh.positions.row(order[v]) = problem.mesh.positions.row(v);
    for (int f = problem.mesh.face_count() - 1; f >= 0; --f) {
        const auto corners = problem.mesh.faces[f];
        std::vector<int> moved_corners;
        for (std::size_t i = 0; i < corners.size(); ++i)
            moved_corners.push_back(order[corners[(i + 2) % corners.size()]]);
        result.mesh.faces.add(moved_corners);
    }
    for (int& v : result.boundary.vertices) v = order[v];
    for (auto& line : result.boundary.lines) line.vertex = order[line.vertex];
    return result;
}

}  // namespace beltrami::test
