#pragma once

#include <functional>
#include <string>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/flow/flow_start.h>
#include <beltrami/flow/slid_map.h>

namespace beltrami BELTRAMI_PUBLIC {

/// How far a map is from having a coefficient.
struct CoefficientError {
    double l2 = 0;  ///< root mean square of |μ_f − μ| over the source's area, over the samples where μ_f is finite
    double sup = 0;  ///< its maximum; infinite where ∂f vanishes alone
    /// (Σ A |∂̄f − μ∂f|² / Σ A |∂f|²)^½, what the flow makes small.
    double residual = 0;
    /// The part of the residual that neighbouring samples share: the same of the residual's Beltrami coefficient on the
    /// target, (∂̄f − μ∂f)/conj(∂f), averaged around vertices. The error of the mesh nearly averages out; what a target
    /// of the wrong moduli forces does not, as it is a holomorphic quadratic differential.
    double misfit = 0;
};

/// @param mu #S in the samples' frames
CoefficientError coefficient_error(const Surface& source, const Eigen::VectorXcd& map, const Eigen::VectorXcd& mu);

/// Whether a coefficient belongs to a map onto this target, or with these boundary values, as far as the mesh can tell
/// from the error of the least-squares map: the misfit is below 0.4 of the residual, or both are rounding.
bool coefficient_fits(const CoefficientError& error);

/// That a coefficient does not fit a target.
Warning misfit_warning(const CoefficientError& error);

struct FlowIteration {
    double movement;  ///< largest of a boundary vertex, as part of its curve's length
    double change;    ///< of the map, relative: root mean square over the source's vertices by that of their distance
                      ///< from the mean
    CoefficientError error;
    int flips;  ///< faces with |μ_f| > 1
};

struct FlowOptions {
    double tolerance = 1e-10;  ///< stop when movement and change are below this
    int max_iterations = 60;   ///< linear solves
    /// The ε of Ng, Gu & Lui, 0 < ε ≤ 1: every step asks for (1 − ε) μ_f + ε μ. With 1 every step asks for μ.
    double step = 1;
    /// Called after every iteration, numbered from 1, with the map as it stands; returning false cancels (Error
    /// cancelled).
    std::function<bool(int iteration, const FlowIteration&, const Eigen::VectorXcd& map)> progress = {};

    /// @throw Error bad_option naming the first impossible value
    void validate() const;
};

/// A map with a prescribed coefficient, and how well it has it.
struct FlowMap : SlidMap {
    CoefficientError error;  ///< of map
    bool fits = true;        ///< coefficient_fits(error)
    std::vector<FlowIteration> history;
};

/// The Beltrami holomorphic flow of Ng, Gu & Lui 2014 (sections 5.1 and 6.1): from a start to the map with a given
/// coefficient, its boundary sliding along the curves of the start. Every iteration is one Newton step for
/// Σ A |∂̄f − μ∂f|²/(1−|μ|²) over the maps whose boundary vertices lie on their curves (sliding_map_step.h), with the
/// safeguard that keeps them in order.
///
/// On a disk and a ring the map is unique once the held vertices are; with two or more holes, or marks, μ determines
/// the target up to a conformal map: one with other moduli has no map with this μ. Then the result is the least-squares
/// map, fits is false and a warning says so. The homotopy class is that of the start.
/// @param mu    #S in the samples' frames, |μ| < 1
/// @param start flow_start
/// @throw Error bad_mesh, bad_option (μ: size, and samples where it is not finite or |μ| ≥ 1), bad_boundary,
///        not_solved (a loop has collapsed), cancelled
FlowMap beltrami_flow(const Surface& source, const Eigen::VectorXcd& mu, const SlidingStart& start,
                      const FlowOptions& options = {});

/// The same from flow_start(source, target, wanted, start).
FlowMap beltrami_flow(const Surface& source, const TargetDomain& target, const Eigen::VectorXcd& mu,
                      const FlowOptions& options = {}, const Correspondence& wanted = {},
                      const FlowStartOptions& start = {});

}  // namespace beltrami
