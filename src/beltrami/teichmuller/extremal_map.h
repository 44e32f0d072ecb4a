#pragma once

#include <optional>
#include <string>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/certificate/certificate.h>
#include <beltrami/charts/chart_places.h>
#include <beltrami/constraints/boundary_corners.h>
#include <beltrami/constraints/constraints.h>
#include <beltrami/constraints/prescribed_split.h>
#include <beltrami/differentials/quadratic_differential.h>
#include <beltrami/homotopy/homotopy.h>
#include <beltrami/plane/disk_moebius.h>
#include <beltrami/solve/map_result.h>
#include <beltrami/starts/sliding_loops.h>
#include <beltrami/teichmuller/extremal_options.h>
#include <beltrami/teichmuller/iteration.h>

namespace beltrami BELTRAMI_PUBLIC {

/// Whether a corner forces a K that is clearly larger, and the warning that says so.
bool corner_decides(const BoundaryCorner& corner, double K);
Warning corner_warning(const BoundaryCorner& corner);

/// A part of the surface that pinned curves cut off: a problem of its own.
struct ExtremalPiece {
    std::vector<int> faces;  ///< ascending
    double k = 0, K = 1, K_lower = 1, K_lower_proved = 1;
    Termination termination = Termination::converged;
};

/// The map as the metric of the iteration saw it, where that was the plane of the chart (chart_metric.h).
struct InChart {
    double chart_mean = 0;                    ///< mean |μ| of the chart itself on the surface
    double mean = 0, standard_deviation = 0;  ///< of |μ| of the map in the plane of the chart, by area there
    int degree = 0;                           ///< the largest degree of φ that mesh and rim resolve
};

/// What moving the boundary points has come to.
struct SlackReport {
    double slack = 0, largest_move = 0;          ///< in edges
    double energy_before = 0, energy_after = 0;  ///< of boundary_slack.h
    double K_without = 1;  ///< an estimate of K with the boundary values as they were given, by one step
};

/// What the noise of the outline costs, where it costs much.
struct NoiseCost {
    double slack = 0;         ///< if points moved by so many edges ...
    double K = 1;             ///< ... about this K were enough: an estimate by one step
    double energy_ratio = 1;  ///< E of boundary_slack.h at half that slack over E of the values as they are
};

/// The map of least dilatation among all that obey the constraints (of the same homotopy class), and how good it is.
///
/// Where edges had to be split, #V, #F and #S below are those of the split mesh.
struct ExtremalMap : MapResult {
    /// φ of the last c-step, known up to a positive factor; zero() where none is admissible and the map is conformal.
    /// Where pinned curves cut the surface, that of every piece, with a factor of its own, is tabulated over the whole
    /// (differential_of(values)).
    QuadraticDifferential differential;
    /// #S its values at the samples, in their frames, as the c-step had them: on large meshes interpolated, next to
    /// curves means over the sample; 0 where the chart excludes the sample.
    Eigen::VectorXcd phi;
    Eigen::VectorXcd
        harmonic;            ///< #V the harmonic map with the prescribed boundary values; empty where boundaries slide
    Eigen::VectorXcd start;  ///< #V the map from which the iteration began; empty where it began from φ
    /// An estimate of k* and K*: √(I⁺/I⁻) = (1+k)/(1−k) for the map and the φ of its c-step, with the quadrature of the
    /// bounds; where k is large, of a better map (solution_bounds.h).
    double k = 0, K = 1;
    double K_lower = 1;         ///< the largest lower bound of K*, proved or estimated; 1 if there is none
    double K_lower_proved = 1;  ///< the largest that is a proof up to floating point and quadrature
    double K_upper = 1;         ///< where boundaries slide: I⁺, near K* at the extremal φ, or what moduli prove
    double K_max = 0;           ///< largest K of a face; infinite if faces are flipped or collapsed
    std::vector<Bound> bounds;
    std::optional<SplitProblem> split;    ///< the mesh that was mapped, if it is not the source itself
    HomotopyClass homotopy;               ///< of map, where boundary values are prescribed
    std::vector<BoundaryCorner> corners;  ///< of source and boundary values, by decreasing significance
    /// The corner with the largest bound on K (of the limiting smooth data, noise discounted), if there is one.
    std::optional<BoundaryCorner> sharpest;
    double boundary_residual = 0;  ///< largest distance of a prescribed or marked vertex from its image
    std::optional<InChart> in_chart;
    std::optional<SlackReport> slack;
    std::optional<NoiseCost> noise;  ///< of a disk in space, without slack
    bool evened = false;             ///< |μ| was evened out after the iteration
    bool folds_removed = false;  ///< the iteration left flipped faces, which a fold-free solve with its φ and k removed
    /// Where pinned curves cut the surface: its pieces, by their first faces. The map is the extremal one of each, φ is
    /// one of each, and K, k and the bounds are the largest of theirs; history is that of the piece with the largest K.
    std::vector<ExtremalPiece> pieces;
    std::vector<Iteration> history;

