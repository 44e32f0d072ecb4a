#include <beltrami/flow/flow_start.h>

#include <algorithm>
#include <set>
#include <string>

#include <beltrami/base/error.h>
#include <beltrami/charts/shape.h>
#include <beltrami/constraints/constraints.h>
#include <beltrami/starts/given_start.h>

namespace beltrami {

SlidingStart flow_start(const Surface& source, const TargetDomain& target, const Correspondence& wanted,
                        const FlowStartOptions& options) {
    require_genus_zero(source);
    validate(Constraints(target, wanted), source);
    const std::size_t loops = source.topology.boundary_loops.size();
    if (!options.start_turns.empty() && options.start_turns.size() != loops)
        throw Error(Cause::bad_option, "start turns are given for " + std::to_string(options.start_turns.size()) +
                                           " boundary loops, the source has " + std::to_string(loops));
    const CircleDomainChart chart = circle_domain_of(source, wanted.outer_loop, options.shapes);
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
    SlidingStart start = given_start(source, target, map);
    for (const int v : held) {
        if (v < 0 || v >= source.mesh.vertex_count() || !source.topology.on_boundary[v])
            throw Error(Cause::bad_boundary,
                        "the held vertex " + std::to_string(v) + " is not on the boundary of the source",
                        "hold boundary vertices only", {Things::vertices, {v}});
        for (SlidingLoop& sliding : start.loops) {
            const std::vector<int>& loop = source.topology.boundary_loops[sliding.loop];
            for (std::size_t i = 0; i < loop.size(); ++i)
                if (loop[i] == v) sliding.held[i] = 1;
        }
    }
    const auto outer = std::find(start.curves.begin(), start.curves.end(), 0) - start.curves.begin();
    const std::set<int> named(held.begin(), held.end());
    hold_what_conformal_maps_move(start.loops, static_cast<int>(outer), named.size());
    return start;
}

}  // namespace beltrami
