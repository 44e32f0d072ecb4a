#include <beltrami/teichmuller/extremal_map.h>

#include <beltrami/base/error.h>
#include <beltrami/teichmuller/extremal_solver.h>

namespace beltrami {

namespace {

/// By so much a corner's bound must exceed K.
constexpr double kCornerMargin = 0.01;

}  // namespace

void ExtremalOptions::validate() const {
    const auto demand = [](bool holds, const char* sentence) {
        if (!holds) throw Error(Cause::bad_option, sentence);
    };
    demand(tolerance > 0 && tolerance < 1, "tolerance must lie between 0 and 1");
    demand(max_iterations >= 1, "max_iterations must be at least 1");
    demand(growth > 0, "growth must be positive");
    demand(anderson_window >= 0, "anderson_window must not be negative");
    demand(cluster_count >= 100, "cluster_count must be at least 100");
    demand(outer_loop >= 0, "outer_loop must not be negative");
    demand(!waypoints || (!start && turns.empty()),
           "waypoints fix the homotopy class: give no turns and no start with them");
}

HamiltonIteration::Options iteration_options(const ExtremalOptions& options) {
    HamiltonIteration::Options result;
    result.tolerance = result.k_tolerance = options.tolerance;
    result.max_iterations = options.max_iterations;
    result.growth = options.growth;
    result.anderson_window = options.anderson_window;
    result.progress = options.progress;
    return result;
}

const char* to_string(Termination termination) {
    switch (termination) {
        case Termination::converged:
            return "converged";
        case Termination::iteration_limit:
            return "iteration_limit";
        case Termination::not_teichmuller:
            return "not_teichmuller";
    }
    return "unknown";
}

bool corner_decides(const BoundaryCorner& corner, double K) {
    return corner.safe_bound > (1 + kCornerMargin) * K;
}

std::string corner_warning(const BoundaryCorner& corner) {
    return "at vertex " + std::to_string(corner.vertex) + " the boundary values alone force K ≥ " +
           std::to_string(corner.safe_bound) +
           ": the extremal map is not of Teichmüller type; gentler speed there (--speed conformal) or other boundary "
           "values would lower K";
}

ExtremalMap extremal_map(const Mesh& source, const BoundaryCondition& boundary, const ExtremalOptions& options) {
    return extremal_map(Surface(source), boundary, options);
}

ExtremalMap extremal_map(const Surface& source, const BoundaryCondition& boundary, const ExtremalOptions& options) {
    return ExtremalSolver(source, boundary, options).solve();
}

}  // namespace beltrami
