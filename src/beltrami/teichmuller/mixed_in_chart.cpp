#include <beltrami/teichmuller/mixed_in_chart.h>

#include <algorithm>

#include <beltrami/charts/round_disk.h>
#include <beltrami/mesh/subdivide.h>
#include <beltrami/teichmuller/mixed_problem.h>
#include <beltrami/teichmuller/problem.h>
#include <beltrami/teichmuller/record.h>
#include <beltrami/teichmuller/rim_degree.h>
#include <beltrami/teichmuller/sliding_solver.h>

namespace beltrami {

MixedInChart::MixedInChart(const Surface& source, PreparedProblem prepared, Chart chart,
                           const MixedConditions& conditions, ExtremalOptions options, std::size_t marks)
    : prepared_(std::move(prepared)),
      source_(prepared_.surface_of(source)),
      chart_(std::move(chart)),
      metric_(source_, chart_) {
    if (options.start && prepared_.split) options.start = with_parents_means(*options.start, prepared_.split->parents);
    in_plane_ = std::make_unique<SlidingSolver>(
        std::make_unique<MixedProblem>(metric_.plane(), conditions, options, marks), options);
}

ExtremalMap MixedInChart::solve() {
    ExtremalMap result = in_plane_->solve();
    result.factorizations += chart_.factorizations;
    Warnings warnings = chart_.warnings;
    if (prepared_.split) warnings.push_back(prepared_.split_warning("boundary or prescribed"));
    result.warnings.insert(result.warnings.begin(), warnings.begin(), warnings.end());
    result.split = prepared_.split;

    result.in_chart = InChart{metric_.chart_mean(), result.distortion.mean, result.distortion.standard_deviation,
                              degree_of_rim(source_, chart_)};
    result.distortion = distortion(source_.operators, result.map);
    std::erase_if(result.bounds, [](const Bound& bound) { return bound.kind == Bound::Kind::attained; });
    record_attained(result);

    result.phi = metric_.differential_on_surface(result.phi);
    if (result.differential.chart) {
        Chart on_surface = *result.differential.chart;
        on_surface.derivatives = on_surface.derivatives.cwiseProduct(metric_.chart_on_surface().derivatives);
        on_surface.exact = false;
        on_surface.analytic = {};
        result.differential.chart = std::make_shared<Chart>(std::move(on_surface));
    }
    return result;
}

std::unique_ptr<ProblemSolver> mixed_solver(const Surface& source, const MixedConditions& conditions,
                                            const ExtremalOptions& options, std::size_t marks) {
    if (!source.in_plane() && source.topology.boundary_loops.size() == 1 && options.chart_metric.value_or(true)) {
        PreparedProblem prepared = prepare_mixed(source, conditions, options);
        Chart chart = round_disk_chart(prepared.surface_of(source));
        if (can_be_metric(prepared.surface_of(source), chart))
            return std::make_unique<MixedInChart>(source, std::move(prepared), std::move(chart), conditions, options,
                                                  marks);
    }
    return std::make_unique<SlidingSolver>(std::make_unique<MixedProblem>(source, conditions, options, marks), options);
}

}  // namespace beltrami
