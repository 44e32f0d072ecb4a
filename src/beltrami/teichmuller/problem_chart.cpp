#include <beltrami/teichmuller/problem_chart.h>

#include <cmath>
#include <numbers>

#include <beltrami/charts/domain_chart.h>
#include <beltrami/charts/fold_free_disk.h>
#include <beltrami/plane/circle_fit.h>

namespace beltrami {

namespace {

/// Mean |μ| from which on a chart is inaccurate.
constexpr double kInaccurateChart = 0.03;
/// Corners of a planar source that turn by more than this (radians) make its Riemann map inaccurate there; with so few
/// of them poles in its own coordinates do better.
constexpr double kSharp = 0.5;
constexpr int kFewCorners = 12;

/// Whether the outer loop of a source in the plane lies on a circle.
bool outer_loop_is_round(const Surface& source) {
    std::vector<Complex> outline;
    for (const int v : source.topology.boundary_loops[0]) outline.push_back((*source.coordinate())[v]);
    return fit_circle(outline).exact();
}

/// Whether the outer loop is a polygon of few corners.
bool few_sharp_corners(const std::vector<BoundaryCorner>& corners, int outer_loop) {
    int sharp = 0;
    for (const BoundaryCorner& corner : corners)
        if (corner.loop == outer_loop && std::abs(corner.source_angle - std::numbers::pi) > kSharp) ++sharp;
    return sharp > 0 && sharp <= kFewCorners;
}

/// Whether a chart is so inaccurate that a plane source is better described by its own coordinates.
bool far_from_conformal(const Surface& source, const Chart& chart) {
    double sum = 0;
    for (int s = 0; s < source.operators.sample_count(); ++s) {
        const auto [dz, dzbar] = source.operators.derivatives(s, chart.vertices);
        sum += source.operators.weights[s] * std::abs(dzbar) / std::abs(dz);
    }
    return sum > kInaccurateChart * source.operators.area();
}

/// Whether exactly the boundary is prescribed.
bool nothing_inside(const Surface& source, const BoundaryCondition& boundary) {
    std::size_t rim = 0;
    for (const auto& loop : source.topology.boundary_loops) rim += loop.size();
    return boundary.lines.empty() && boundary.vertices.size() == rim;
}

}  // namespace

ProblemChart chart_of_problem(const Surface& source, const BoundaryCondition& boundary,
                              const std::vector<BoundaryCorner>& corners, int outer_loop, const BeltramiSolver& solver,
                              const Shape* shape) {
    const bool own_coordinates = outer_loop == 0 && source.in_plane();
    if (own_coordinates && few_sharp_corners(corners, outer_loop) && !outer_loop_is_round(source))
        return {plane_chart(source), {}};
    const BeltramiSolver* dirichlet = nothing_inside(source, boundary) ? &solver : nullptr;
    ProblemChart result{shape ? shape->chart(outer_loop, dirichlet) : domain_chart(source, outer_loop, dirichlet), {}};
    if (source.topology.boundary_loops.size() == 1 && !result.chart.exact)
        result.chart = with_folds_opened(source, std::move(result.chart));
    if (!result.chart.exact && own_coordinates && far_from_conformal(source, result.chart)) {
        result.instead = plane_chart(source);
        result.instead->factorizations = result.chart.factorizations;
    }
    return result;
}

}  // namespace beltrami
