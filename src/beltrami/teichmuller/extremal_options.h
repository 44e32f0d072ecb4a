#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include <beltrami/base/complex.h>
#include <beltrami/base/iteration_options.h>
#include <beltrami/base/public.h>

namespace beltrami BELTRAMI_PUBLIC {

class Shape;

/// How an extremal problem is solved.
struct ExtremalOptions : IterationOptions {
    // tolerance: stop when the change of the direction of φ is below this, and |Δk| below it too (where boundaries
    // slide: below a hundredth of it). 0: 1e-8 with prescribed boundary values, and 1e-5 for φ where it is smooth on a
    // disk, 1e-6 where boundaries slide. Where φ is singular and the map is to be evened out, 0.03 and its square do.

    double growth = 1e-5;      ///< the space of differentials grows while that raises k by more than this part
    int cluster_count = 1500;  ///< quadrature points of the c-step on large meshes, at least 100
    /// A map to start from (#V) instead of the harmonic one, for instance one of another homotopy class; prescribed
    /// vertices are put in their places, those that slide on the nearest points of their curves, in order. Where the
    /// map that comes of it is folded, or where boundaries slide does not settle, all begins again without it, and a
    /// warning says so. Onto a surface it is a map to the surface's circle domain.
    std::optional<Eigen::VectorXcd> start;
    /// Split edges and faces that the prescribed vertices nail down (prescribed_split.h): no solver can repair them.
    bool split_prescribed = true;
    /// Surfaces that take part, source or target, whose charts are kept for further problems; each is asked for its own
    /// instead of one being made.
    std::vector<const Shape*> shapes;
    /// Even |μ| out after the iteration (even_dilatation.h): where the map is still far from |μ| = k, always or never.
    /// Where the boundary slides, in part or as a whole, only always does; sliding vertices then keep their places.
    enum class Evening { where_needed, always, never };
    Evening evening = Evening::where_needed;
    /// Whether a disk in space is solved in the plane of its chart (chart_metric.h) and measured on the surface: K is
    /// then that of the boundary values as φ of the degree sees them that the rim resolves. Empty: with slack, and
    /// where the noise that linear elements near a coarse rim have in the surface's metric is more than 3 % of k, as on
    /// most scans: k of the chart itself, of which the truth is 0. Planar meshes have the one metric.
    std::optional<bool> chart_metric;
    /// Boundary points of a disk may move along the target by so many edges (boundary_slack.h), where the outline is
    /// not known better.
    double slack = 0;
    bool remove_folds = true;  ///< finish with a fold-free solve where faces are flipped
    /// Midpoint subdivisions of the mesh for a bound by piecewise quadratic maps (sharpened_bound.h), which is far
    /// better where K is large or the mesh coarse. Empty: 0 from k = .8 on, and on meshes of up to 10⁵
    /// samples where the bracket is wider than 1 %, else none; negative: never.
    std::optional<int> sharpen;
    /// The bounds by moduli and by pairs of piecewise linear functions (proved_bounds.h), which cost about four
    /// factorisations and a hundred solves: always, never, or, if empty, on meshes of up to 5000 faces unless sharpen
    /// is negative.
    std::optional<bool> prove;

    // Where boundaries slide:

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
    /// Every loop's vertices start so many radians ahead of where they would (one number per loop of the source; empty:
    /// none). The result does not depend on it.
    std::vector<double> start_turns;
    /// Whether it is found where on the faces of a target mesh vertices go (ExtremalMap::places, positions).
    bool places = true;

    /// @throw Error bad_option naming the first impossible value
    void validate() const;
};

const char* to_string(ExtremalOptions::Space);

}  // namespace beltrami
