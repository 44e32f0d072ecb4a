#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include <beltrami/charts/chart_places.h>
#include <beltrami/charts/circle_matching.h>
#include <beltrami/homotopy/continuation.h>
#include <beltrami/targets/marks.h>
#include <beltrami/teichmuller/extremal_map.h>

namespace beltrami {

struct OntoOptions {
    /// Stop when the change of the direction of φ is below this, and |Δk| below a hundredth of it. The error of the
    /// mesh is far larger.
    double tolerance = 1e-6;
    int max_iterations = 60;  ///< linear solves
    int anderson_window = 5;  ///< 0: plain iteration
    int outer_loop = 0;       ///< the boundary loop of the source that goes to the target's outer curve
    /// Pairs (loop of the source, curve of the target: 0 the outer one, then the holes from 1). Empty: matched.
    std::vector<std::array<int, 2>> loops;
    MatchBy match_by = MatchBy::position;
    std::vector<Mark> marks;  ///< boundary vertices of the source that go to places of the target's curves
    /// Onto a surface instead: pairs (boundary vertex of the source, boundary vertex of the target).
    std::vector<std::array<int, 2>> mark_vertices;
    /// The holes are led through these places (continuation.h), in the target's plane where its curves are circles,
    /// else in the unit disk of its model: that fixes how they braid. Nothing: straight ways, or none at all where the
    /// harmonic map is free of folds.
    std::optional<std::vector<Waypoint>> waypoints;
    /// Every loop's vertices start so many radians ahead of where they would (one number per loop of the source; empty:
    /// none). The result does not depend on it.
    std::vector<double> start_turns;
    /// How the admissible differentials are found: by L² projection on the source's mesh (projected_space.h), which has
    /// the errors of the mesh just as the maps have, by Laurent series on the circle domain of the source
    /// (laurent_space.h), which are exact there, or, for a disk with four marks, as the square of a 1-form
    /// (one_form_squares.h), which is at home in corners. automatic: the second for round disks and annuli in the
    /// plane, the third for other disks with four marks, else the first.
    enum class Space { automatic, projection, laurent, one_form_squares };
    Space space = Space::automatic;
    /// Large problems without marks start from the extremal map of a coarse mesh of the source's circle domain.
    bool coarse_start = true;
    double target_edge_length = 0;  ///< of the mesh of a target that is not round; 0: that of the source, relatively
    bool remove_folds = true;       ///< finish with a fold-free solve where faces are flipped
    /// Called once per iteration with its number and k; returning false cancels (Error cancelled).
    std::function<bool(int iteration, double k)> progress;

    /// @throw Error bad_option naming the first impossible value
    void validate() const;
};

const char* to_string(OntoOptions::Space);

/// A boundary loop and what became of it.
struct LoopOnto {
    int loop = 0;                    ///< of the source's boundary loops
    int curve = 0;                   ///< of the target
    std::vector<double> parameters;  ///< arc length on the curve of every vertex of the loop, ascending
    double area_ratio = 0;  ///< area within the image polygon over that within the curve: near 1 if it runs around once
};

/// The extremal map onto a target whose boundary slides, and how good it is.
///
/// Where edges had to be split, #V, #F and #S below are those of the split mesh.
struct ExtremalMapOnto {
    Eigen::VectorXcd map;    ///< #V images in the target's plane
    Eigen::VectorXcd start;  ///< #V the map from which the iteration began
    Eigen::VectorXcd phi;    ///< #S quadratic differential in the samples' frames
    Distortion distortion;   ///< of map
    double k = 0, K = 1;     ///< estimates of k* and K*: √(I⁺/I⁻) = (1+k)/(1−k)
    double K_lower = 1;      ///< 1/I⁻, to which K* is at least as large but for the errors of φ and of the boundary
    double K_upper = 1;      ///< I⁺, from which K* is not far above at the extremal φ
    double K_max = 0;        ///< largest K of a face; infinite if faces are flipped or collapsed
    std::vector<Bound> bounds;
    int dimension = 0;           ///< real, of the space of admissible differentials
    int expected_dimension = 0;  ///< by theory: 3·holes − 3 + marks from two holes on, 1 + marks, marks − 3
    double dimension_gap = 0;    ///< how clearly the dimension was told: a ratio of singular values or eigenvalues
    OntoOptions::Space space = OntoOptions::Space::laurent;  ///< how the space was found
    std::vector<LoopOnto> loops;                             ///< in the order of the source's loops
    DiskMoebius move;            ///< of the source's circle domain before the holes were led to their places
    std::vector<Waypoint> path;  ///< the way of the holes, as in options; empty: straight
    bool led = false;            ///< the start was led along the way; else it is the harmonic map
    /// Faces that the harmonic map with the boundary of the start turns over (on the coarse mesh, if there was one).
    int start_flips = 0;
    std::optional<SplitProblem> split;  ///< the mesh that was mapped, if it is not the source itself
    double boundary_residual = 0;       ///< largest distance of a marked vertex from its place
    Termination termination = Termination::converged;
    int iterations = 0;
    int factorizations = 0;
    bool folds_removed = false;
    std::vector<Iteration> history;
    std::vector<std::string> warnings;

    bool one_to_one() const { return distortion.flipped.empty() && distortion.degenerate.empty(); }
};

/// The extremal quasiconformal map of a surface of genus 0 with boundary onto a domain of the same kind: every boundary
/// loop goes to its curve, its points slide, marked points go to marked places. Ng, Gu & Lui 2013 solve this problem;
/// here it is the iteration of extremal_map.h with the finite-dimensional space of φ that are real along the boundary,
/// and boundary vertices that move along the true curves with a safeguard that keeps their order.
///
/// The homotopy class is that of the way along which the start is led (options.waypoints).
/// @throw Error bad_mesh, bad_boundary, bad_option, not_solved, cancelled
ExtremalMapOnto extremal_map(const Surface& source, const TargetDomain& target, const OntoOptions& options = {});

/// The same onto a surface, in the plane or in space.
struct ExtremalMapOntoSurface {
    ExtremalMapOnto plane;          ///< onto the circle domain of the target
    CircleDomainChart target;       ///< that circle domain
    std::vector<MeshPoint> places;  ///< #V places on the target's faces
    Positions positions;            ///< #V their positions
};

/// Extremal maps do not change when the target is changed conformally: the map goes onto the target's circle domain,
/// and from there back to the target's faces.
/// @param target  one component of genus 0 with as many boundary loops as the source. options.loops pairs loops with
/// its
///                boundary loops, marks are options.mark_vertices; loops of the result name curves of the circle domain
/// @param outer   the boundary loop of the target to which the outer loop of the source goes
ExtremalMapOntoSurface extremal_map(const Surface& source, const Surface& target, const OntoOptions& options = {},
                                    int outer = 0);

/// What the options become where the target's circle domain stands for a target that is a surface: loops are paired
/// with its curves, mark_vertices are marks on them.
/// @throw Error bad_option for marks on curves or a loop that the target has not; bad_boundary for a vertex that is not
///        on its boundary
OntoOptions options_on_circles(const OntoOptions& options, const Surface& target, const CircleDomainChart& chart);

}  // namespace beltrami
