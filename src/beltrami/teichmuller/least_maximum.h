#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/base/warning.h>
#include <beltrami/teichmuller/extremal_map.h>
#include <beltrami/unfold/fold_free.h>

namespace beltrami BELTRAMI_PUBLIC {

struct LeastMaximumOptions {
    double power = 128;         ///< p of the last stage, at least 1
    int max_iterations = 1000;  ///< Newton steps of all stages
    double tolerance = 1e-6;    ///< see FoldFreeOptions
    ExtremalOptions extremal;   ///< of the extremal map from which to start; its split applies
    /// Called once per Newton step with its number and the energy; returning false cancels (Error cancelled).
    std::function<bool(int iteration, double energy)> progress;

    /// @throw Error bad_option naming the first impossible value
    void validate() const;
};

/// Where edges had to be split, #V and #F are those of the split mesh.
struct LeastMaximumMap {
    Eigen::VectorXcd map;   ///< #V images; the start, unless it has more flipped faces or as many and a larger |μ|
    Distortion distortion;  ///< of map; its max is what has been made small
    double start_max = 0;   ///< largest |μ| of the start; above 1 where it was folded
    bool fold_free = false;
    /// Vertices inside around which the map winds more than once (branch_points.h): possible only where parts of the
    /// boundary are free.
    std::vector<int> branch_points;
    FoldFreeStatus status = FoldFreeStatus::iteration_limit;  ///< of the last stage
    int iterations = 0;                                       ///< Newton steps
    int factorizations = 0;             ///< of #V×#V systems and larger, those of the extremal map included
    std::vector<FoldFreeStep> history;  ///< start first
    /// The start, where the whole boundary is prescribed. Its bounds on K* hold for this map's class too.
    std::optional<ExtremalMap> extremal;
    std::optional<SplitProblem> split;  ///< the mesh that was mapped, if it is not the source itself
    HomotopyClass homotopy;             ///< of map, with holes whose loops are all prescribed
    Warnings warnings;
};

/// The map of this mesh whose largest |μ| is least: the discrete min-max problem, which the extremal map solves in the
/// continuous limit only. It minimises the p-th power mean of the energy of fold_free.h, (|∂f|²+|∂̄f|²)/(|∂f|²−|∂̄f|²),
/// with p doubling up to options.power, without ever folding. That is a function of |μ| which rises with it, so p → ∞
/// is the min-max map; the problem is not convex and what is found is a local minimum near the start.
///
/// The start is the extremal map where the whole boundary is prescribed, and where that had or has folds also the map
/// of convex_embedding; else the least-squares conformal map, and where that ends folded or branched also the one of
/// displacement_start.h; the better end of the two is the result. Folds are opened first. Boundary vertices that are
/// not prescribed are free (natural condition). Interior vertices on lines stay where the start has them.
///
/// Where a part of the boundary is free no extremal map exists in general: an admissible φ vanishes along it, hence
/// everywhere, and the least K of the smooth problem is 1, which no map attains. The largest |μ| of a mesh then falls
/// as the mesh is refined (docs/extremal-maps.md).
/// @pre one component with a boundary; genus 0 where the whole boundary is prescribed
/// @throw Error bad_mesh, bad_boundary, not_solved, cancelled, bad_option
LeastMaximumMap least_maximum_map(const Surface& source, const Constraints& constraints,
                                  const LeastMaximumOptions& options = {});

}  // namespace beltrami
