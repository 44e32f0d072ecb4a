#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <beltrami/certificate/certificate.h>
#include <beltrami/constraints/boundary_condition.h>
#include <beltrami/constraints/boundary_corners.h>
#include <beltrami/constraints/prescribed_split.h>
#include <beltrami/homotopy/continuation.h>
#include <beltrami/homotopy/homotopy.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/teichmuller/hamilton.h>

namespace beltrami {

struct ExtremalOptions {
    /// Stop when |Δk| and the change of the direction of φ are below this. Where φ is singular (corners, pins) and the
    /// map is to be evened out, which moves φ further, 0.03 and its square will do.
    double tolerance = 1e-8;
    int max_iterations = 60;   ///< linear solves
    double growth = 1e-5;      ///< the space of differentials grows while that raises k by more than this part
    int anderson_window = 5;   ///< 0: plain iteration
    int cluster_count = 1500;  ///< quadrature points of the c-step on large meshes, at least 100
    int outer_loop = 0;        ///< the boundary loop whose image encloses the others
    /// Turns of every boundary loop against the outer one (homotopy.h), one number per loop, that of the outer loop not
    /// used. Empty: those of the harmonic map, or of the start.
    std::vector<int> turns;
    /// A map to start from (#V) instead of the harmonic one, for instance one of another homotopy class; prescribed
    /// vertices are put in their places. Where the map that comes of it is folded, all begins again without it, and a
    /// warning says so.
    std::optional<Eigen::VectorXcd> start;
    /// Start from the map that is led along the way of the holes through these places (continuation.h; none: straight
    /// ways), which fixes how the holes braid and turn. The way begins at the source itself where it lies in the plane
    /// and outer_loop is its outer loop, else at its chart. Not together with a start or turns.
    std::optional<std::vector<Waypoint>> waypoints;
    /// Split edges and faces that the prescribed vertices nail down (prescribed_split.h): no solver can repair them.
    bool split_prescribed = true;
    /// Even |μ| out after the iteration (even_dilatation.h): where the map is still far from |μ| = k, always or never.
    enum class Evening { where_needed, always, never };
    Evening evening = Evening::where_needed;
    bool remove_folds = true;  ///< finish with a fold-free solve where faces are flipped
    /// Midpoint subdivisions of the mesh for a bound by piecewise quadratic maps (sharpened_bound.h), which is far
    /// better where K is large or the mesh coarse. Empty: 0 from k = .8 on, and on meshes of up to 10⁵
    /// samples where the bracket is wider than 1 %, else none; negative: never.
    std::optional<int> sharpen;
    /// Called once per iteration with its number and k; returning false cancels (Error cancelled).
    std::function<bool(int iteration, double k)> progress;

    /// @throw Error bad_option naming the first impossible value
    void validate() const;
};

/// The part of the options that the iteration takes.
HamiltonIteration::Options iteration_options(const ExtremalOptions& options);

enum class Termination {
    converged,        ///< k and φ have settled
    iteration_limit,  ///< max_iterations
    /// Settled, but at a boundary vertex the boundary values alone force a larger dilatation than the K found: the
    /// extremal map is not of Teichmüller type and not unique.
    not_teichmuller,
};
const char* to_string(Termination);

/// Whether a corner forces a K that is clearly larger, and the sentence that says so.
bool corner_decides(const BoundaryCorner& corner, double K);
std::string corner_warning(const BoundaryCorner& corner);

/// A part of the surface that pinned curves cut off: a problem of its own.
struct ExtremalPiece {
    std::vector<int> faces;  ///< ascending
    double k = 0, K = 1, K_lower = 1;
    Termination termination = Termination::converged;
};

/// The map of least dilatation among all with the same boundary values (of the same homotopy class), and how good it
/// is.
///
/// Where edges had to be split, #V, #F and #S below are those of the split mesh.
struct ExtremalMap {
    Eigen::VectorXcd map;  ///< #V images
    Eigen::VectorXcd phi;  ///< #S quadratic differential in the samples' frames; 0 where the chart excludes the sample
    Eigen::VectorXcd harmonic;  ///< #V the harmonic start
    Distortion distortion;      ///< of map
    /// An estimate of k* and K*: √(I⁺/I⁻) = (1+k)/(1−k) for the map and the φ of its c-step, with the quadrature of the
    /// bounds; where k is large, of a better map (solution_bounds.h).
    double k = 0, K = 1;
    double K_lower = 1;  ///< largest Reich-Strebel bound; 1 if there is none
    double K_max = 0;    ///< largest K of a face; infinite if faces are flipped or collapsed
    std::vector<Bound> bounds;
    std::optional<SplitProblem> split;    ///< the mesh that was mapped, if it is not the source itself
    HomotopyClass homotopy;               ///< of map
    std::vector<BoundaryCorner> corners;  ///< of source and boundary values, by decreasing significance
    /// The corner with the largest bound on K (of the limiting smooth data, noise discounted), if there is one.
    std::optional<BoundaryCorner> sharpest;
    double boundary_residual = 0;  ///< largest distance of a prescribed vertex from its image
    Termination termination = Termination::converged;
    int iterations = 0;          ///< linear solves after the harmonic one, those from a start given up included
    int factorizations = 0;      ///< of #V×#V systems and larger, chart included
    bool evened = false;         ///< |μ| was evened out after the iteration
    bool folds_removed = false;  ///< the iteration left flipped faces, which a fold-free solve with its φ and k removed
    /// Where pinned curves cut the surface: its pieces, by their first faces. The map is the extremal one of each, φ is
    /// one of each, and K, k and the bounds are the largest of theirs; history is that of the piece with the largest K.
    std::vector<ExtremalPiece> pieces;
    std::vector<Iteration> history;
    std::vector<std::string> warnings;

    /// Whether no face is flipped or collapsed: with a simple boundary polygon the map is then one-to-one.
    bool one_to_one() const { return distortion.flipped.empty() && distortion.degenerate.empty(); }
};

/// The extremal quasiconformal (Teichmüller) map with prescribed boundary values, by Hamilton's iteration with Anderson
/// acceleration: the c-step (dual_step.h) finds the quadratic differential φ and k of the present map, the f-step
/// (beltrami_solver.h) the map with coefficient k conj(φ)/|φ|. The metric of the source stays in ∂ and ∂̄; a conformal
/// chart of a canonical domain only serves to write φ down. Weber, Myles & Zorin 2012 solve the same problem by
/// alternating least squares; here φ is holomorphic by construction and k is found from pairings, which are blind to
/// the noise at the zeros of φ.
///
/// Without a start and turns, the homotopy class is that of the harmonic map.
/// @pre one component of genus 0, every boundary vertex is prescribed; vertices inside may be
/// @throw Error bad_mesh, bad_boundary, not_solved, cancelled, bad_option
ExtremalMap extremal_map(const Surface& source, const BoundaryCondition& boundary, const ExtremalOptions& options = {});
ExtremalMap extremal_map(const Mesh& source, const BoundaryCondition& boundary, const ExtremalOptions& options = {});

}  // namespace beltrami
