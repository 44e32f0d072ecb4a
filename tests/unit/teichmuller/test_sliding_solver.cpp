// ExtremalSolver while boundaries slide: pins are dragged, prescribed values move.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include <beltrami/base/error.h>
#include <beltrami/charts/fold_free_disk.h>
#include <beltrami/charts/round_disk.h>
#include <beltrami/teichmuller/extremal_map.h>
#include <beltrami/teichmuller/extremal_solver.h>

#include "problems/mixed_problems.h"
#include "support/cause_of.h"
#include "support/extremal.h"

namespace beltrami {
namespace {

using test::expect_sound;

/// Constraints of which the images of prescribed vertices follow a parameter, straight from one place to another.
struct Dragged {
    Surface source;
    Constraints constraints;
    std::vector<Complex> from, to;

    std::vector<Complex> images(double t) const {
        std::vector<Complex> result;
        for (std::size_t i = 0; i < from.size(); ++i) result.push_back((1 - t) * from[i] + t * to[i]);
        return result;
    }
    Constraints at(double t) const {
        Constraints result = constraints;
        result.prescribed.images = images(t);
        return result;
    }
};

/// The images of a problem, and vertices where they are in the source to begin with.
Dragged dragged(const bench::MixedProblemCase& problem, TargetDomain target) {
    Dragged result{Surface(problem.mesh), Constraints(std::move(target)), {}, problem.conditions.prescribed.images};
    result.constraints.prescribed = problem.conditions.prescribed;
    for (const int v : problem.conditions.prescribed.vertices) result.from.push_back(bench::place(problem.mesh, v));
    return result;
}

Dragged pins_in_a_disk() {
    return dragged(bench::pins_in_sliding_disk(0.12, 3, false), {TargetCurve::circle(0, 1), {}});
}
/// The outer circle is prescribed, the inner one slides: K = 2 in the end.
Dragged ring() {
    return dragged(bench::sliding_inner_circle(0.1),
                   {TargetCurve::circle(0, 1), {TargetCurve::circle(0, 0.25).reversed()}});
}
/// Arcs of the circle are prescribed and move along it.
Dragged arcs() {
    Dragged result = dragged(bench::two_prescribed_arcs(0.12, false, false), {TargetCurve::circle(0, 1), {}});
    result.constraints.prescribed = {};
    for (const int v : bench::two_prescribed_arcs(0.12, false, false).conditions.prescribed.vertices)
        result.constraints.prescribed.pin(v, 0);
    return result;
}
/// Along the circle instead of straight.
std::vector<Complex> along_the_circle(const Dragged& problem, double t) {
    std::vector<Complex> result;
    for (std::size_t i = 0; i < problem.from.size(); ++i)
        result.push_back(problem.from[i] * std::polar(1.0, t * std::arg(problem.to[i] / problem.from[i])));
    return result;
}

/// Every vertex where it is told to be, sliding ones on their curve, no folds.
void expect_obeyed(const Constraints& constraints, const std::vector<Complex>& images,
                   const ExtremalSolver::Update& now, const Surface& source) {
    EXPECT_EQ(now.flipped, 0);
    for (std::size_t i = 0; i < images.size(); ++i) EXPECT_EQ(now.map[constraints.prescribed.vertices[i]], images[i]);
    std::vector<char> is_prescribed(source.mesh.vertex_count(), 0);
    for (const int v : constraints.prescribed.vertices) is_prescribed[v] = 1;
    for (std::size_t l = 0; l < source.topology.boundary_loops.size(); ++l) {
        const double radius = constraints.domain()->curve(static_cast<int>(l)).radius();
        for (const int v : source.topology.boundary_loops[l])
            if (!is_prescribed[v]) {
                EXPECT_NEAR(std::abs(now.map[v]), radius, 1e-12);
            }
    }
}

/// Followed in steps, the map is that of a fresh solve.
void expect_followed(const Dragged& problem, const std::function<std::vector<Complex>(double)>& images, double first,
                     double map_tolerance) {
    Constraints constraints = problem.constraints;
    constraints.prescribed.images = images(first);
    ExtremalSolver solver(problem.source, constraints);
    expect_sound(solver.solve());
    for (double t = first + 0.1; t < 1.05; t += 0.1) {
        const ExtremalSolver::Update now = solver.update(images(t), 4);
        expect_obeyed(problem.constraints, images(t), now, problem.source);
        constraints.prescribed.images = images(t);
        EXPECT_NEAR(now.k, extremal_map(problem.source, constraints).k, 1e-3);
    }
    const ExtremalMap followed = solver.solve();
    constraints.prescribed.images = images(1);
    const ExtremalMap fresh = extremal_map(problem.source, constraints);
    expect_sound(followed);
    EXPECT_EQ(followed.termination, Termination::converged);
    EXPECT_NEAR(followed.k, fresh.k, 1e-6);
    EXPECT_LT((followed.map - fresh.map).cwiseAbs().maxCoeff(), map_tolerance);
    EXPECT_EQ(followed.dimension, fresh.dimension);
    EXPECT_LT(followed.curve_residual, 1e-12);
}

TEST(SlidingSolver, PinsAreDraggedWhileTheBoundarySlides) {
    const Dragged problem = pins_in_a_disk();
    expect_followed(
        problem, [&](double t) { return problem.images(t); }, 0.2, 1e-4);
}

TEST(SlidingSolver, APrescribedLoopMovesWhileAnotherSlides) {
    const Dragged problem = ring();
    expect_followed(
        problem, [&](double t) { return problem.images(t); }, 0.5, 1e-4);
}

TEST(SlidingSolver, PrescribedArcsMoveAlongTheCurveOfTheOthers) {
    const Dragged problem = arcs();
    expect_followed(
        problem, [&](double t) { return along_the_circle(problem, t); }, 0.2, 1e-4);
}

TEST(SlidingSolver, SolvesAsExtremalMapDoes) {
    const Dragged problem = ring();
    const ExtremalMap one = extremal_map(problem.source, problem.at(1));
    ExtremalSolver solver(problem.source, problem.at(1));
    const ExtremalMap other = solver.solve();
    EXPECT_EQ(one.map, other.map);
    EXPECT_EQ(one.k, other.k);
    EXPECT_NEAR(one.k, 1.0 / 3, 1e-3);
    const ExtremalMap again = solver.solve();
    EXPECT_LE(again.iterations, 4);
    EXPECT_NEAR(again.k, other.k, 1e-7);
    EXPECT_LT((again.map - other.map).cwiseAbs().maxCoeff(), 1e-4);
}

TEST(SlidingSolver, MayBeUpdatedBeforeItHasSolved) {
    const Dragged problem = pins_in_a_disk();
    ExtremalSolver solver(problem.source, problem.at(0.1));
    expect_obeyed(problem.constraints, problem.images(1), solver.update(problem.images(1), 4), problem.source);
    EXPECT_NEAR(solver.solve().k, extremal_map(problem.source, problem.at(1)).k, 1e-6);
}

TEST(SlidingSolver, GoesOnAfterARefusedUpdate) {
    const Dragged problem = pins_in_a_disk();
    ExtremalSolver solver(problem.source, problem.at(0.5));
    const ExtremalMap before = solver.solve();
    const std::vector<Complex> good = problem.images(0.5);
    const auto refused = [&](std::vector<Complex> images) {
        EXPECT_EQ(test::cause_of([&] { solver.update(images); }), Cause::bad_boundary);
    };
    std::vector<Complex> images = good;
    images[1] = Complex(1.2, 0.3);  // outside
    refused(images);
    images[1] = Complex(0.6, 0.8);  // on the circle
    refused(images);
    images[1] = images[0];  // two at one place
    refused(images);
    images = good;
    images.pop_back();
    refused(images);
    EXPECT_EQ(test::cause_of([&] { solver.update(good, 0); }), Cause::bad_option);
    const ExtremalMap after = solver.solve();
    expect_sound(after);
    EXPECT_NEAR(after.k, before.k, 1e-7);
}

TEST(SlidingSolver, RefusesMovesOfBoundaryValuesThatNoMapHas) {
    // Arcs whose ends leave the curve, or come in another order.
    const Dragged problem = arcs();
    Constraints constraints = problem.constraints;
    constraints.prescribed.images = along_the_circle(problem, 0.3);
    ExtremalSolver solver(problem.source, constraints);
    const double k = solver.solve().k;
    std::vector<Complex> wrong = along_the_circle(problem, 0.5);
    for (Complex& image : wrong) image *= 1.05;
    EXPECT_EQ(test::cause_of([&] { solver.update(wrong); }), Cause::bad_boundary);
    wrong = along_the_circle(problem, 0.5);
    for (Complex& image : wrong) image = std::conj(image);
    EXPECT_EQ(test::cause_of([&] { solver.update(wrong); }), Cause::bad_boundary);
    EXPECT_NEAR(solver.solve().k, k, 1e-7);
    // An outer loop that runs through the hole's curve, or leaves it outside.
    const Dragged outer = ring();
    ExtremalSolver around(outer.source, outer.at(1));
    wrong = outer.images(1);
    for (Complex& image : wrong) image += Complex(0.9, 0);
    EXPECT_EQ(test::cause_of([&] { around.update(wrong); }), Cause::bad_boundary);
    for (Complex& image : wrong) image += Complex(5, 0);
    EXPECT_EQ(test::cause_of([&] { around.update(wrong); }), Cause::bad_boundary);
}

TEST(SlidingSolver, RefusesPinsOutsideTheTargetAtOnce) {
    const Dragged problem = pins_in_a_disk();
    Constraints constraints = problem.at(0);
    constraints.prescribed.images[2] = Complex(0, -2);
    EXPECT_EQ(test::cause_of([&] { ExtremalSolver(problem.source, constraints); }), Cause::bad_boundary);
}

TEST(SlidingSolver, EveningKeepsWhatSlidesAndLowersTheSpread) {
    const Dragged problem = pins_in_a_disk();
    ExtremalOptions options;
    options.evening = ExtremalOptions::Evening::always;
    const ExtremalMap plain = extremal_map(problem.source, problem.at(1));
    const ExtremalMap even = extremal_map(problem.source, problem.at(1), options);
    expect_sound(even);
    EXPECT_TRUE(even.evened);
    EXPECT_FALSE(plain.evened);
    EXPECT_LT(even.distortion.standard_deviation, 0.7 * plain.distortion.standard_deviation);
    EXPECT_NEAR(even.k, plain.k, 1e-3);
    for (const int v : problem.source.topology.boundary_loops[0]) EXPECT_EQ(even.map[v], plain.map[v]);
}

/// A strip ten times as long as it is wide, whose ends a conformal map crowds to 1e-6 of the circle.
Surface strip() {
    constexpr int kLong = 40, kWide = 4;
    Mesh mesh;
    mesh.positions.resize((kLong + 1) * (kWide + 1), 2);
    for (int j = 0; j <= kWide; ++j)
        for (int i = 0; i <= kLong; ++i) {
            const bool inner = i > 0 && i < kLong && j > 0 && j < kWide;
            const double dx = inner ? 0.25 * std::sin(12.9898 * i + 78.233 * j) : 0,
                         dy = inner ? 0.25 * std::cos(39.425 * i - 17.31 * j) : 0;
            mesh.positions.row(j * (kLong + 1) + i) << 10 * (i + dx) / kLong, (j + dy) / kWide;
        }
    for (int j = 0; j < kWide; ++j)
        for (int i = 0; i < kLong; ++i) {
            const int a = j * (kLong + 1) + i, c = a + kLong + 2;
            mesh.faces.add({a, a + 1, c});
            mesh.faces.add({a, c, c - 1});
        }
    return Surface(mesh);
}

TEST(SlidingSolver, OpensFoldsOfAConformalMap) {
    const Surface source = strip();
    const Constraints onto(TargetDomain{TargetCurve::circle({1, 2}, 0.5), {}});
    ExtremalOptions as_it_is;
    as_it_is.remove_folds = false;
    const ExtremalMap folded = extremal_map(source, onto, as_it_is), opened = extremal_map(source, onto);
    ASSERT_FALSE(folded.distortion.flipped.empty());
    EXPECT_FALSE(folded.folds_removed);
    EXPECT_TRUE(opened.folds_removed);
    EXPECT_TRUE(opened.distortion.flipped.empty());
    EXPECT_EQ(opened.termination, Termination::converged);
    EXPECT_EQ(opened.K, 1);
    EXPECT_LT(opened.K_max, 20);
    EXPECT_LT(opened.distortion.mean, 0.35);
    EXPECT_LT(opened.curve_residual, 1e-12);
    // The rim goes round the circle once, in its order.
    const Topology shape = opened.split ? topology(opened.split->mesh) : source.topology;
    const std::vector<int>& loop = shape.boundary_loops[0];
    double turn = 0;
    for (std::size_t i = 0; i < loop.size(); ++i) {
        const Complex here = opened.map[loop[i]] - Complex(1, 2),
                      next = opened.map[loop[(i + 1) % loop.size()]] - Complex(1, 2);
        EXPECT_GT(std::arg(next / here), 0) << i;
        turn += std::arg(next / here);
    }
    EXPECT_NEAR(turn, 2 * std::numbers::pi, 1e-9);
    // The surface's chart without folds is a conformal map of the same boundary, and no better.
    const Surface domain = opened.split ? surface_of(opened.split->mesh, opened.split->metric) : source;
    const FoldFreeDisk flat = fold_free_disk(domain, round_disk_chart(domain).vertices);
    ASSERT_TRUE(flat.fold_free);
    EXPECT_LE(opened.distortion.mean, distortion(domain.operators, flat.map).mean + 1e-9);
}

}  // namespace
}  // namespace beltrami
