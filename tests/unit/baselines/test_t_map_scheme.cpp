#include <gtest/gtest.h>

#include <algorithm>

#include <beltrami/base/error.h>
#include <beltrami/baselines/t_map_scheme.h>

#include "support/onto.h"

namespace beltrami {
namespace {

using test::circles_target;
using test::disk_with_holes;
using Part = TMapSolve::Part;
using Projection = TMapSchemeOptions::Projection;

/// Example 5 of Ng, Gu & Lui 2014, whose extremal map has k = .2708.
struct Example5 {
    Surface source{disk_with_holes({{0, 0.5, 0.1}, {-0.4, -0.3, 0.1}, {0.4, -0.3, 0.1}}, 0.12)};
    TargetDomain target = circles_target({{0, 0.5, 0.2}, {-0.4, -0.3, 0.2}, {0.4, -0.3, 0.2}});
    Correspondence loops;
    Example5() { loops.loops = {{0, 0}, {1, 1}, {2, 2}, {3, 3}}; }
};

class TMapScheme : public testing::TestWithParam<Projection> {};

TEST_P(TMapScheme, EvensTheDilatationAndKeepsTheWindings) {
    const Example5 problem;
    TMapSchemeOptions options;
    options.projection = GetParam();
    options.max_solves = 60;
    const SlidingStart start = flow_start(problem.source, problem.target, problem.loops);
    const Distortion before = distortion(problem.source.operators, start.map);
    const TMapSchemeResult result = t_map_scheme(problem.source, start, options);
    EXPECT_EQ(static_cast<int>(result.history.size()), result.solves);
    EXPECT_LE(result.solves, 60);
    EXPECT_TRUE(result.one_to_one());
    EXPECT_LT(result.distortion.standard_deviation, 0.5 * before.standard_deviation);
    EXPECT_NEAR(result.distortion.mean, 0.2708, 0.03);
    EXPECT_EQ(result.history.front().part, Part::initial);
    ASSERT_EQ(result.loops.size(), 4u);
    for (const LoopOnto& loop : result.loops) {
        EXPECT_EQ(loop.curve, loop.loop);
        EXPECT_GT(loop.area_ratio, 0.9);
        EXPECT_LT(loop.area_ratio, 1 + 1e-9);
        for (std::size_t i = 0; i + 1 < loop.parameters.size(); ++i)
            EXPECT_LT(loop.parameters[i], loop.parameters[i + 1]);
    }
    EXPECT_EQ(result.history.back().standard_deviation, result.distortion.standard_deviation);
}

INSTANTIATE_TEST_SUITE_P(Projections, TMapScheme,
                         testing::Values(Projection::fixed_boundary, Projection::sliding_boundary),
                         [](const auto& test) {
                             return test.param == Projection::fixed_boundary ? "fixed_boundary" : "sliding_boundary";
                         });

TEST(TMapSchemeVariants, DoWhatTheySay) {
    const Example5 problem;
    const SlidingStart start = flow_start(problem.source, problem.target, problem.loops);
    TMapSchemeOptions options;
    options.max_solves = 12;
    options.projection_steps = 2;
    options.initial_steps = 2;
    options.tolerance = 1e-9;
    std::vector<Part> parts;
    for (const TMapSolve& solve : t_map_scheme(problem.source, start, options).history) parts.push_back(solve.part);
    const std::vector<Part> expected{Part::initial,    Part::initial,    Part::projection, Part::projection,
                                     Part::damping,    Part::projection, Part::projection, Part::damping,
                                     Part::projection, Part::projection, Part::damping,    Part::projection};
    EXPECT_EQ(parts, expected);
    // Without damping and with a fixed boundary nothing but the first steps moves the boundary.
    options.damping = 0;
    const TMapSchemeResult held = t_map_scheme(problem.source, start, options);
    for (const TMapSolve& solve : held.history) EXPECT_NE(solve.part, Part::damping);
    options.max_solves = 3;
    const TMapSchemeResult shorter = t_map_scheme(problem.source, start, options);
    for (std::size_t l = 0; l < held.loops.size(); ++l)
        EXPECT_EQ(held.loops[l].parameters, shorter.loops[l].parameters);
}

TEST(TMapSchemeVariants, SayWhatIsWrong) {
    const Example5 problem;
    for (const TMapSchemeOptions& options : {TMapSchemeOptions{.damping = 1}, TMapSchemeOptions{.projection_steps = 0},
                                             TMapSchemeOptions{.smoothing = 2}, TMapSchemeOptions{.initial_steps = -1},
                                             TMapSchemeOptions{.tolerance = 0}, TMapSchemeOptions{.max_solves = 0}})
        EXPECT_THROW(t_map_scheme(problem.source, problem.target, options), Error);
    EXPECT_THROW(t_map_scheme(problem.source, SlidingStart{}), Error);
    EXPECT_THROW(t_map_scheme(problem.source, circles_target({})), Error);
    TMapSchemeOptions options;
    options.progress = [](int solve, const TMapSolve&) { return solve < 3; };
    try {
        t_map_scheme(problem.source, problem.target, options, problem.loops);
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.cause(), Cause::cancelled);
    }
}

}  // namespace
}  // namespace beltrami
