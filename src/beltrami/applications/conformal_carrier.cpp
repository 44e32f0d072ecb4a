#include <beltrami/applications/conformal_carrier.h>

#include <beltrami/charts/circle_domain_chart.h>
#include <beltrami/plane/disk_moebius.h>
#include <beltrami/starts/target_model.h>

namespace beltrami {

ConformalCarrier conformal_carrier(const Surface& source, int outer_loop) {
    require_genus_zero(source);
    ConformalCarrier result;
    SplitProblem split = split_bridges(source);
    std::optional<Surface> split_surface;
    if (split.split_edges > 0) {
        split_surface = surface_of(split.mesh, split.metric);
        result.split = std::move(split);
    }
    const Surface& mapped = split_surface ? *split_surface : source;
    CircleDomainChart chart = circle_domain_chart(mapped, outer_loop);
    if (chart.holes.size() == 1) {  // a ring between circles of one centre
        const DiskMoebius move = centring(chart.holes[0]);
        chart.chart.vertices = move(chart.chart.vertices);
        chart.holes[0] = move(chart.holes[0]);
        chart.holes[0].centre = 0;
    }
    result.domain = circle_target(chart);
    result.map = std::move(chart.chart.vertices);
    result.distortion = distortion(mapped.operators, result.map);
    result.termination = chart.converged ? Termination::converged : Termination::iteration_limit;
    result.iterations = chart.steps;
    result.factorizations = chart.factorizations;
    result.warnings = std::move(chart.chart.warnings);
    if (!chart.converged)
        result.warnings.push_back(
            {WarningKind::iteration_limit, "the conformal map that carries the grid stopped after " +
                                               std::to_string(chart.steps) + (chart.steps == 1 ? " step" : " steps") +
                                               " before its circles settled: its holes are not quite round, and angles "
                                               "are off near them"});
    return result;
}

}  // namespace beltrami
