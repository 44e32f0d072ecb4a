// Curves of pinned vertices that cut the source into pieces.
#include <gtest/gtest.h>

#include <algorithm>

#include <beltrami/base/error.h>
#include <beltrami/base/parallel.h>
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

TEST(PinnedCurves, FollowAMovingBoundary) {
    bench::Problem problem = bent_square(24, 0.35);
    for (const int v : middle_line(problem)) problem.boundary.pin(v, (*problem.exact)[v]);
    const Surface surface(problem.mesh);
    ExtremalSolver solver(surface, problem.boundary);
    solver.solve();
    const bench::Problem other = bent_square(24, 0.4);
    std::vector<Complex> images;
    for (const int v : problem.boundary.vertices) images.push_back((*other.exact)[v]);
    const ExtremalSolver::Update update = solver.update(images, 6);
    EXPECT_EQ(update.flipped, 0);
    EXPECT_LT((update.map - *other.exact).cwiseAbs().maxCoeff(), 1e-6);
    EXPECT_NEAR(update.k, 1.0 / 9, 1e-6);
    EXPECT_NEAR(solver.solve().K, 1.25, 1e-8);
    images.pop_back();
    EXPECT_THROW(solver.update(images), Error);
}

TEST(PinnedCurves, HeldToTheirLineOnlyLeaveTheLargestK) {
    // φ = −1 on the compressed side and 0 on the other jumps by a real amount along the line.
    for (const auto& [n, tolerance] : {std::pair(24, 3e-3), std::pair(48, 1.5e-3)}) {
        bench::Problem problem = bent_square(n, 0.35);
        for (const int v : middle_line(problem)) problem.boundary.pin_to_line(v, 0.35, Complex(0, 1));
        const test::Solved solved = test::solve(problem);
        expect_sound(solved.result);
        EXPECT_TRUE(solved.result.pieces.empty());
        EXPECT_TRUE(solved.result.warnings.empty());
        EXPECT_NEAR(solved.result.K_lower, solved.exact_K, tolerance * solved.exact_K);
        EXPECT_NEAR(solved.result.K, solved.exact_K, tolerance * solved.exact_K);
        EXPECT_FALSE(solved.result.bounds[0].rigorous);
    }
}

TEST(PinnedCurves, ThatEndInsideLieBetweenNoneAndAWholeOne) {
    double last = test::solve(bent_square(24, 0.35)).result.K;
    for (const double top : {0.3, 0.6, 0.9}) {
        bench::Problem problem = bent_square(24, 0.35);
        for (const int v : middle_line(problem))
            if (problem.mesh.positions(v, 1) < top) problem.boundary.pin(v, (*problem.exact)[v]);
        const ExtremalMap result = test::solve(problem).result;
        expect_sound(result);
        EXPECT_TRUE(result.pieces.empty());
        EXPECT_TRUE(result.bounds[0].rigorous);
        EXPECT_GT(result.K_lower, last) << top;
        EXPECT_LT(result.K, 1.005 * result.K_lower) << top;
        EXPECT_LT(result.K_lower, 0.5 / 0.35);
        last = result.K;
    }
}

/// The exact composition with the vertices of a part of the real axis pinned to their images, or held to the axis.
bench::Problem on_the_axis(double edge_length, double from, double to, bool held) {
    bench::Problem problem = bench::exact_composition(edge_length);
    const Topology shape = topology(problem.mesh);
    for (int v = 0; v < problem.mesh.vertex_count(); ++v) {
        const Complex z = bench::place(problem.mesh, v);
        if (shape.on_boundary[v] || std::abs(z.imag()) > 1e-12 || z.real() < from || z.real() > to) continue;
        if (held)
            problem.boundary.pin_to_line(v, 0, 1);
        else
            problem.boundary.pin(v, (*problem.exact)[v]);
    }
    return problem;
}

