#pragma once

#include <functional>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/constraints/target_constraints.h>
#include <beltrami/flow/beltrami_flow.h>

namespace beltrami BELTRAMI_PUBLIC {

/// Steps of a flow along a target.
enum class FlowScheme {
    automatic,     ///< residual while faces are flipped, where that is held up patches of means, and perturbation;
                   ///< perturbation while it gains much towards a coefficient; then barrier
    residual,      ///< Gauss-Newton steps for Σ W |∂̄f − σ∂f|²
    perturbation,  ///< those of Wong & Zhao: the motion that changes μ towards σ to first order
    barrier,       ///< Gauss-Newton steps for an energy that is infinite where a face is flipped
};
const char* to_string(FlowScheme);

/// One step of a flow along a target.
struct SurfaceFlowIteration {
    FlowScheme scheme = FlowScheme::barrier;  ///< of the step: not automatic
    double energy = 0;                        ///< what the step made small, after it
    double length = 0;                        ///< part of the step that was taken
    double movement = 0;                      ///< largest of a vertex, as part of the image's size
    CoefficientError error;
    double squared_error = 0;  ///< Σ A |μ_f − μ|², without a root: what Wong & Zhao call the L² error
    int flips = 0;             ///< samples that are flipped
};

struct SurfaceFlowOptions {
    /// Stop when a step moves no vertex by more, as part of the diameter of the image.
    double tolerance = 1e-8;
    /// Stop when a step that is not cut short, or eight of any length together, lower their energy by less than this
    /// part, or the squared error changes by less where no vertex is held: such maps may drift for ever. 0: never.
    double least_decrease = 1e-4;
    int max_iterations = 100;  ///< linear solves
    FlowScheme scheme = FlowScheme::automatic;
    /// Called after every step, numbered from 1, with the map as it stands; returning false cancels (Error cancelled).
    std::function<bool(int iteration, const SurfaceFlowIteration&, const TargetMap&)> progress = {};

    /// @throw Error bad_option naming the first impossible value
    void validate() const;
};

/// A map to a surface in space, and how it was found.
struct SurfaceFlowMap {
    TargetMap map;
    Distortion distortion;   ///< of the map to the straight faces between the images, seen from the target's outer side
    CoefficientError error;  ///< from the coefficient that was wanted
    bool fits = true;        ///< coefficient_fits(error); true where none was wanted
    std::vector<SurfaceFlowIteration> history;
    Termination termination = Termination::converged;  ///< unconfirmed: short steps came to nothing, or flips stay
    int iterations = 0;
    int factorizations = 0;
    Warnings warnings;
};

/// How far a map to a target is from having a coefficient.
/// @param mu #S in the samples' frames
CoefficientError coefficient_error(const Surface& source, const TargetMap& map, const Eigen::VectorXcd& mu);

/// The discrete Beltrami flow of Wong & Zhao 2014: from a start, which may be folded, to the map of a surface of any
/// topology along a target that has a given coefficient. Every step moves the vertices in the target's tangent planes,
/// or along the curves on which they slide, by a least-squares problem with two real unknowns a vertex, and takes them
/// back to the target. Faces are judged in frames seen from the target's outer side, so that a flipped one has |μ| > 1
/// and is turned over. A step is halved until it flips nothing more and lowers its energy.
///
/// μ determines the map up to conformal maps of the target: where they are left over, hold vertices (three on a sphere;
/// one inside and one of the boundary of a disk), or none, and the map comes out centred (Target::centred). Where the
/// target has other moduli than the source with this μ the map is the least-squares one, fits is false, and a warning
/// says so.
/// @param mu    #S in the samples' frames, |μ| < 1
/// @param start target_map(source, target, constraints, positions)
/// @throw Error bad_option (sizes; μ: samples where it is not finite or |μ| ≥ 1; a barrier from a folded start),
///        bad_boundary, not_solved, cancelled
SurfaceFlowMap surface_flow(const Surface& source, const Target& target, const Eigen::VectorXcd& mu,
                            const TargetConstraints& constraints, TargetMap start,
                            const SurfaceFlowOptions& options = {});

/// By what samples count in Lᵖ norms of |μ|.
struct LpNorm {
    double p = 2;                 ///< at least 2
    std::vector<double> weights;  ///< #S; empty: areas of the source
};

/// The map along a target, from a start that has no flips or is unfolded first, of least Σ W ψ^{p/2}, ψ = |μ|²/(1 −
/// |μ|²): the Lᵖ norm of |μ|, with a barrier against flips. p = 2 makes mean distortion small; the larger p is the more
/// even |μ| becomes. With the areas |φ| of the extremal map's quadratic differential as weights already p = 2 is the
/// extremal map; with areas of the surface no p is.
/// Source: Wong & Zhao 2014, section 5.4; Lᵖ there is by p = 2 weighed anew.
/// @throw Error bad_option (p, sizes, weights that are not positive), and as surface_flow
SurfaceFlowMap least_lp_map(const Surface& source, const Target& target, const LpNorm& norm,
                            const TargetConstraints& constraints, TargetMap start,
                            const SurfaceFlowOptions& options = {});

}  // namespace beltrami
