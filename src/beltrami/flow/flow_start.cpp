#include <beltrami/flow/flow_start.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <beltrami/base/error.h>
#include <beltrami/constraints/constraints.h>
#include <beltrami/operators/distortion.h>

namespace beltrami {

namespace {

/// The curve to which the vertices of a loop are nearest, root mean square.
int nearest_curve(const std::vector<int>& loop, const TargetDomain& target, const Eigen::VectorXcd& map) {
    int best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (int c = 0; c < target.curve_count(); ++c) {
        const TargetCurve& curve = target.curve(c);
        double sum = 0;
        for (const int v : loop) sum += std::norm(map[v] - curve.point(curve.nearest(map[v])));
        if (sum < least) least = sum, best = c;
    }
    return best;
}

}  // namespace

SlidingStart flow_start(const Surface& source, const TargetDomain& target, const Correspondence& wanted,
                        const FlowStartOptions& options) {
    require_genus_zero(source);
    validate(Constraints(target, wanted), source);
    const std::size_t loops = source.topology.boundary_loops.size();
    if (!options.start_turns.empty() && options.start_turns.size() != loops)
        throw Error(Cause::bad_option, "start turns are given for " + std::to_string(options.start_turns.size()) +
                                           " boundary loops, the source has " + std::to_string(loops));
    const CircleDomainChart chart = circle_domain_chart(source, wanted.outer_loop);
    const auto model = target_model(target, edge_length_for(source, target, options.target_edge_length));
    SlidingStart start = sliding_start(source, chart, *model, wanted, options.start_turns);
    start.factorizations += chart.factorizations + model->factorizations();
    hold_what_conformal_maps_move(start.loops, wanted.outer_loop, wanted.marks.size());
    return start;
}

SlidingStart flow_start(const Surface& source, const TargetDomain& target, const Eigen::VectorXcd& map,
                        const std::vector<int>& held) {
    require_genus_zero(source);
    validate(target);
    const auto& loops = source.topology.boundary_loops;
    if (map.size() != source.mesh.vertex_count())
        throw Error(Cause::bad_option, "the start has " + std::to_string(map.size()) + " values, the source " +
                                           std::to_string(source.mesh.vertex_count()) + " vertices");
    for (Eigen::Index v = 0; v < map.size(); ++v)
        if (!std::isfinite(map[v].real()) || !std::isfinite(map[v].imag()))
            throw Error(Cause::bad_option, "the start is not finite at vertex " + std::to_string(v), "",
                        {static_cast<int>(v)});
    if (static_cast<int>(loops.size()) != target.curve_count())
        throw Error(Cause::bad_boundary,
                    "the source has " + std::to_string(loops.size()) + " boundary loops, the target " +
                        std::to_string(target.curve_count()),
                    "source and target must have the same number of holes");
    std::vector<char> is_held(source.mesh.vertex_count(), 0);
    for (const int v : held) {
        if (v < 0 || v >= source.mesh.vertex_count() || !source.topology.on_boundary[v])
            throw Error(Cause::bad_boundary,
                        "the held vertex " + std::to_string(v) + " is not on the boundary of the source",
                        "hold boundary vertices only", {v});
        is_held[v] = 1;
    }
    SlidingStart start;
    start.map = map;
    std::vector<int> loop_of_curve(loops.size(), -1);
    for (std::size_t l = 0; l < loops.size(); ++l) {
        const int c = nearest_curve(loops[l], target, map);
        if (loop_of_curve[c] >= 0)
            throw Error(Cause::bad_boundary,
                        "boundary loops " + std::to_string(loop_of_curve[c]) + " and " + std::to_string(l) +
                            " of the start are both nearest to " + curve_name(c),
                        "give a start whose loops lie on the curves of the target");
        loop_of_curve[c] = static_cast<int>(l);
        start.curves.push_back(c);
        SlidingLoop sliding{static_cast<int>(l), target.curve(c), {}, {}};
        for (const int v : loops[l]) {
            const double s = sliding.curve.nearest(map[v]);
            sliding.parameters.push_back(sliding.parameters.empty()
                                             ? s
                                             : sliding.parameters.back() +
                                                   sliding.curve.ahead(sliding.parameters.back(), s));
            sliding.held.push_back(is_held[v]);
            start.map[v] = sliding.curve.point(s);
        }
        start.loops.push_back(std::move(sliding));
    }
    hold_what_conformal_maps_move(start.loops, loop_of_curve[0],
                                  static_cast<std::size_t>(std::count(is_held.begin(), is_held.end(), 1)));
    start.flips = static_cast<int>(distortion(source.operators, start.map).flipped.size());
    return start;
}

}  // namespace beltrami