    // Where boundaries slide:
    int dimension = 0;           ///< real, of the space of admissible differentials
    int expected_dimension = 0;  ///< by theory: 3·holes − 3 + marks from two holes on, 1 + marks, marks − 3
    double dimension_gap = 0;    ///< how clearly the dimension was told: a ratio of singular values or eigenvalues
    ExtremalOptions::Space space = ExtremalOptions::Space::laurent;  ///< how the space was found
    std::vector<LoopOnto> loops;                                     ///< in the order of the source's loops
    DiskMoebius move;            ///< of the source's circle domain before the holes were led to their places
    std::vector<Waypoint> path;  ///< the way of the holes, as in the correspondence; empty: straight
    bool led = false;            ///< the start was led along the way; else it is the harmonic map
    /// Faces that the harmonic map with the boundary of the start flips (on the coarse mesh, if there was one).
    int start_flips = 0;
    bool start_unfolded = false;  ///< folds of the start were opened before the iteration
    /// How far φ of the space are from real along what slides, as part of their size: largest ‖Im φ τ²‖/‖φ‖; 0 where
    /// it is not known.
    double reality = 0;
    double curve_residual = 0;  ///< largest distance of a vertex that slides from its curve

    // Onto a surface; the map is then one onto its circle domain:
    std::optional<CircleDomainChart> target_circles;  ///< that circle domain
    std::vector<MeshPoint> places;                    ///< #V places on the target's faces
    Positions positions;                              ///< #V their positions
};

/// The extremal quasiconformal (Teichmüller) map under constraints, by Hamilton's iteration with Anderson acceleration:
/// the c-step (dual_step.h) finds the quadratic differential φ and k of the present map, the f-step (map_step.h) the
/// map with coefficient k conj(φ)/|φ|. A conformal chart of a canonical domain serves to write φ down; the metric of ∂
/// and ∂̄ is the source's, or for a disk in space that of the chart's plane: k and the bounds are then those of the
/// plane, distortion and K_max those of the surface.
///
/// Prescribed boundary values: Weber, Myles & Zorin 2012 solve the same problem by alternating least squares; here φ is
/// holomorphic by construction and k is found from pairings, which are blind to the noise at the zeros of φ. Every
/// boundary vertex is prescribed; vertices inside may be. Without a start and turns, the homotopy class is that of the
/// harmonic map.
///
/// Boundaries that slide onto a domain of the same kind: every boundary loop goes to its curve, its points slide,
/// marked points go to marked places. Ng, Gu & Lui 2014 solve this problem; here it is the same iteration with the
/// finite-dimensional space of φ that are real along the boundary, and boundary vertices that move along the true
/// curves with a safeguard that keeps their order. The homotopy class is that of the way along which the start is led.
///
/// Onto a surface: extremal maps do not change when the target is changed conformally, so the map goes onto the
/// target's circle domain, and from there back to the target's faces.
/// @pre one component of genus 0 with a boundary
/// @throw Error bad_mesh, bad_boundary, not_solved, cancelled, bad_option
ExtremalMap extremal_map(const Surface& source, const Constraints& constraints, const ExtremalOptions& options = {});
ExtremalMap extremal_map(const Mesh& source, const Constraints& constraints, const ExtremalOptions& options = {});

}  // namespace beltrami
