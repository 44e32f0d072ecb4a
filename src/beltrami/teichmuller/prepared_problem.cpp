#include <beltrami/teichmuller/prepared_problem.h>

#include <beltrami/base/counted.h>
#include <beltrami/base/error.h>
#include <beltrami/constraints/boundary_feasibility.h>

namespace beltrami {

Warning PreparedProblem::split_warning(const char* kind) const {
    return {WarningKind::edges_split, counted(static_cast<std::size_t>(split->split_edges), "edge", "edges") +
                                          " between " + kind +
                                          (split->split_edges == 1 ? " vertices was" : " vertices were") +
                                          " split; added vertices follow the source's"};
}

PreparedProblem prepared(SplitProblem split) {
    PreparedProblem result;
    if (split.split_edges == 0) return result;
    result.surface = surface_of(split.mesh, split.metric);
    result.split = std::move(split);
    return result;
}

PreparedProblem prepare(const Surface& source, const Constraints& constraints, const ExtremalOptions& options) {
    options.validate();
    require_genus_zero(source);
    validate(constraints, source);
    const BoundaryCondition& boundary = constraints.prescribed;
    validate(boundary, source);
    require_whole_boundary(boundary, source);
    require_feasible(source, boundary, constraints.correspondence.outer_loop);
    if (options.start && constraints.correspondence.waypoints)
        throw Error(Cause::bad_option, "waypoints fix the homotopy class: give no start with them");
    if (options.slack > 0 && (source.topology.boundary_loops.size() != 1 || !boundary.lines.empty() ||
                              boundary.vertices.size() != source.topology.boundary_loops[0].size()))
        throw Error(Cause::bad_option, "slack moves the boundary of a disk; here there are holes or points inside",
                    "leave it at 0");
    if (options.start && options.start->size() != source.mesh.vertex_count())
        throw Error(Cause::bad_option, "the start has " + std::to_string(options.start->size()) + " values for " +
                                           std::to_string(source.mesh.vertex_count()) + " vertices");
    if (!options.split_prescribed) return {};
    return prepared(split_prescribed(source, boundary));
}

}  // namespace beltrami
