#include <beltrami/teichmuller/least_maximum.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <beltrami/base/error.h>
#include <beltrami/charts/domain_chart.h>
#include <beltrami/constraints/boundary_feasibility.h>
#include <beltrami/solve/beltrami_solver.h>
#include <beltrami/unfold/branch_points.h>
#include <beltrami/unfold/convex_combination_map.h>
#include <beltrami/unfold/displacement_start.h>

namespace beltrami {

namespace {

/// The least-squares conformal map with what is prescribed. Nothing prescribed, or one image only: that of the free
/// boundary, moved to the image.
Eigen::VectorXcd conformal_start(const Surface& source, const BoundaryCondition& boundary) {
    if (!boundary.lines.empty() || boundary.vertices.size() > 1) {
        BeltramiSolver solver(source, freedoms(boundary, source), 1);
        solver.factorize(Eigen::VectorXcd::Zero(source.operators.sample_count()), line_directions(boundary, source));
        return solver.solve(prescribed_values(boundary, source));
    }
    Eigen::VectorXcd map = least_squares_conformal_map(source, {});
    if (boundary.vertices.empty()) return map;
    return map.array() + (boundary.images[0] - map[boundary.vertices[0]]);
}

/// The split of a problem with free boundary vertices; nothing where nothing had to be split.
std::optional<SplitProblem> split_of(const Surface& source, const BoundaryCondition& boundary,
                                     const LeastMaximumOptions& options) {
    if (!options.extremal.split_prescribed) return {};
    SplitProblem split = split_prescribed(source, boundary);
    if (split.split_edges == 0) return {};
    return split;
}

/// Whether fewer faces are flipped, or as few and the largest |μ| is smaller.
bool less_bad(const Distortion& a, const Distortion& b) {
    if (a.flipped.size() != b.flipped.size()) return a.flipped.size() < b.flipped.size();
    return a.max < b.max;
}

/// The descent from one start; steps and factorisations are added to those before.
void descend(const Surface& surface, const BoundaryCondition& boundary, const Eigen::VectorXcd& start,
             const LeastMaximumOptions& options, LeastMaximumMap& result) {
    std::vector<Freedom> freedom = freedoms(boundary, surface);
    std::replace(freedom.begin(), freedom.end(), Freedom::sliding, Freedom::fixed);
    FoldFreeMap found = fold_free_map(surface, freedom, Eigen::VectorXcd::Zero(surface.operators.sample_count()), start,
                                      {options.power, options.max_iterations, options.tolerance, options.progress});
    const Distortion before = distortion(surface.operators, start);
    result.start_max = before.max;
    result.map = std::move(found.map);
    result.fold_free = found.fold_free;
    result.status = found.status;
    result.iterations += found.iterations;
    result.factorizations += found.factorizations;
    result.history = std::move(found.history);
    result.distortion = distortion(surface.operators, result.map);
    // A mean with a finite power can prefer a map whose worst face is worse, and a fold that does not open can get
    // worse.
    if (!less_bad(result.distortion, before)) {
        result.map = start;
        result.distortion = before;
        result.fold_free = before.max < 1;
    }
    result.branch_points = branch_points(surface, result.map);
}

/// The descent from a map that never had folds, where the target is convex; the better end of the two is the result.
void descend_from_embedding(const Surface& surface, const BoundaryCondition& boundary,
                            const LeastMaximumOptions& options, LeastMaximumMap& result) {
    const auto embedding = convex_embedding(surface, boundary, result.factorizations);
    if (!embedding) return;
    LeastMaximumMap other = result;
    descend(surface, boundary, *embedding, options, other);
    other.start_max = result.start_max;
    if (less_bad(other.distortion, result.distortion)) {
        result = std::move(other);
    } else {
        result.iterations = other.iterations;
        result.factorizations = other.factorizations;
    }
}

bool one_to_one(const LeastMaximumMap& map) {
    return map.fold_free && map.branch_points.empty();
}

/// Whether a map has fewer defects than another, or as few and a smaller maximum. Faces may be tiny.
bool better(const LeastMaximumMap& a, const LeastMaximumMap& b) {
    const auto defects = [](const LeastMaximumMap& map) {
        return std::pair(map.distortion.flipped.size(), map.branch_points.size());
    };
    if (defects(a) != defects(b)) return defects(a) < defects(b);
    return a.distortion.max < b.distortion.max;
}

}  // namespace

void LeastMaximumOptions::validate() const {
    FoldFreeOptions{power, max_iterations, tolerance, {}}.validate();
    extremal.validate();
}

LeastMaximumMap least_maximum_map(const Surface& source, const Constraints& constraints,
                                  const LeastMaximumOptions& options) {
    options.validate();
    require_open_component(source);
    validate(constraints, source);
    const BoundaryCondition& boundary = constraints.prescribed;
    const Correspondence& wanted = constraints.correspondence;
    validate(boundary, source);
    if (!constraints.all_prescribed())
        throw Error(Cause::bad_option, "the map of least maximum has prescribed or free boundary values",
                    "leave out what slides");
    LeastMaximumMap result;
    Eigen::VectorXcd start;
    if (unprescribed_boundary(boundary, source).empty()) {
        result.extremal = extremal_map(source, constraints, options.extremal);
        start = result.extremal->map;
        result.split = result.extremal->split;
        result.factorizations = result.extremal->factorizations;
    } else {
        if (source.topology.genus == 0) require_feasible(source, boundary, wanted.outer_loop);
        result.split = split_of(source, boundary, options);
    }
    std::optional<Surface> split_surface;
    if (result.split) split_surface = surface_of(result.split->mesh, result.split->metric);
    const Surface& surface = split_surface ? *split_surface : source;
    if (result.extremal) {
        descend(surface, boundary, start, options, result);
        if (!result.fold_free || result.extremal->folds_removed)
            descend_from_embedding(surface, boundary, options, result);
    } else {
        start = conformal_start(surface, boundary);
        result.factorizations += 1;
        descend(surface, boundary, start, options, result);
        if (!one_to_one(result) && boundary.vertices.size() > 1) {
            LeastMaximumMap other = result;
            const Eigen::VectorXcd* z = surface.coordinate();
            const Eigen::VectorXcd places = z ? *z : least_squares_conformal_map(surface, {});
            other.factorizations += z ? 1 : 2;
            descend(surface, boundary, displacement_start(surface, places, boundary), options, other);
            if (better(other, result)) {
                result = std::move(other);
            } else {
                result.iterations = other.iterations;
                result.factorizations = other.factorizations;
            }
        }
    }
    if (result.extremal) {
        // Raising p from a folded start can carry a map into another class.
        const HomotopyClass& started = result.extremal->homotopy;
        if (!started.holes.empty()) {
            result.homotopy = homotopy_class(surface, domain_chart(surface, started.outer_loop).vertices, result.map,
                                             started.outer_loop);
            for (std::size_t i = 0; i < started.holes.size(); ++i) {
                const HoleTurns& hole = result.homotopy.holes[i];
                const int turns = wanted.turns.empty() ? started.holes[i].turns : wanted.turns[hole.loop];
                if (hole.turns != turns)
                    throw Error(Cause::not_solved,
                                "the map of least maximum has " + std::to_string(hole.turns) + " turns against loop " +
                                    std::to_string(hole.loop) + " instead of " + std::to_string(turns) +
                                    ": the start was folded too much to keep its class",
                                "refine the mesh, or take the extremal map", {Things::loops, {hole.loop}});
            }
        }
    }
    if (!result.fold_free)
        result.warnings.push_back(
            result.status == FoldFreeStatus::impossible
                ? Warning{WarningKind::fold_forced, "the prescribed vertices alone force a fold"}
                : Warning{WarningKind::flipped_faces,
                          std::to_string(result.distortion.flipped.size()) + " flipped faces could not be opened",
                          {Things::faces, result.distortion.flipped}});
    if (!result.branch_points.empty())
        result.warnings.push_back({WarningKind::branch_points,
                                   "the map winds more than once around vertex " +
                                       std::to_string(result.branch_points[0]) +
                                       (result.branch_points.size() > 1
                                            ? " and " + std::to_string(result.branch_points.size() - 1) + " others"
                                            : "") +
                                       ": it is not one-to-one there; prescribe more of the boundary",
                                   {Things::vertices, result.branch_points}});
    if (!result.distortion.degenerate.empty() && result.distortion.flipped.empty())
        result.warnings.push_back(
            {WarningKind::degenerate_faces,
             std::to_string(result.distortion.degenerate.size()) +
                 " faces are smaller than 1e-14 of the image: sizes run apart towards free parts of "
                 "the boundary, the more the finer the mesh; prescribe more of it",
             {Things::faces, result.distortion.degenerate}});
    if (result.status == FoldFreeStatus::iteration_limit)
        result.warnings.push_back({WarningKind::iteration_limit, "stopped after " + std::to_string(result.iterations) +
                                                                     " Newton steps before the largest |μ| settled"});
    return result;
}

}  // namespace beltrami
