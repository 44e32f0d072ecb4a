#pragma once

#include <functional>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/constraints/target_constraints.h>
#include <beltrami/solve/map_result.h>

namespace beltrami BELTRAMI_PUBLIC {

struct ExtremalFlowOptions {
    /// Stop when over eight steps log K and log K_lower have changed by less than this part.
    double tolerance = 1e-3;
    int max_iterations = 100;
    /// Called after every step with its number and k; returning false cancels (Error cancelled).
    std::function<bool(int iteration, double k)> progress = {};

    /// @throw Error bad_option naming the first impossible value
    void validate() const;
};

/// A map of small dilatation among those that keep to constraints, and what is known of the least one.
struct ExtremalFlowMap {
    TargetMap map;
    /// #S, together the area of the source: what samples weigh. They tend to the part of ∫|φ|, φ the quadratic
    /// differential of the extremal map, and a little of the area.
    std::vector<double> weights;
    double k = 0, K = 1;                      ///< estimates: K = √(I⁺/I⁻), I^± the means of K^±1 over |φ|
    double K_lower = 1;                       ///< an estimate from below, 1/I⁻
    double mean = 0, standard_deviation = 0;  ///< of |μ| by |φ|
    Termination termination = Termination::iteration_limit;
    int iterations = 0, factorizations = 0;
};

/// Maps of least Σ W ψ, ψ = |μ|²/(1 − |μ|²), with weights that grow where |μ| is larger than elsewhere, until it is the
/// same wherever these are not small: W ← W |μ| with |μ| averaged around vertices (Lawson 1961, of Chebyshev's
/// approximations), one Gauss-Newton step with a barrier against flips in turn with each. Of such a map conj(φ) = W
/// μ/(1 − |μ|²), up to the turn of the frame of the image, is admissible whatever the constraints are, also those for
/// which no space of differentials is known: curves along which vertices slide. The main inequality of Reich and
/// Strebel for the inverse map then is K ≥ ∫|φ| / ∫|φ|/K(x).
/// @param start without flips
/// @return the step with the least K/K_lower, the start counts
/// @throw Error bad_option (sizes, a start with flips), bad_boundary as validate(constraints), cancelled
ExtremalFlowMap extremal_flow(const Surface& source, const Target& target, const TargetConstraints& constraints,
                              TargetMap start, const ExtremalFlowOptions& options = {});

}  // namespace beltrami
