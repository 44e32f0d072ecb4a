#pragma once

#include <functional>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/constraints/boundary_condition.h>

namespace beltrami BELTRAMI_PUBLIC {

struct FoldFreeOptions {
    double power = 1;           ///< p ≥ 1; 8 to 128 approach the map of least max |μ| on this mesh
    int max_iterations = 1000;  ///< Newton steps
    double tolerance =
        1e-6;  ///< stop when √(−g·d / M) is below this, g the gradient and d the Newton step; without unit
    /// Called once per step with its number and the energy; returning false cancels (Error cancelled).
    std::function<bool(int iteration, double energy)> progress;

    /// @throw Error bad_option naming the first impossible value
    void validate() const;
};

struct FoldFreeStep {
    double energy;   ///< M of distortion_energy.h, regularised by epsilon: comparable only at equal epsilon and power
    double epsilon;  ///< 0 once there are no folds
    double power;    ///< p is raised in stages
    double smallest_determinant;  ///< in units of the mean determinant, negative while there are folds
};

enum class FoldFreeStatus {
    converged,        ///< fold-free, and the gradient is below the tolerance
    iteration_limit,  ///< the map is the best so far; fold_free says whether folds remain
    stuck,            ///< folds do not open, or rounding allows no better map
    impossible,  ///< fixed vertices alone force a fold: a face of theirs, or a boundary that encloses no positive area
};

struct FoldFreeMap {
    Eigen::VectorXcd map;    ///< #V
    bool fold_free = false;  ///< the determinant is positive at every sample
    FoldFreeStatus status = FoldFreeStatus::iteration_limit;
    int iterations = 0;                 ///< Newton steps
    int factorizations = 0;             ///< of the coupled system
    std::vector<int> unrepairable;      ///< faces that are folded and whose vertices are all fixed
    std::vector<FoldFreeStep> history;  ///< start first
};

/// The map without folds that is nearest to having a given Beltrami coefficient ν, in the mean: removes the folds of
/// @p start, then minimises the generalised MIPS energy M (distortion_energy.h) from there and never folds again.
///
/// While there are folds, the determinant is regularised by ε, which falls as the smallest determinant rises: Garanzha,
/// Kaporin, Kudryavtseva, Protais, Ray, Sokolov, "Foldover-free maps in 50 lines of code", ACM Trans. Graph. 40(4),
/// 2021. Every step is a Newton step with the positive semidefinite part of each sample's Hessian, in closed form;
/// without folds it ends before the first sample collapses. With ν = 0 and p = 1 this is MIPS (Hormann & Greiner 1999).
/// A larger p is reached by doubling.
///
/// M does not change under similarities, so in a component with no fixed vertex two are held, in one with a single
/// fixed vertex one more. A start that is flipped as a whole, with nothing fixed, is reflected first.
/// @param freedoms #V, free or fixed; fixed vertices keep their value of @p start
/// @param nu       #S coefficients in the samples' frames, |ν| < 1
/// @param start    #V, folded or not
/// @throw Error bad_option; bad_boundary if a vertex slides or start is not a finite map of more than one point;
/// cancelled
FoldFreeMap fold_free_map(const Surface& source, const std::vector<Freedom>& freedoms, const Eigen::VectorXcd& nu,
                          const Eigen::VectorXcd& start, const FoldFreeOptions& options = {});

}  // namespace beltrami
