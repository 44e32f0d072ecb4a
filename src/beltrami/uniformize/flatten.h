#pragma once

#include <vector>

#include <Eigen/Core>

#include <beltrami/base/public.h>
#include <beltrami/mesh/mesh.h>

namespace beltrami BELTRAMI_PUBLIC {

/// What flatten() does at the boundary, and when it stops.
struct FlattenOptions {
    /// Interior angles of the image polygon, radians: one per vertex of boundary loop 0 of topology(), in its order,
    /// each positive, summing to (n − 2)π. Empty: the natural boundary, where the scale factor is 1, so that boundary
    /// edges keep their lengths; of all conformal maps this one changes areas least.
    std::vector<double> boundary_angles;
    double tolerance = 1e-10;  ///< largest angle defect that is left, radians
    int max_iterations = 100;  ///< Newton steps altogether

    /// @throw Error bad_option
    void validate() const;
};

/// A flattening and what is to be known about it. It holds exactly for the surface as a metric; the straight triangles
/// drawn between the image points agree with it up to the edges that had to be flipped.
struct Flattening {
    Eigen::VectorXcd positions;  ///< #V points of the plane; 0 at vertices without faces
    Eigen::VectorXd log_scale;   ///< #V logarithm u of the scale factor: lengths become l_ij e^{(u_i+u_j)/2}
    std::vector<int> flipped;    ///< faces that come out flipped or without area between their image points
    int iterations = 0;          ///< Newton steps
    int factorizations = 0;
    int flips = 0;            ///< intrinsic edge flips
    int boundary_splits = 0;  ///< vertices that were put on boundary edges, see flatten()
    double lengthened = 0;    ///< length added to every edge to give triangles without area some; 0 as a rule
    double residual = 0;      ///< largest angle defect left, radians
    double layout_error = 0;  ///< largest mismatch of a length in the drawing, relative to the drawing's diameter
};

/// Flattens a disk-like surface by discrete conformal equivalence: scale factors at the vertices make every interior
/// angle sum 2π, found by Newton's method on a convex energy while intrinsic edge flips keep the scaled metric
/// Delaunay. Counter-clockwise faces come out with positive area. The unit of length is the source's.
///
/// - The result depends on the surface only, not on how it is triangulated: edges are flipped to intrinsic Delaunay
/// first.
/// - A quad is split by split_quad(); a plane quad is not affected by the choice.
/// - Boundary edges cannot flip. Where a triangle would degenerate against one, a vertex is put on that edge, of scale
///   1 (or angle π), and the iteration goes on; these vertices are counted and not returned.
/// - Triangles without area (or coinciding vertices) make all edges longer by about 1e-10 of their mean (Sharp, Crane
/// 2020,
///   "A Laplacian for nonmanifold triangle meshes", intrinsic mollification); the amount is returned.
/// - A planar mesh with its natural boundary is its own flattening: the coordinates are returned as they are
///   (conjugated if all faces are clockwise). With boundary angles the scale is fixed by the length of the boundary.
/// - The tolerance is missed only where rounding allows no smaller defect, and by no more than 1e-6; residual tells.
///
/// Source: Springborn, Schröder, Pinkall 2008, "Conformal equivalence of triangle meshes"; Gillespie, Springborn, Crane
/// 2021, "Discrete conformal equivalence of polyhedral surfaces"; Gu, Luo, Sun, Wu 2018, "A discrete uniformization
/// theorem for polyhedral surfaces" (existence and uniqueness, of the closed case).
/// @pre diagnose(surface) has no fatal finding
/// @throw Error bad_option for impossible options; bad_boundary for boundary angles of the wrong number, sign or sum;
///        bad_mesh unless the surface is one component of genus 0 with one boundary loop; not_solved if the iteration
///        does not converge or boundary triangles stay degenerate (faces along the boundary are then far too large for
///        the curvature next to them)
Flattening flatten(const Mesh& surface, const FlattenOptions& options = {});

/// The same in a metric of its own, in which every face has the shape of its corners in @p corners, one point per face
/// corner (#corners×2 or ×3), as operators_from_corners() takes it; the positions of the surface do not matter. Where
/// the two faces of an edge differ about its length, through rounding or differently scaled texture seams, it has the
/// mean length. Boundary edges keep the lengths of the metric, and so does the unit of length; log_scale is relative to
/// the metric. A planar metric is not returned as it is but laid out anew, up to a rigid motion.
/// @throw Error as above; also bad_mesh if @p corners has another shape or is not finite, and naming faces where mean
///        lengths violate the triangle inequality (by less than 1e-4 they are mollified like triangles without area)
Flattening flatten(const Mesh& surface, const Positions& corners, const FlattenOptions& options = {});

}  // namespace beltrami
