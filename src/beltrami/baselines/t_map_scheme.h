#pragma once

#include <functional>
#include <string>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/flow/flow_start.h>
#include <beltrami/flow/slid_map.h>

namespace beltrami BELTRAMI_PUBLIC {

/// One linear solve of the scheme, and |μ| of the map after it.
struct TMapSolve {
    enum class Part { initial, damping, projection };
    Part part = Part::initial;
    double mean = 0, standard_deviation = 0, max = 0;  ///< of |μ|, as in Distortion
    int flips = 0;
};

struct TMapSchemeOptions {
    /// What the boundary does in the projection P: it keeps its place, as the paper has it, or slides.
    enum class Projection { fixed_boundary, sliding_boundary };
    Projection projection = Projection::fixed_boundary;
    double damping = 0.1;      ///< ε of the damping D, eq. (33); 0: P alone, which then must slide to reach anything
    int projection_steps = 5;  ///< most solves of one projection
    double smoothing = 0.75;   ///< how far arg μ goes to the mean of its neighbours in one pass; ¾: to that of a
                               ///< triangle and its neighbours, eq. (36)
    int smoothing_passes = 1;
    /// Solves for the coefficient 0 with which the scheme begins (section 5.3). The paper lets them settle; then they
    /// can end in a collapse of holes.
    int initial_steps = 1;
    double tolerance = 1e-3;  ///< stop when μ changes by less in a round, and in a projection, the largest of a sample
    int max_solves = 200;
    /// Called after every solve; returning false cancels (Error cancelled).
    std::function<bool(int solve, const TMapSolve&)> progress = {};

    /// @throw Error bad_option naming the first impossible value
    void validate() const;
};

struct TMapSchemeResult : SlidMap {
    int solves = 0;
    std::vector<TMapSolve> history;  ///< one entry a solve, after the start's own
};

/// The scheme of Ng, Gu & Lui 2014 for the extremal map onto a domain whose boundary slides (Algorithm 3), kept as the
/// paper has it for comparison with extremal_map: in turn the map whose coefficient is nearest to (1 − ε)μ, the
/// boundary sliding, and the projection P (Algorithm 2), solves for L(N(μ)): |μ| replaced by its mean (34), arg μ by
/// that of its neighbours (36), the boundary fixed.
///
/// It is no descent: nothing it does makes the dilatation of the next map less than that of the last one, and with an
/// L² solve in place of the L^∞ problem (24), Theorem 5 has no hold on it. Where it goes is in docs/flow.md: near the
/// extremal map, then about it or away from it. No map of the iteration is better than the others by rule; the result
/// is the last one.
///
/// Details: one linear solve stands for one BHF; vertices slide along the true curves with the safeguard of
/// sliding_boundary.h, where (32) projects them; |μ| counts as at most .95; arg μ is smoothed by differences in
/// (−π, π]. A loop that collapses is said in a warning.
/// @throw Error bad_mesh, bad_option, bad_boundary, not_solved, cancelled
TMapSchemeResult t_map_scheme(const Surface& source, const SlidingStart& start, const TMapSchemeOptions& options = {});

/// The same from flow_start(source, target, wanted, start).
TMapSchemeResult t_map_scheme(const Surface& source, const TargetDomain& target, const TMapSchemeOptions& options = {},
                              const Correspondence& wanted = {}, const FlowStartOptions& start = {});

}  // namespace beltrami
