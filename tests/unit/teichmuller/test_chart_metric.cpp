#include <beltrami/teichmuller/chart_metric.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include <beltrami/charts/boundary_values.h>
#include <beltrami/charts/round_disk.h>
#include <beltrami/generate/round_domains.h>
#include <beltrami/mesh/subdivide.h>
#include <beltrami/mesh/topology.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/solve/beltrami_solver.h>
#include <beltrami/teichmuller/extremal_map.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

/// A rough bump whose rim is coarse: few large faces in its chart.
Mesh rough_bump() {
    Mesh mesh = test::bump(1'500, 0.8);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> noise(-0.02, 0.02);
    for (int v = 0; v < mesh.vertex_count(); ++v) mesh.positions(v, 2) += noise(random);
    return mesh;
}

Eigen::VectorXcd some_map(const Eigen::VectorXcd& z) {
    return z.unaryExpr([](Complex w) { return w + 0.2 * std::conj(w) + 0.1 * w * w; });
}

TEST(ChartMetric, OperatorsAreThoseOfThePlane) {
    const Surface source(rough_bump());
    const Chart chart = round_disk_chart(source);
    const ChartMetric metric(source, chart);
    ASSERT_EQ(chart.excluded_faces, 0);
    const Operators plane = operators(metric.plane().mesh);
    const Eigen::VectorXcd f = some_map(chart.vertices);
    for (int s = 0; s < plane.sample_count(); ++s) {
        EXPECT_NEAR(metric.plane().operators.weights[s], plane.weights[s], 1e-12);
        for (int i : {0, 1})
            EXPECT_LT(std::abs(metric.plane().operators.derivatives(s, f)[i] - plane.derivatives(s, f)[i]), 1e-10);
    }
    const Eigen::VectorXcd identity = beltrami_coefficient(metric.plane().operators, chart.vertices);
    EXPECT_LT(identity.cwiseAbs().maxCoeff(), 1e-12);
    const Eigen::VectorXcd own = beltrami_coefficient(source.operators, chart.vertices);
    EXPECT_NEAR(metric.chart_mean(), mu_statistics(own, source.operators.weights).mean, 1e-12);
    EXPECT_GT(metric.chart_mean(), 0.005);
}

TEST(ChartMetric, QuadsTakeTheJacobianOfTheirGaussPoints) {
    Mesh mesh = test::quad_disk(5);
    const Positions flat = mesh.positions;
    mesh.positions.resize(flat.rows(), 3);
    for (Eigen::Index v = 0; v < flat.rows(); ++v)
        mesh.positions.row(v) << flat(v, 0), flat(v, 1), 0.3 * flat(v, 0) * flat(v, 1);
    const Surface source(std::move(mesh));
    const ChartMetric metric(source, round_disk_chart(source));
    const Operators plane = operators(metric.plane().mesh);
    const Eigen::VectorXcd f = some_map(metric.chart().vertices);
    const Eigen::VectorXcd difference =
        beltrami_coefficient(plane, f) - beltrami_coefficient(metric.plane().operators, f);
    EXPECT_LT(difference.cwiseAbs().maxCoeff(), 1e-11);
}

TEST(ChartMetric, AStepOnTheSurfaceIsTheStepOfThePlane) {
    const Surface source(rough_bump());
    const ChartMetric metric(source, round_disk_chart(source));
    const Surface plane(metric.plane().mesh);
    BoundaryCondition boundary;
    for (const int v : source.topology.boundary_loops[0])
        boundary.pin(v, test::exact_composition(metric.chart().vertices[v]));
    Eigen::VectorXcd nu(source.operators.sample_count());
    for (int s = 0; s < nu.size(); ++s) nu[s] = std::polar(0.4, 0.01 * s);
    const auto solve = [&](const Surface& on, const Eigen::VectorXcd& coefficient) {
        BeltramiSolver solver(on, freedoms(boundary, on), 1);
        solver.factorize(coefficient);
        return solver.solve(prescribed_values(boundary, on));
    };
    const Eigen::VectorXcd difference = solve(plane, nu) - solve(source, metric.coefficient_on_surface(nu));
    EXPECT_LT(difference.cwiseAbs().maxCoeff(), 1e-10);
}

TEST(ChartMetric, WhatTheChartTurnsOverKeepsItsShape) {
    const Surface source(rough_bump());
    Eigen::VectorXcd vertices = round_disk_chart(source).vertices;
    vertices[100] += 2.0 * (vertices[101] - vertices[100]);  // past its neighbour
    const Chart chart = make_chart(source, std::move(vertices), false);
    const ChartMetric metric(source, chart);
    const Eigen::VectorXcd f = some_map(chart.vertices);
    const Eigen::VectorXcd plane = beltrami_coefficient(metric.plane().operators, f),
                           surface = beltrami_coefficient(source.operators, f);
    int turned = 0;
    for (int s = 0; s < plane.size(); ++s) {
        EXPECT_GT(metric.plane().operators.weights[s], 0);
        EXPECT_EQ(metric.chart().excluded[s] != 0, unseen(source.operators, s, chart));
        if (!metric.chart().excluded[s]) continue;
        ++turned;
        EXPECT_NEAR(std::abs(plane[s]), std::abs(surface[s]), 1e-12);
    }
    EXPECT_GT(turned, 0);
    EXPECT_EQ(metric.chart().excluded_faces, turned);
}

/// A surface's own chart is extremal for its boundary values, with K = 1: what is found instead is noise.
TEST(ChartMetric, TheChartItselfHasNoDilatation) {
    const Surface source(rough_bump());
    const Chart chart = round_disk_chart(source);
    BoundaryCondition boundary;
    for (const int v : source.topology.boundary_loops[0]) boundary.pin(v, chart.vertices[v]);
    ExtremalOptions in_plane;
    in_plane.chart_metric = true;
    const ExtremalMap result = extremal_map(source, boundary, in_plane);
    EXPECT_LT(result.k, 1e-6);
    ASSERT_TRUE(result.in_chart);
    EXPECT_LT(result.in_chart->mean, 1e-6);
    EXPECT_NEAR(result.distortion.mean, result.in_chart->chart_mean, 1e-6);
    ExtremalOptions on_surface;
    on_surface.chart_metric = false;
    const ExtremalMap surface = extremal_map(source, boundary, on_surface);
    EXPECT_GT(surface.k, 1e-3);
    EXPECT_FALSE(surface.in_chart);
}

/// Half of the rim slides: fewer conditions than where all of it is prescribed, so no larger K.
TEST(ChartMetric, MixedConditionsAreSolvedThere) {
    const Surface source(rough_bump());
    const std::vector<int>& loop = source.topology.boundary_loops[0];
    const BoundaryCondition boundary = boundary_to_disk(source, 0.5);
    Constraints constraints(boundary);
    constraints.slide(loop[3], loop[loop.size() / 2], TargetCurve::circle(0, 1));
    const ExtremalMap result = extremal_map(source, constraints), prescribed = extremal_map(source, boundary);
    ASSERT_TRUE(result.in_chart);
    EXPECT_TRUE(result.one_to_one());
    EXPECT_EQ(result.termination, Termination::converged);
    EXPECT_LT(result.K, 1.01 * prescribed.K);
    EXPECT_LT(result.K, 1.03 * result.K_lower);
    EXPECT_LT(result.curve_residual, 1e-12);
    const Distortion measured = distortion(source.operators, result.map);
    EXPECT_EQ(result.distortion.mean, measured.mean);
    EXPECT_EQ(result.K_max, measured.K_max());
    ExtremalOptions on_surface;
    on_surface.chart_metric = false;
    EXPECT_FALSE(extremal_map(source, constraints, on_surface).in_chart);
}

/// Noise decides which metric is taken unless the options do: that of a rough surface, not that of a smooth one.
TEST(ChartMetric, IsTakenWhereTheSurfaceIsRough) {
    for (const bool rough : {true, false}) {
        const Surface source(rough ? rough_bump() : test::bump(3'000));
        const ExtremalMap result = extremal_map(source, boundary_to_disk(source, 0.05));
        EXPECT_EQ(result.in_chart.has_value(), rough);
        EXPECT_TRUE(result.one_to_one());
    }
}

/// A cap of the paraboloid z = r² over the unit disk; its chart in closed form.
struct Paraboloid {
    Mesh mesh;
    Eigen::VectorXcd chart;
};
Paraboloid paraboloid(int triangles) {
    Paraboloid result{disk(disk_rings_for_triangles(triangles)), {}};
    const Positions flat = result.mesh.positions;
    result.mesh.positions.resize(flat.rows(), 3);
    result.chart.resize(flat.rows());
    // d log ρ = √(1 + 4r²) dr/r.
    const auto log_rho = [](double r) {
        const double root = std::sqrt(1 + 4 * r * r);
        return root + std::log(r) - std::log(1 + root);
    };
    for (Eigen::Index v = 0; v < flat.rows(); ++v) {
        const double x = flat(v, 0), y = flat(v, 1), r = std::hypot(x, y);
        result.mesh.positions.row(v) << x, y, r * r;
        result.chart[v] = r > 0 ? Complex(x, y) / r * std::exp(log_rho(r) - log_rho(1)) : 0.0;
    }
    return result;
}

TEST(ChartMetric, AnAffineMapOfAParaboloidIsFoundMoreExactly) {
    const auto [mesh, chart] = paraboloid(2'000);
    const Surface source(mesh);
    const auto affine = [](Complex z) { return z + 0.5 * std::conj(z); };  // K* = 3
    BoundaryCondition boundary;
    for (const int v : source.topology.boundary_loops[0]) boundary.pin(v, affine(chart[v]));
    const Eigen::VectorXcd exact = chart.unaryExpr(affine);
    const auto errors = [&](bool chart_metric) {
        ExtremalOptions options;
        options.chart_metric = chart_metric;
        const ExtremalMap result = extremal_map(source, boundary, options);
        EXPECT_TRUE(result.one_to_one());
        EXPECT_EQ(result.in_chart.has_value(), chart_metric);
        EXPECT_LE(result.K_lower, 3 * (1 + 1e-3));
        return std::array{std::abs(result.K - 3), 3 - result.K_lower, (result.map - exact).cwiseAbs().maxCoeff()};
    };
    const auto in_chart = errors(true), on_surface = errors(false);
    EXPECT_LT(in_chart[0], 0.005);
    EXPECT_LT(in_chart[1], 0.012);
    for (const int i : {0, 1, 2}) EXPECT_LT(in_chart[i], on_surface[i]) << i;
}

/// A scan that was coarse before it was divided: teeth of so many edges all along its rim.
TEST(ChartMetric, AnOutlineOfTeethGetsNoFunctionsForEach) {
    Mesh mesh = disk(7);
    const std::vector<int> rim = topology(mesh).boundary_loops[0];
    for (std::size_t i = 0; i < rim.size(); ++i) mesh.positions.row(rim[i]) *= i % 2 ? 0.92 : 1.08;
    for (int division = 0; division < 3; ++division) mesh = midpoint_subdivide(mesh).mesh;
    const Positions flat = mesh.positions;
    mesh.positions.resize(flat.rows(), 3);
    for (Eigen::Index v = 0; v < flat.rows(); ++v)
        mesh.positions.row(v) << flat(v, 0), flat(v, 1), 0.3 * std::exp(-3 * flat.row(v).squaredNorm());
    const Surface source(std::move(mesh));
    ExtremalOptions options;
    options.chart_metric = true;
    const ExtremalMap map = extremal_map(source, boundary_to_disk(source, 0.5), options);
    EXPECT_TRUE(map.distortion.flipped.empty());
    ASSERT_TRUE(map.in_chart);
    // Poles at its 42 corners would be 300 functions and more.
    EXPECT_GT(map.corners.size(), 24u);
    EXPECT_LE(map.history.back().functions, map.in_chart->degree + 1);
    EXPECT_LT(map.K, 1.1 * map.K_lower);
}

/// Smooth data have degree 40 at most; what a rim that is jagged edge by edge asks for beyond that is there.
TEST(ChartMetric, AJaggedRimIsGivenADegreeThatSmoothDataDoNotAskFor) {
    Mesh mesh = test::bump(60'000, 0.5);
    const std::vector<int> rim = topology(mesh).boundary_loops[0];
    std::mt19937 random(3);
    std::uniform_real_distribution<double> noise(-0.06, 0.06);
    for (const int v : rim) mesh.positions.row(v) *= 1 + noise(random);
    const Surface source(std::move(mesh));
    ExtremalOptions options;
    options.chart_metric = true;
    const ExtremalMap map = extremal_map(source, boundary_to_disk(source, 0.5), options);
    EXPECT_TRUE(map.distortion.flipped.empty());
    ASSERT_TRUE(map.in_chart);
    EXPECT_GT(map.in_chart->degree, 40);
    EXPECT_EQ(map.history.back().functions, map.in_chart->degree + 1);
    // The last φ of the smooth degree is where it begins.
    const auto before = std::find_if(map.history.rbegin(), map.history.rend(),
                                     [](const Iteration& iteration) { return iteration.functions == 41; });
    ASSERT_NE(before, map.history.rend());
    EXPECT_GT(map.history.back().k, before->k);
}

}  // namespace
}  // namespace beltrami
