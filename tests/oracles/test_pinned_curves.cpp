// Curves of pinned vertices that cut the source into pieces.
#include <gtest/gtest.h>

#include <algorithm>

#include <beltrami/generate/grids.h>
#include <beltrami/teichmuller/extremal_solver.h>

#include "support/extremal.h"

namespace beltrami {
namespace {

using test::expect_sound;

/// The unit square, x = ½ sent to x = @p to by y, affine on both sides.
bench::Problem bent_square(int n, double to, double amplitude = 0.3) {
    Mesh mesh = rectangle(1, 1, n, n);
    std::vector<char> keep(mesh.vertex_count(), 0);
    for (int v = 0; v < mesh.vertex_count(); ++v) keep[v] = mesh.positions(v, 0) == 0.5;
    JitterOptions jitter;
    jitter.amplitude = amplitude;
    jitter.seed = 5;
    mesh = jittered(std::move(mesh), jitter, {}, keep);
    const auto f = [to](Complex z) {
        const double x = z.real() < 0.5 ? z.real() * to / 0.5 : to + (z.real() - 0.5) * (1 - to) / 0.5;
        return Complex(x, z.imag());
    };
    const double K = std::max(0.5 / to, std::max(to, 1 - to) / 0.5);
    return bench::with_exact_map("bent_square", "", std::move(mesh), f, (K - 1) / (K + 1));
}

/// The vertices of x = ½ inside.
std::vector<int> middle_line(const bench::Problem& problem) {
    const Topology shape = topology(problem.mesh);
    std::vector<int> line;
    for (int v = 0; v < problem.mesh.vertex_count(); ++v)
        if (!shape.on_boundary[v] && problem.mesh.positions(v, 0) == 0.5) line.push_back(v);
    return line;
}

TEST(PinnedCurves, CutASquareIntoAffinePieces) {
    bench::Problem problem = bent_square(24, 0.35);
    const std::vector<int> line = middle_line(problem);
    ASSERT_EQ(line.size(), 23u);
    for (const int v : line) problem.boundary.pin(v, (*problem.exact)[v]);
    const test::Solved solved = test::solve(problem);
    expect_sound(solved.result);
    EXPECT_EQ(solved.result.termination, Termination::converged);
    ASSERT_EQ(solved.result.pieces.size(), 2u);
    EXPECT_LT(solved.vertex_error, 1e-8);
    EXPECT_NEAR(solved.result.K_lower, 0.5 / 0.35, 1e-8);
    EXPECT_NEAR(solved.result.K, 0.5 / 0.35, 1e-8);
    std::vector<double> K{solved.result.pieces[0].K, solved.result.pieces[1].K};
    std::sort(K.begin(), K.end());
    EXPECT_NEAR(K[0], 1.3, 1e-8);
    EXPECT_NEAR(K[1], 0.5 / 0.35, 1e-8);
}

}  // namespace
}  // namespace beltrami
