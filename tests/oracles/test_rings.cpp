// Rings: extremal maps in closed form.
#include <gtest/gtest.h>

#include <algorithm>

#include <beltrami/base/error.h>
#include <beltrami/base/random.h>

#include "support/extremal.h"

namespace beltrami {
namespace {

using test::expect_sound;
using test::solve;
using test::Solved;

TEST(Ring, ConvergesToTheRadialStretch) {
    double last_k = 0, last_vertices = 0;
    for (const double edge_length : {0.12, 0.06, 0.03}) {
        const Solved solved = solve(bench::ring(edge_length));
        expect_sound(solved.result);
        EXPECT_EQ(solved.result.termination, Termination::converged);
        EXPECT_LE(solved.result.K_lower, solved.exact_K);
        EXPECT_GE(solved.result.K_max, solved.exact_K);
        EXPECT_TRUE(solved.result.bounds[0].rigorous);
        EXPECT_EQ(solved.result.homotopy.holes[0].turns, 0);
        const double error = std::abs(solved.result.k - *solved.problem.exact_k);
        EXPECT_NEAR(*solved.problem.exact_k, 0.2692640, 4e-7);
        if (last_k > 0) {
            // Measured orders: 1.7 and 2.1 (the rings of the mesh are whole numbers); 2.7 and 3.1 at the vertices.
            EXPECT_GE(std::log2(last_k / error), 1.6);
            EXPECT_GE(std::log2(last_vertices / solved.vertex_error), 2.5);
        }
        last_k = error;
        last_vertices = solved.vertex_error;
    }
    EXPECT_LT(last_k, 1e-5);
    EXPECT_LT(last_vertices, 3e-7);
}

struct TurnedRing {
    const char* name;
    double kappa;
    int turns;
    double K_tolerance, vertex_tolerance;
    double jitter = 0;
};

class LargeTurnedRings : public testing::TestWithParam<TurnedRing> {};

TEST_P(LargeTurnedRings, HaveTheirClosedForm) {
    const auto& [name, kappa, turns, K_tolerance, vertex_tolerance, jitter] = GetParam();
    const Solved solved = solve(test::twisted_annulus(kappa, turns, 120, jitter));
    const ExtremalMap& result = solved.result;
    EXPECT_EQ(solved.problem.mesh.face_count(), 15840);
    expect_sound(result);
    EXPECT_EQ(result.termination, Termination::converged);
    EXPECT_TRUE(result.warnings.empty()) << result.warnings.front().sentence;
    EXPECT_NEAR(result.K / solved.exact_K, 1, K_tolerance);
    EXPECT_LE(result.K_lower, solved.exact_K);
    EXPECT_GE(result.K_lower, 0.985 * solved.exact_K);
    EXPECT_GE(result.K_max, solved.exact_K);
    EXPECT_LE(solved.vertex_error, vertex_tolerance);
    // The record counts the hole's turns against the outer loop.
    ASSERT_EQ(result.homotopy.holes.size(), 1u);
    EXPECT_EQ(result.homotopy.holes[0].turns, -turns);
    EXPECT_TRUE(result.homotopy.holes[0].meaningful);
}

INSTANTIATE_TEST_SUITE_P(Rings, LargeTurnedRings,
                         testing::Values(TurnedRing{"no_turn_kappa_1_5", 1.5, 0, 0.001, 1e-6},
                                         TurnedRing{"no_turn_kappa_3", 3, 0, 0.001, 2e-5},
                                         TurnedRing{"no_turn_kappa_0_1", 0.1, 0, 0.001, 1e-6},
                                         TurnedRing{"no_turn_kappa_0_05", 0.05, 0, 0.001, 1e-6},
                                         TurnedRing{"one_turn", 1, 1, 0.005, 4e-3},
                                         TurnedRing{"one_turn_kappa_1_5", 1.5, 1, 0.005, 4e-3},
                                         TurnedRing{"minus_one_turn", 1, -1, 0.005, 4e-3},
                                         TurnedRing{"minus_one_turn_kappa_0_4", 0.4, -1, 0.005, 0.02},
                                         TurnedRing{"two_turns", 1, 2, 0.005, 0.03},
                                         TurnedRing{"two_turns_kappa_1_5", 1.5, 2, 0.005, 0.03},
                                         TurnedRing{"two_turns_jittered", 1, 2, 0.005, 0.1, 0.2}),
                         [](const auto& parameter) { return parameter.param.name; });

TEST(TurnedRing, OneTurnAndItsMirrorImageHaveTheSameK) {
    const Solved forwards = solve(test::twisted_annulus(1, 1, 60)), backwards = solve(test::twisted_annulus(1, -1, 60));
    expect_sound(forwards.result);
    EXPECT_NEAR(forwards.result.k, backwards.result.k, 1e-6);
    EXPECT_EQ(forwards.result.homotopy.holes[0].turns, -1);
    EXPECT_EQ(backwards.result.homotopy.holes[0].turns, 1);
    EXPECT_NEAR(forwards.result.K / forwards.exact_K, 1, 0.04);
}

// The identity's boundary values, one turn: a mesh of 693 triangles cannot hold K ≈ 17.
TEST(TurnedRing, LostTurnsAreAnError) {
    DomainOptions domain;
    domain.edge_length = 0.1;
    const Surface surface(circle_domain({}, {{{0, 0}, 0.2}}, domain));
    Constraints constraints(test::boundary_values(surface, [](Complex z) { return z; }));
    constraints.correspondence.turns = {0, 1};
    try {
        EXPECT_EQ(extremal_map(surface, constraints).homotopy.holes[0].turns, 1);
    } catch (const Error& error) {
        EXPECT_EQ(error.cause(), Cause::not_solved);
        EXPECT_NE(std::string(error.what()).find("lost its turns"), std::string::npos) << error.what();
    }
}

TEST(Starts, FoldedBeyondRescueGiveWayToTheHarmonicOne) {
    const bench::Problem problem = bench::screw(0.12);
    const Surface surface(problem.mesh);
    const auto displaced = [&](double by) {
        Eigen::VectorXcd map = *problem.witness;
        Random random(10);
        for (int v = 0; v < map.size(); ++v) {
            const double x = random.uniform(-by, by), y = random.uniform(-by, by);
            if (!surface.topology.on_boundary[v]) map[v] += Complex(x, y);
        }
        return map;
    };
    const ExtremalMap plain = extremal_map(surface, problem.boundary);
    ExtremalOptions options;
    options.start = displaced(0.02);
    const ExtremalMap good = extremal_map(surface, problem.boundary, options);
    expect_sound(good);
    EXPECT_EQ(good.warnings, plain.warnings);
    EXPECT_NEAR(good.k, plain.k, 1e-4);

    options.start = displaced(0.1);
    const ExtremalMap bad = extremal_map(surface, problem.boundary, options);
    expect_sound(bad);
    EXPECT_EQ(bad.termination, Termination::converged);
    EXPECT_NEAR(bad.K, plain.K, 1e-9);
    EXPECT_LT((bad.map - plain.map).cwiseAbs().maxCoeff(), 1e-6);
    EXPECT_GT(bad.iterations, plain.iterations);
    ASSERT_EQ(bad.warnings.size(), plain.warnings.size() + 1);
    EXPECT_EQ(std::count_if(bad.warnings.begin(), bad.warnings.end(),
                            [](const Warning& w) { return w.kind == WarningKind::start; }),
              1);
}

}  // namespace
}  // namespace beltrami
