// Boundary conditions that mix: closed forms, order of convergence, maps and their inverses, what is refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <beltrami/base/error.h>
#include <beltrami/charts/circle_domain_chart.h>
#include <beltrami/generate/round_domains.h>
#include <beltrami/mesh/planar.h>
#include <beltrami/meshing/planar_domains.h>
#include <beltrami/teichmuller/extremal_map.h>
#include <beltrami/teichmuller/extremal_mixed.h>
#include <beltrami/teichmuller/mixed_conditions.h>

#include "problems/mixed_problems.h"

namespace beltrami {
namespace {

using bench::MixedProblemCase;

ExtremalMap solve(const MixedProblemCase& problem) {
    return mixed_extremal_map(Surface(problem.mesh), problem.conditions);
}

/// No folds, a settled iteration, the conditions obeyed, bounds in order and within one per cent.
void expect_exact(const ExtremalMap& result) {
    EXPECT_EQ(result.termination, Termination::converged);
    EXPECT_TRUE(result.one_to_one()) << result.distortion.flipped.size() << " flipped";
    EXPECT_EQ(result.boundary_residual, 0.0);
    EXPECT_LT(result.curve_residual, 1e-12);
    EXPECT_LE(result.K_lower, result.K);
    EXPECT_LE(result.K, result.K_max);
    EXPECT_LT(result.K_upper / result.K_lower, 1.01);
    for (const Warning& warning : result.warnings) ADD_FAILURE() << warning.sentence;
}

double vertex_error(const MixedProblemCase& problem, const ExtremalMap& result) {
    return (result.map.head(problem.exact->size()) - *problem.exact).cwiseAbs().maxCoeff();
}

/// k and the order in which the map converges, at h and h/2.
void expect_order(MixedProblemCase (*make)(double, bool), double h, double k_error, double order) {
    double last = 0;
    for (const double edge : {h, h / 2}) {
        const MixedProblemCase problem = make(edge, false);
        const ExtremalMap result = solve(problem);
        expect_exact(result);
        EXPECT_LT(std::abs(result.k - *problem.exact_k), k_error * edge * edge / (h * h));
        const double error = vertex_error(problem, result);
        if (last > 0) {
            EXPECT_GT(std::log2(last / error), order);
        }
        last = error;
    }
}

TEST(Mixed, RingWithASlidingInnerCircleIsTheExactMap) {
    expect_order(bench::sliding_inner_circle, 0.08, 5e-4, 1.7);
}

TEST(Mixed, SquareWithTwoSlidingSidesIsTheExactMap) {
    expect_order(bench::two_sliding_sides, 0.08, 4e-4, 1.7);
}

TEST(Mixed, SlidingHalfCircleIsTheExactMap) {
    // Where the condition changes the map is like the distance from there, for which the mesh is graded.
    expect_order(bench::sliding_half_circle, 0.08, 4e-4, 1.7);
}

/// A map and its inverse have one k.
void expect_one_k(const ExtremalMap& there, const ExtremalMap& back) {
    expect_exact(there);
    expect_exact(back);
    EXPECT_NEAR(there.k, back.k, 5e-4);
}

TEST(Mixed, ExactMapsAndTheirInversesHaveOneK) {
    expect_one_k(solve(bench::sliding_inner_circle(0.08)), solve(bench::sliding_inner_circle(0.08, true)));
    expect_one_k(solve(bench::sliding_half_circle(0.03)), solve(bench::sliding_half_circle(0.03, true)));
}

TEST(Mixed, TwoSlidingHolesHaveOneKBothWays) {
    const ExtremalMap there = solve(bench::two_sliding_holes(0.08, false, false));
    expect_one_k(there, solve(bench::two_sliding_holes(0.08, true, false)));
    EXPECT_GT(there.start_flips, 0);
    EXPECT_NEAR(there.k, 0.3902, 5e-4);
}

TEST(Mixed, TwoSlidingHolesAndAPinHaveOneKBothWays) {
    const ExtremalMap there = solve(bench::two_sliding_holes(0.08, false, true));
    expect_one_k(there, solve(bench::two_sliding_holes(0.08, true, true)));
    EXPECT_NEAR(there.k, 0.4128, 1.5e-3);  // of h = .04; .4115 at this h
}

TEST(Mixed, PinsInASlidingDiskHaveOneKBothWays) {
    const MixedProblemCase two = bench::pins_in_sliding_disk(0.08, 2, false);
    const ExtremalMap there = solve(two);
    expect_one_k(there, solve(bench::pins_in_sliding_disk(0.08, 2, true)));
    EXPECT_NEAR(there.k, *two.exact_k, 4e-4);
    EXPECT_EQ(there.dimension, 1);
    const ExtremalMap three = solve(bench::pins_in_sliding_disk(0.08, 3, false));
    expect_one_k(three, solve(bench::pins_in_sliding_disk(0.08, 3, true)));
    EXPECT_NEAR(three.k, 0.08795, 3e-4);
    EXPECT_EQ(three.dimension, 3);
    const ExtremalMap five = solve(bench::pins_in_sliding_disk(0.08, 5, false));
    expect_one_k(five, solve(bench::pins_in_sliding_disk(0.08, 5, true)));
    EXPECT_NEAR(five.k, 0.09707, 3e-4);
    EXPECT_EQ(five.dimension, 7);
}

TEST(Mixed, PrescribedArcsHaveOneKBothWays) {
    const ExtremalMap there = solve(bench::two_prescribed_arcs(0.1, false, true));
    expect_one_k(there, solve(bench::two_prescribed_arcs(0.1, true, true)));
    EXPECT_NEAR(there.k, 0.2261, 5e-4);
}

/// The inner circle of a ring may slide only half of the way round: arcs win over what is prescribed.
TEST(Mixed, ArcsThatSlideWinOverWhatIsPrescribed) {
    MixedProblemCase problem = bench::sliding_half_circle(0.16);
    const Surface source(problem.mesh);
    const auto& loop = source.topology.boundary_loops[0];
    const Eigen::VectorXcd z = planar_coordinates(source.mesh);
    const ExtremalMap expected = mixed_extremal_map(source, problem.conditions);
    SlidingArc arc;
    for (const int v : loop) {
        if (std::abs(z[v] - 1.0) < 1e-9) arc.first = v;
        if (std::abs(z[v] + 1.0) < 1e-9) arc.last = v;
        if (z[v].imag() > 1e-12) problem.conditions.prescribed.pin(v, 7.0);  // nowhere
    }
    problem.conditions.arcs = {arc};
    const ExtremalMap result = mixed_extremal_map(source, problem.conditions);
    EXPECT_EQ(result.map, expected.map);
}

/// Turning and scaling source or image changes nothing.
TEST(Mixed, DoesNotChangeUnderSimilarities) {
    const MixedProblemCase problem = bench::two_prescribed_arcs(0.12, false, true);
    const ExtremalMap plain = solve(problem);
    MixedProblemCase moved = problem;
    const Complex a = std::polar(2.5, 1.1), b(3, -1), c = std::polar(0.4, -0.6), d(-1, 2);
    for (int v = 0; v < moved.mesh.vertex_count(); ++v) {
        const Complex z = a * Complex(problem.mesh.positions(v, 0), problem.mesh.positions(v, 1)) + b;
        moved.mesh.positions.row(v) << z.real(), z.imag();
    }
    for (Complex& image : moved.conditions.prescribed.images) image = c * image + d;
    moved.conditions.curves = {TargetCurve::circle(d, std::abs(c))};
    const ExtremalMap result = solve(moved);
    expect_exact(result);
    EXPECT_NEAR(result.k, plain.k, 1e-6);
    EXPECT_LT((result.map - (c * plain.map.array() + d).matrix()).cwiseAbs().maxCoeff(), 1e-4 * std::abs(c));
}

/// With nothing prescribed but marks it is the problem of extremal_onto.h.
TEST(Mixed, IsTheSlidingProblemWhereAllSlides) {
    const Surface source(annulus(0.5, 1, 60));
    MixedConditions conditions;
    conditions.curves = {TargetCurve::circle(0, 1), TargetCurve::circle(0, 0.3)};
    const ExtremalMap mixed = mixed_extremal_map(source, conditions);
    expect_exact(mixed);
    ExtremalOptions options;
    options.space = ExtremalOptions::Space::laurent;
    const ExtremalMap onto =
        extremal_map(source, target_domain(TargetCurve::circle(0, 1), {TargetCurve::circle(0, 0.3)}), options);
    EXPECT_EQ(mixed.dimension, 1);
    EXPECT_NEAR(mixed.k, onto.k, 1e-7);
}

/// With everything prescribed it is the problem of extremal_map.h.
TEST(Mixed, IsThePrescribedProblemWhereAllIsPrescribed) {
    const Surface source(disk(24));
    const Eigen::VectorXcd z = planar_coordinates(source.mesh);
    MixedConditions conditions;
    conditions.curves.resize(1);
    for (const int v : source.topology.boundary_loops[0]) {
        const Complex g = z[v] + 0.3 * z[v] * z[v];
        conditions.prescribed.pin(v, std::exp(0.6 * (g + 0.5 * std::conj(g))));
    }
    const ExtremalMap mixed = mixed_extremal_map(source, conditions);
    expect_exact(mixed);
    ExtremalOptions options;
    options.evening = ExtremalOptions::Evening::never;
    options.sharpen = -1;
    const ExtremalMap prescribed = extremal_map(source, conditions.prescribed, options);
    EXPECT_NEAR(mixed.k, prescribed.k, 1e-4);
}

/// A start of one's own changes the way and not the end, whether it folds or not; what is prescribed wins over it.
TEST(Mixed, GivenStartsHaveTheSameEnd) {
    const MixedProblemCase problem = bench::two_prescribed_arcs(0.12, false, true);
    const Surface source(problem.mesh);
    const ExtremalMap plain = solve(problem);
    const Eigen::VectorXcd z = planar_coordinates(source.mesh);
    ExtremalOptions options;
    options.start = plain.map;
    const ExtremalMap again = mixed_extremal_map(source, problem.conditions, options);
    expect_exact(again);
    EXPECT_EQ(again.start_flips, 0);
    EXPECT_NEAR(again.k, plain.k, 1e-6);
    // The source's own plane, turned, with a crease along which it is folded over.
    options.start = (0.9 * std::polar(1.0, 0.1) * z.array()).matrix();
    for (Complex& w : *options.start)
        if (w.real() > 0.55) w.real(1.1 - w.real());
    const ExtremalMap creased = mixed_extremal_map(source, problem.conditions, options);
    EXPECT_GT(creased.start_flips, 0);
    EXPECT_TRUE(creased.one_to_one());
    EXPECT_NEAR(creased.k, plain.k, 1e-6);
    EXPECT_EQ(creased.boundary_residual, 0.0);
    options.start = z.conjugate();
    EXPECT_THROW(mixed_extremal_map(source, problem.conditions, options), Error);  // the wrong way round
    options.start = z.head(3);
    EXPECT_THROW(mixed_extremal_map(source, problem.conditions, options), Error);
}

/// Prescribed holes take the curves nearest to their images, the others are matched beside them.
TEST(Mixed, PrescribedHolesTakeTheCurvesNearestToTheirImages) {
    // Three holes alike at the corners of a triangle: matched, they would stay where they are; one is to go to the
    // place of the next.
    const std::vector<RoundHole> holes{
        {1, std::polar(0.55, 0.0), 0.15}, {2, std::polar(0.55, 2.1), 0.15}, {3, std::polar(0.55, 4.2), 0.15}};
    std::vector<Circle> circles;
    for (const RoundHole& hole : holes) circles.push_back({{hole.centre.real(), hole.centre.imag()}, hole.radius});
    const Surface source(circle_domain({}, circles, {.edge_length = 0.08}));
    const Eigen::VectorXcd z = planar_coordinates(source.mesh);
    std::vector<TargetCurve> curves;
    for (const RoundHole& hole : holes) curves.push_back(TargetCurve::circle(hole.centre, hole.radius));
    const TargetDomain target = target_domain(TargetCurve::circle(0, 1), curves);
    int first = 0;
    for (int l = 1; l < 4; ++l)
        if (std::abs(z[source.topology.boundary_loops[l][0]] - holes[0].centre) < 0.2) first = l;
    Constraints constraints(target);
    const Complex turn = holes[1].centre / holes[0].centre;
    for (const int v : source.topology.boundary_loops[first]) constraints.prescribed.pin(v, turn * z[v]);
    const MixedConditions conditions = mixed_conditions(source, constraints);
    ASSERT_FALSE(conditions.curves[first].has_value());
    for (int l = 1; l < 4; ++l) {
        if (l == first) continue;
        const Complex at = z[source.topology.boundary_loops[l][0]] * turn;
        EXPECT_LT(std::abs(conditions.curves[l]->point(conditions.curves[l]->nearest(at)) - at), 0.02);
    }
    const ExtremalMap result = extremal_map(source, constraints);
    EXPECT_TRUE(result.one_to_one());
    EXPECT_EQ(result.boundary_residual, 0.0);
    EXPECT_LT(result.k, 0.02);  // nearly the rotation
}

/// φ has no more degrees than the rim resolves: with twelve the iteration on this dome went astray, to K below 1.
TEST(Mixed, FewRimVerticesShowFewDifferentials) {
    Mesh dome = disk(4);
    dome.positions.conservativeResize(Eigen::NoChange, 3);
    for (int v = 0; v < dome.vertex_count(); ++v)
        dome.positions(v, 2) = 3 * (1 - dome.positions.row(v).head<2>().squaredNorm());
    const Surface source(dome);
    const auto& loop = source.topology.boundary_loops[0];
    const auto n = static_cast<int>(loop.size());
    MixedConditions conditions;
    conditions.curves = {TargetCurve::circle(0, 1)};
    for (int i = 0; i <= n / 2; ++i) {
        const double t = 2 * std::numbers::pi * i / n;
        conditions.prescribed.pin(loop[i], std::polar(1.0, t + 0.6 * std::sin(t)));
    }
    const ExtremalMap result = mixed_extremal_map(source, conditions);
    EXPECT_EQ(result.termination, Termination::converged);
    EXPECT_TRUE(result.one_to_one());
    EXPECT_GE(result.K, 1);
    EXPECT_LE(result.K_lower, result.K);
    EXPECT_LT(result.distortion.mean, 0.45);
}

TEST(Mixed, RefusesWhatIsNotSaidAndWhatCannotBe) {
    const MixedProblemCase problem = bench::two_prescribed_arcs(0.2, false, false);
    const Surface source(problem.mesh);
    const auto refused = [&](MixedConditions conditions, Cause cause) {
        try {
            mixed_extremal_map(source, conditions);
            ADD_FAILURE() << "not refused";
        } catch (const Error& error) {
            EXPECT_EQ(error.cause(), cause) << error.what();
        }
    };
    MixedConditions conditions = problem.conditions;
    conditions.curves = {std::nullopt};
    refused(conditions, Cause::bad_boundary);
    conditions.curves.clear();
    refused(conditions, Cause::bad_option);
    conditions = problem.conditions;
    conditions.arcs = {{0, source.mesh.vertex_count()}};
    refused(conditions, Cause::bad_boundary);
    conditions = problem.conditions;
    conditions.curves = {TargetCurve::circle(0, 1.1)};  // the ends of arcs are off it
    refused(conditions, Cause::bad_boundary);
    conditions = problem.conditions;
    for (Complex& image : conditions.prescribed.images) image = std::conj(image);  // the wrong way round
    refused(conditions, Cause::bad_boundary);
    conditions = problem.conditions;
    conditions.outer_loop = 1;
    EXPECT_THROW(mixed_extremal_map(source, conditions), Error);
}

}  // namespace
}  // namespace beltrami