TEST(PinnedCurves, OfTheExactMapChangeNothing) {
    for (const bool held : {false, true})
        for (const auto& [from, to] : {std::pair(-0.7, 0.7), std::pair(-2.0, 0.2), std::pair(-2.0, 2.0)}) {
            const test::Solved solved = test::solve(on_the_axis(0.035, from, to, held));
            expect_sound(solved.result);
            EXPECT_EQ(solved.result.pieces.size(), !held && to == 2 ? 2u : 0u);
            EXPECT_NEAR(solved.result.k, 0.5, 1e-3) << held << from << to;
            EXPECT_NEAR(solved.result.K_lower, 3, 0.01);
        }
}

TEST(PinnedCurves, AnyPlaceSizeAndNumbering) {
    ExtremalOptions options;
    options.evening = ExtremalOptions::Evening::never;  // where it ends is decided by rounding, within 1e-4
    options.prove = false;  // K may not be below what is proved, which an eigenvalue iteration finds to 1e-5
    for (const bool held : {false, true}) {
        bench::Problem problem = on_the_axis(0.06, -0.7, 0.2, held);
        // Away from where the free map sends the curve.
        for (auto& line : problem.boundary.lines) line.point += Complex(0, 0.03);
        const ExtremalMap result = extremal_map(problem.mesh, problem.boundary, options);
        expect_sound(result);
        EXPECT_EQ(result.termination, Termination::converged);
        if (held) {
            EXPECT_GT(result.K_lower, 3.05);
        }
        for (const bench::Problem& other : {test::moved(problem, std::polar(1e3, 1.0), 0, std::polar(1e-3, 0.7), 0),
                                            test::moved(problem, 1, {5, -2}, 1, {-3, 1}), test::renumbered(problem)}) {
            const ExtremalMap same = extremal_map(other.mesh, other.boundary, options);
            EXPECT_TRUE(same.one_to_one());
            EXPECT_NEAR(same.k, result.k, 1e-7) << held;
            EXPECT_NEAR(same.K_lower, result.K_lower, 1e-6) << held;
        }
    }
}

TEST(PinnedCurves, SameBytesOnAnyNumberOfThreads) {
    const int before = thread_count();
    for (const bool held : {false, true})
        for (const double to : {0.2, 2.0}) {
            const bench::Problem problem = on_the_axis(0.05, -2.0, to, held);
            set_thread_count(1);
            const ExtremalMap one = extremal_map(problem.mesh, problem.boundary);
            for (const int threads : {2, 4}) {
                set_thread_count(threads);
                const ExtremalMap more = extremal_map(problem.mesh, problem.boundary);
                EXPECT_EQ(more.map, one.map) << threads << held << to;
                EXPECT_EQ(more.phi, one.phi) << threads << held << to;
                EXPECT_EQ(more.K_lower, one.K_lower) << threads << held << to;
            }
        }
    set_thread_count(before);
}

TEST(PinnedCurves, AHeldVertexFindsTheBestPlaceOnItsLine) {
    // Held to a line beside its exact image: K is the least of those of the places on the line.
    bench::Problem problem = bench::exact_composition(0.04);
    const int v = test::inner_vertex_near(problem.mesh, {0.3, 0.3});
    const Complex direction = std::polar(1.0, 0.9), point = (*problem.exact)[v] + 0.12 * Complex(0, 1) * direction;
    const auto K_at = [&](double t) {
        bench::Problem pinned = problem;
        pinned.boundary.pin(v, point + t * direction);
        return test::solve(pinned).result.K;
    };
    // The parabola through three places.
    const double middle = -0.08, step = 0.08, left = K_at(middle - step), centre = K_at(middle),
                 right = K_at(middle + step), bend = left + right - 2 * centre, slope = 0.5 * (right - left);
    const double best = middle - step * slope / bend, least = centre - 0.5 * slope * slope / bend;
    EXPECT_GT(bend, 0.03);
    EXPECT_GT(least, test::solve(problem).result.K + 0.02);
    problem.boundary.pin_to_line(v, point, direction);
    const ExtremalMap held = test::solve(problem).result;
    expect_sound(held);
    EXPECT_NEAR(held.K, least, 3e-3);
    EXPECT_NEAR(std::real((held.map[v] - point) * std::conj(direction)), best, 0.025);
}

}  // namespace
}  // namespace beltrami
