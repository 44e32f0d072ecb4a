#include <gtest/gtest.h>

#include <cmath>

#include <beltrami/base/error.h>
#include <beltrami/flow/beltrami_flow.h>
#include <beltrami/mesh/planar.h>

#include "support/onto.h"

namespace beltrami {
namespace {

using test::circles_target;
using test::disk_with_holes;

Correspondence loops_in_order(int loops) {
    Correspondence wanted;
    for (int l = 0; l < loops; ++l) wanted.loops.push_back({l, l});
    return wanted;
}

/// μ of the affine stretch x + iy → ax + iy in every triangle.
Eigen::VectorXcd constant(const Surface& source, Complex mu) {
    return Eigen::VectorXcd::Constant(source.operators.sample_count(), mu);
}

std::vector<Mark> corners_marked(const Surface& source, double a, double b) {
    const Eigen::VectorXcd z = planar_coordinates(source.mesh);
    const std::array<Complex, 4> corners{Complex(0, 0), Complex(a, 0), Complex(a, 1), Complex(0, 1)};
    const std::array<double, 4> places{0, b, b + 1, 2 * b + 1};
    std::vector<Mark> marks;
    for (int c = 0; c < 4; ++c)
        for (const int v : source.topology.boundary_loops[0])
            if (std::abs(z[v] - corners[c]) < 1e-12) marks.push_back({v, 0, places[c]});
    return marks;
}

TEST(BeltramiFlow, FindsTheAffineMapOfARectangle) {
    const Surface source(polygon_domain({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {}, {.edge_length = 0.1}));
    const double b = 1.7;
    Correspondence start;
    start.marks = corners_marked(source, 1, b);
    const TargetDomain target = target_domain(TargetCurve::polygon({{0, 0}, {b, 0}, {b, 1}, {0, 1}}));
    const FlowMap result = beltrami_flow(source, target, constant(source, (b - 1) / (b + 1)), {}, start);
    EXPECT_EQ(result.termination, Termination::converged);
    EXPECT_TRUE(result.one_to_one());
    EXPECT_TRUE(result.fits);
    EXPECT_LT(result.error.sup, 1e-8);
    const Eigen::VectorXcd z = planar_coordinates(source.mesh);
    for (Eigen::Index v = 0; v < z.size(); ++v)
        EXPECT_LT(std::abs(result.map[v] - Complex(b * z[v].real(), z[v].imag())), 1e-8);
}

TEST(BeltramiFlow, SaysThatTheCoefficientBelongsToAnotherRectangle) {
    const Surface source(polygon_domain({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {}, {.edge_length = 0.1}));
    const double b = 1.7;
    Correspondence start;
    start.marks = corners_marked(source, 1, b);
    const TargetDomain target = target_domain(TargetCurve::polygon({{0, 0}, {b, 0}, {b, 1}, {0, 1}}));
    const FlowMap result = beltrami_flow(source, target, constant(source, 0), {}, start);
    EXPECT_FALSE(result.fits);
    EXPECT_FALSE(result.warnings.empty());
    // The least-squares map is the affine one as well, and all of its residual is misfit.
    EXPECT_NEAR(result.error.residual, (b - 1) / (b + 1), 1e-8);
    EXPECT_NEAR(result.error.misfit, result.error.residual, 1e-8);
    EXPECT_NEAR(result.error.l2, (b - 1) / (b + 1), 1e-8);
}

/// The map z|z|^(α−1), which takes the ring of inner radius r to that of r^α; μ = (α−1)/(α+1) z/z̄.
TEST(BeltramiFlow, FindsTheRadialStretchOfARing) {
    const double inner = 0.4, alpha = 1.6;
    double last = 0;
    for (const double h : {0.08, 0.04, 0.02}) {
        const Surface source(disk_with_holes({{0, 0, inner}}, h));
        const Eigen::VectorXcd z = planar_coordinates(source.mesh);
        Eigen::VectorXcd mu(source.operators.sample_count());
        for (int s = 0; s < mu.size(); ++s) {
            Complex middle = 0;
            for (const int v : source.operators.stencil(s)) middle += z[v] / 3.0;
            mu[s] = (alpha - 1) / (alpha + 1) * middle / std::conj(middle);
        }
        const FlowMap result = beltrami_flow(source, circles_target({{0, 0, std::pow(inner, alpha)}}), mu);
        EXPECT_EQ(result.termination, Termination::converged);
        EXPECT_TRUE(result.one_to_one());
        EXPECT_TRUE(result.fits);
        // Up to the rotation that the held vertex fixes.
        Complex turn = 0;
        double worst = 0;
        for (Eigen::Index v = 0; v < z.size(); ++v) turn += result.map[v] * std::conj(z[v]);
        turn /= std::abs(turn);
        for (Eigen::Index v = 0; v < z.size(); ++v)
            worst = std::max(worst, std::abs(result.map[v] - turn * z[v] * std::pow(std::abs(z[v]), alpha - 1)));
        if (last > 0) {
            EXPECT_GT(std::log2(last / worst), 1.6);
        }
        last = worst;
    }
    EXPECT_LT(last, 1e-4);
}

TEST(BeltramiFlow, TellsRingsOfOtherModuliAtAnySize) {
    for (const double h : {0.12, 0.06, 0.03}) {
        const Surface source(disk_with_holes({{0, 0, 0.5}}, h));
        const Eigen::VectorXcd none = constant(source, 0);
        EXPECT_TRUE(beltrami_flow(source, circles_target({{0, 0, 0.5}}), none).fits) << h;
        // Another modulus by 5 %: |μ| is .024.
        const double other = std::exp(1.05 * std::log(0.5));
        EXPECT_FALSE(beltrami_flow(source, circles_target({{0, 0, other}}), none).fits) << h;
    }
}

/// A map is the one with its own coefficient.
TEST(BeltramiFlow, ReturnsToAMapFromItsOwnCoefficient) {
    const Surface source(disk_with_holes({{-0.4, 0.1, 0.2}, {0.35, 0, 0.25}}, 0.12));
    const TargetDomain target = circles_target({{-0.5, -0.2, 0.15}, {0.3, 0.3, 0.3}});
    FlowStartOptions turned;
    turned.start_turns = {0.2, 0.4, -0.3};
    const Eigen::VectorXcd given = flow_start(source, target, loops_in_order(3), turned).map;
    const Eigen::VectorXcd mu = beltrami_coefficient(source.operators, given);
    ASSERT_LT(mu.cwiseAbs().maxCoeff(), 1);
    for (const double step : {1.0, 0.5}) {
        FlowOptions options;
        options.step = step;
        options.max_iterations = 100;
        const FlowMap result = beltrami_flow(source, target, mu, options, loops_in_order(3));
        EXPECT_EQ(result.termination, Termination::converged);
        EXPECT_LT((result.map - given).cwiseAbs().maxCoeff(), 1e-8);
        EXPECT_LT(result.error.sup, 1e-7);
        EXPECT_TRUE(result.fits);
        for (const LoopOnto& loop : result.loops) {
            EXPECT_EQ(loop.loop, loop.curve);
            EXPECT_GT(loop.area_ratio, 0.9);
        }
        EXPECT_EQ(static_cast<int>(result.history.size()), result.iterations);
    }
}

TEST(BeltramiFlow, StartsFromAGivenMap) {
    const Surface source(disk_with_holes({{-0.4, 0.1, 0.2}, {0.35, 0, 0.25}}, 0.12));
    const TargetDomain target = circles_target({{-0.5, -0.2, 0.15}, {0.3, 0.3, 0.3}});
    const SlidingStart own = flow_start(source, target, loops_in_order(3));
    const SlidingStart given = flow_start(source, target, own.map);
    EXPECT_EQ(given.curves, own.curves);
    EXPECT_LT((given.map - own.map).cwiseAbs().maxCoeff(), 1e-12);
    const Eigen::VectorXcd mu = constant(source, Complex(0.1, 0.05));
    const FlowMap a = beltrami_flow(source, mu, own), b = beltrami_flow(source, mu, given);
    EXPECT_LT((a.map - b.map).cwiseAbs().maxCoeff(), 1e-8);
}

/// The same flow on the mesh laid into space: μ in the frames of the faces.
TEST(BeltramiFlow, IsTheSameInAnyFrame) {
    const Mesh flat = disk_with_holes({{-0.4, 0.1, 0.2}, {0.35, 0, 0.25}}, 0.15);
    Mesh tilted = flat;
    tilted.positions.resize(flat.vertex_count(), 3);
    for (int v = 0; v < flat.vertex_count(); ++v)
        tilted.positions.row(v) << flat.positions(v, 0), 0.6 * flat.positions(v, 1), 0.8 * flat.positions(v, 1);
    const Surface plane(flat), space(tilted);
    const TargetDomain target = circles_target({{-0.5, -0.2, 0.15}, {0.3, 0.3, 0.3}});
    const SlidingStart start = flow_start(plane, target, loops_in_order(3));
    const Eigen::VectorXcd mu = beltrami_coefficient(plane.operators, start.map);
    const Eigen::VectorXcd framed = beltrami_coefficient(space.operators, start.map);
    EXPECT_GT((mu - framed).cwiseAbs().maxCoeff(), 0.01) << "the frames are to differ";
    const FlowMap a = beltrami_flow(plane, 0.5 * mu, start), b = beltrami_flow(space, 0.5 * framed, start);
    EXPECT_LT((a.map - b.map).cwiseAbs().maxCoeff(), 1e-8);
    EXPECT_NEAR(a.error.residual, b.error.residual, 1e-9);
    EXPECT_NEAR(a.error.misfit, b.error.misfit, 1e-9);
}

TEST(BeltramiFlow, ReportsEveryIterationAndStopsWhenTold) {
    const Surface source(disk_with_holes({{0, 0, 0.4}}, 0.2));
    int seen = 0;
    FlowOptions options;
    options.progress = [&](int iteration, const FlowIteration& now, const Eigen::VectorXcd& map) {
        EXPECT_EQ(iteration, ++seen);
        EXPECT_EQ(map.size(), source.mesh.vertex_count());
        EXPECT_GE(now.error.sup, now.error.l2);
        return iteration < 2;
    };
    try {
        beltrami_flow(source, circles_target({{0, 0, 0.3}}), constant(source, 0.2), options);
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.cause(), Cause::cancelled);
    }
    EXPECT_EQ(seen, 2);
}

TEST(BeltramiFlow, SaysWhatIsWrong) {
    const Surface source(disk_with_holes({{0, 0, 0.4}}, 0.2));
    const TargetDomain target = circles_target({{0, 0, 0.3}});
    const auto cause = [&](const Eigen::VectorXcd& mu, const FlowOptions& options = {}) {
        try {
            beltrami_flow(source, target, mu, options);
        } catch (const Error& error) {
            return std::pair(error.cause(), error.indices());
        }
        return std::pair(Cause::unwritable, std::vector<int>{});
    };
    Eigen::VectorXcd mu = constant(source, 0.1);
    mu[3] = 1.0;
    mu[7] = std::nan("");
    EXPECT_EQ(cause(mu), std::pair(Cause::bad_option, std::vector<int>({3, 7})));
    EXPECT_EQ(cause(Eigen::VectorXcd::Zero(3)).first, Cause::bad_option);
    for (FlowOptions options : {FlowOptions{.tolerance = 0}, FlowOptions{.max_iterations = 0}, FlowOptions{.step = 0},
                                FlowOptions{.step = 1.5}})
        EXPECT_EQ(cause(constant(source, 0), options).first, Cause::bad_option);
    const Eigen::VectorXcd z = planar_coordinates(source.mesh);
    EXPECT_THROW(flow_start(source, circles_target({}), z), Error);
    EXPECT_THROW(flow_start(source, target, Eigen::VectorXcd::Zero(2)), Error);
    EXPECT_THROW(flow_start(source, target, Eigen::VectorXcd::Zero(z.size())), Error);  // both loops on one curve
    int inside = 0;
    while (source.topology.on_boundary[inside]) ++inside;
    EXPECT_THROW(flow_start(source, target, z, {inside}), Error);
    EXPECT_THROW(beltrami_flow(source, constant(source, 0), SlidingStart{}), Error);
}

}  // namespace
}  // namespace beltrami
