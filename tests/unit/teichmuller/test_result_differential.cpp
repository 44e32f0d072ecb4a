// Every extremal map carries its φ.
#include <string>

#include <gtest/gtest.h>

#include <beltrami/generate/grids.h>
#include <beltrami/teichmuller/extremal_mixed.h>

#include "problems/mixed_problems.h"
#include "support/extremal.h"
#include "support/onto.h"

namespace beltrami {
namespace {

/// The surface that was mapped.
Surface mapped(const Mesh& source, const ExtremalMap& result) {
    return result.split ? surface_of(result.split->mesh, result.split->metric) : Surface(source);
}

double bound(const ExtremalMap& result, const char* kind) {
    for (const Bound& of : result.bounds)
        if (std::string(to_string(of.kind)) == kind) return of.K;
    return 0;
}

/// ‖φ of the differential − φ of the c-step‖/‖φ‖, by area.
double difference(const Surface& source, const ExtremalMap& result) {
    const Eigen::VectorXcd at = result.differential.at_samples(source);
    double error = 0, size = 0;
    for (Eigen::Index s = 0; s < at.size(); ++s) {
        error += source.operators.weights[s] * std::norm(at[s] - result.phi[s]);
        size += source.operators.weights[s] * std::norm(result.phi[s]);
    }
    return std::sqrt(error / size);
}

/// Its values are those of the c-step, and the Reich-Strebel integrals of it and the map are those of the record.
void expect_carried(const Mesh& mesh, const ExtremalMap& result, double of_values) {
    const Surface source = mapped(mesh, result);
    ASSERT_FALSE(result.differential.zero());
    EXPECT_LT(difference(source, result), of_values);
    const ReichStrebel found = reich_strebel(source, result.differential, result.distortion.mu);
    ASSERT_TRUE(found.valid);
    EXPECT_EQ(std::max(found.lower, 1.0), bound(result, "reich_strebel"));
}

TEST(ResultDifferential, OfPrescribedValues) {
    ExtremalOptions options;
    options.sharpen = -1;
    options.evening = ExtremalOptions::Evening::never;
    for (const char* name : {"exact_composition", "four_points", "ring", "moved_hole"}) {
        SCOPED_TRACE(name);
        const test::Solved solved = test::solve(bench::named_problem(name), options);
        expect_carried(solved.problem.mesh, solved.result, 1e-10);
        EXPECT_FALSE(solved.result.differential.tabulated());
    }
}

TEST(ResultDifferential, OfADiskInThePlaneOfItsChartIsPulledBack) {
    const Mesh mesh = test::bump(2000);
    const Surface source(mesh);
    BoundaryCondition boundary;
    for (const int v : source.topology.boundary_loops[0]) {
        const Complex z(mesh.positions(v, 0), mesh.positions(v, 1));
        boundary.pin(v, z + 0.1 * z * z + 0.2 * std::conj(z));
    }
    ExtremalOptions options;
    options.chart_metric = true;
    const ExtremalMap result = extremal_map(source, boundary, options);
    ASSERT_TRUE(result.in_chart);
    EXPECT_LT(difference(source, result), 1e-12);
    // Measured on the surface instead of in the plane of the chart.
    const ReichStrebel found = reich_strebel(source, result.differential, result.distortion.mu);
    EXPECT_NEAR(found.lower, bound(result, "reich_strebel"), 0.01);
    EXPECT_LE(found.lower, result.K * 1.001);
}

TEST(ResultDifferential, OfPinsHasTheirPoles) {
    const Surface source(disk(12));
    const int pin = test::inner_vertex_near(source.mesh, 0.3);
    BoundaryCondition boundary = test::boundary_values(source, [](Complex z) { return z; });
    boundary.pin(pin, Complex(source.mesh.positions(pin, 0) + 0.1, source.mesh.positions(pin, 1)));
    const ExtremalMap result = extremal_map(source, boundary);
    EXPECT_EQ(result.differential.poles, std::vector<int>{pin});
}

TEST(ResultDifferential, OfSlidingBoundaries) {
    const Mesh ring = annulus(0.4, 1, 48);
    const ExtremalMap stretched = extremal_map(ring, Constraints(test::circles_target({{0, 0, 0.2}})));
    expect_carried(ring, stretched, 1e-12);
    EXPECT_FALSE(stretched.differential.tabulated());

    const Mesh two = test::disk_with_holes({{-0.4, 0, 0.2}, {0.4, 0.1, 0.15}}, 0.1);
    const ExtremalMap moved = extremal_map(two, Constraints(test::circles_target({{-0.4, 0.1, 0.25}, {0.35, 0, 0.2}})));
    expect_carried(two, moved, 1e-12);
    EXPECT_TRUE(moved.differential.tabulated());
}

TEST(ResultDifferential, OfMarksOnABoundaryThatSlides) {
    const Mesh mesh = disk(12);
    const Surface source(mesh);
    Constraints constraints(test::circles_target({}));
    const auto& loop = source.topology.boundary_loops[0];
    std::vector<int> marked;
    for (const double at : {0.0, 0.2, 0.5, 0.8}) {
        const int v = loop[static_cast<std::size_t>(at * static_cast<double>(loop.size()))];
        const double angle = std::arg(Complex(mesh.positions(v, 0), mesh.positions(v, 1)));
        constraints.correspondence.marks.push_back(
            {v, CurveParameter{0, (angle < 0 ? angle + 2 * std::numbers::pi : angle) * 0.9 + 0.1}});
        marked.push_back(v);
    }
    std::sort(marked.begin(), marked.end());
    const ExtremalMap result = extremal_map(source, constraints);
    expect_carried(mesh, result, 1e-12);
    EXPECT_EQ(result.differential.poles, marked);
}

TEST(ResultDifferential, OfConditionsThatMix) {
    for (const bench::MixedProblemCase& problem :
         {bench::sliding_inner_circle(0.1), bench::two_prescribed_arcs(0.15, false, true)}) {
        SCOPED_TRACE(problem.name);
        const Surface source(problem.mesh);
        const ExtremalMap result = mixed_extremal_map(source, problem.conditions);
        expect_carried(problem.mesh, result, 1e-12);
        const bool pinned = !problem.conditions.prescribed.vertices.empty();
        for (const int v : result.differential.poles) EXPECT_TRUE(pinned && !source.topology.on_boundary[v]);
    }
}

TEST(ResultDifferential, OfPiecesIsTabulated) {
    const Mesh mesh = rectangle(8, 8, 8, 8);
    const Surface source(mesh);
    BoundaryCondition boundary;
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        const double x = mesh.positions(v, 0), y = mesh.positions(v, 1);
        if (source.topology.on_boundary[v] || x == 3) boundary.pin(v, {x < 3 ? 2 * x : x + 3, y});
    }
    const ExtremalMap result = extremal_map(source, boundary);
    ASSERT_EQ(result.pieces.size(), 2u);
    EXPECT_TRUE(result.differential.tabulated());
    const Surface used = mapped(mesh, result);
    EXPECT_EQ(result.differential.at_samples(used), result.phi);
    EXPECT_EQ(result.differential.jumps.size(), 9u);
    for (const int v : result.differential.jumps) EXPECT_EQ(used.mesh.positions(v, 0), 3);
}

TEST(ResultDifferential, OfAConformalMapIsZero) {
    const Mesh mesh = disk(8);
    const ExtremalMap result = extremal_map(mesh, Constraints(test::circles_target({}, 2)));
    EXPECT_TRUE(result.differential.zero());
    EXPECT_EQ(reich_strebel(Surface(mesh), result.differential, result.distortion.mu).lower, 1);
}

}  // namespace
}  // namespace beltrami
