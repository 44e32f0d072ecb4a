// What must not change k: where the source and the image lie, their size, numbering, threads.
#include <gtest/gtest.h>

#include <beltrami/base/parallel.h>

#include "problems/outlines.h"
#include "support/extremal.h"

namespace beltrami {
namespace {

/// Corners, holes and pins, alone and together.
struct Kind {
    const char* name;
    bool corners, hole, pin;
    double rounding;   ///< how far k may move when coordinates are rounded otherwise
    double numbering;  ///< the same when vertices and faces are renumbered
};
std::ostream& operator<<(std::ostream& out, const Kind& kind) {
    return out << kind.name;
}

bench::Problem problem_of(const Kind& kind) {
    const auto f = [](Complex z) { return z + 0.25 * std::conj(z) + 0.1 * z * z; };
    DomainOptions options;
    options.edge_length = 0.08;
    Mesh mesh;
    if (kind.corners) {
        std::vector<Polygon> holes;
        if (kind.hole) holes.push_back(bench::regular(32, {0.2, 0.1}, 0.3, 0.1));
        mesh = polygon_domain({{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}, holes, options);
    } else {
        std::vector<Circle> holes;
        if (kind.hole) holes.push_back({{0.2, 0.1}, 0.3});
        mesh = circle_domain({}, holes, options);
    }
    bench::Problem problem = bench::with_homeomorphism("invariance", "", std::move(mesh), f);
    if (kind.pin) {
        const int v = test::inner_vertex_near(problem.mesh, {-0.5, -0.4});
        problem.boundary.pin(v, f(bench::place(problem.mesh, v)) + Complex(0.05, 0.08));
    }
    return problem;
}

class Invariances : public testing::TestWithParam<Kind> {};

TEST_P(Invariances, OfTheIteration) {
    const bench::Problem problem = problem_of(GetParam());
    ExtremalOptions options;
    options.evening = ExtremalOptions::Evening::never;
    const auto k_of = [&](const bench::Problem& p) { return extremal_map(p.mesh, p.boundary, options).k; };
    const double k = k_of(problem);
    EXPECT_GT(k, 0.2);
    const double rounding = GetParam().rounding;
    EXPECT_NEAR(k_of(test::moved(problem, std::polar(1.0, 1.0), 0, 1, 0)), k, rounding);
    EXPECT_NEAR(k_of(test::moved(problem, 1e6, 0, 1e6, 0)), k, rounding);
    EXPECT_NEAR(k_of(test::moved(problem, 1e-6, 0, 1e-6, 0)), k, rounding);
    EXPECT_NEAR(k_of(test::moved(problem, std::polar(1e6, 2.0), 0, std::polar(1e-6, 0.3), 0)), k, 5 * rounding);
    // Measured: 2e-8 when the image is turned and scaled alone. A shift rounds the coordinates, which turns the
    // corners of a square, equal before, into corners of some order: 2e-6 (else 2e-10).
    EXPECT_NEAR(k_of(test::moved(problem, 1, 0, std::polar(3.0, 0.7), 0)), k, 10 * rounding);
    EXPECT_NEAR(k_of(test::moved(problem, 1, {50, -20}, 1, {-30, 10})), k, GetParam().corners ? 5e-6 : 1e-8);
    EXPECT_NEAR(k_of(test::renumbered(problem)), k, GetParam().numbering);
}

// Evening out ends where nothing more is to be had by much: rounding decides where within 1e-4.
TEST_P(Invariances, OfTheFinishedMap) {
    const bench::Problem problem = problem_of(GetParam());
    const ExtremalMap result = extremal_map(problem.mesh, problem.boundary);
    test::expect_sound(result);
    for (const bench::Problem& other :
         {test::moved(problem, std::polar(1e6, 1.0), {3, 1}, std::polar(1e-6, 0.7), 0), test::renumbered(problem)}) {
        const ExtremalMap same = extremal_map(other.mesh, other.boundary);
        EXPECT_NEAR(same.k, result.k, 1e-4);
        EXPECT_NEAR(same.K_lower, result.K_lower, 5e-3);
        EXPECT_NEAR(same.distortion.standard_deviation, result.distortion.standard_deviation, 1e-3);
        EXPECT_TRUE(same.one_to_one());
    }
}

TEST_P(Invariances, SameBytesOnAnyNumberOfThreads) {
    const bench::Problem problem = problem_of(GetParam());
    const int before = thread_count();
    set_thread_count(1);
    const ExtremalMap one = extremal_map(problem.mesh, problem.boundary);
    for (const int threads : {2, 4}) {
        set_thread_count(threads);
        const ExtremalMap more = extremal_map(problem.mesh, problem.boundary);
        EXPECT_EQ(more.map, one.map) << threads;
        EXPECT_EQ(more.phi, one.phi) << threads;
        EXPECT_EQ(more.k, one.k) << threads;
        EXPECT_EQ(more.K_lower, one.K_lower) << threads;
    }
    set_thread_count(before);
}

// Equal corners come in the order of the boundary, which begins at its smallest vertex: which of two nearly dependent
// poles is left out depends on the numbering, and k by 2e-6.
// Measured, of rounding: 6e-10; with corners and a hole 4e-6, where growing the space once more is worth just about
// options.growth = 1e-5 of k. Of numbering: 4e-5 there, for the mesh that fills the hole for the chart begins at the
// loop's first vertex.
INSTANTIATE_TEST_SUITE_P(
    Kinds, Invariances,
    testing::Values(Kind{"disk", false, false, false, 1e-8, 1e-8}, Kind{"pin", false, false, true, 1e-8, 1e-8},
                    Kind{"corners", true, false, false, 1e-8, 5e-6},
                    Kind{"corners_and_pin", true, false, true, 1e-8, 5e-6},
                    Kind{"hole", false, true, false, 1e-8, 1e-8}, Kind{"hole_and_pin", false, true, true, 1e-8, 1e-8},
                    Kind{"corners_and_hole", true, true, false, 5e-6, 1e-4}, Kind{"all", true, true, true, 5e-6, 1e-4}),
    [](const auto& parameter) { return parameter.param.name; });

}  // namespace
}  // namespace beltrami
