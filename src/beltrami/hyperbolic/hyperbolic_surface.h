#pragma once

#include <vector>

#include <Eigen/Core>

#include <beltrami/base/public.h>
#include <beltrami/operators/surface.h>
#include <beltrami/plane/disk_isometry.h>
#include <beltrami/uniformize/intrinsic_triangulation.h>
#include <beltrami/uniformize/triangle_metric.h>

namespace beltrami BELTRAMI_PUBLIC {

/// A surface with its metric of curvature −1, written on edges: for every half-edge i → j the isometry that says where
/// j and its frame are, seen from the frame of i at 0. The product around every triangle is the identity; that along a
/// closed path is the deck transformation of its class.
///
/// A surface with a boundary has the metric of its double, in which the mirror is an isometry and the boundary
/// geodesic. The triangulations are those of the double, the surface's own triangles first
/// (IntrinsicTriangulation::doubled). The frame of a boundary vertex has the boundary for its real axis, the surface on
/// the left, and frames of mirror images are mirror images: the step along the image of a half-edge is the mirror image
/// of its step.
struct HyperbolicSurface {
    TriangleMetric metric;                     ///< the surface in triangles
    IntrinsicTriangulation original;           ///< as they are, or doubled
    IntrinsicTriangulation delaunay;           ///< after the flips: Delaunay in the hyperbolic metric
    std::vector<EdgeFlip> unfolded;            ///< flips from original to the Delaunay triangulation of the surface
    std::vector<EdgeFlip> ptolemy;             ///< and from there to delaunay
    Eigen::VectorXd log_scale;                 ///< #vertices u: 2 sinh(L_ij/2) = e^{(u_i+u_j)/2} l_ij
    std::vector<DiskIsometry> steps;           ///< #halfedges of original
    std::vector<DiskIsometry> delaunay_steps;  ///< #halfedges of delaunay
    int genus = 0;                             ///< of the surface or, where it has a boundary, of its double
    std::vector<int> mirror = {};              ///< #vertices of original: their mirror images; empty without a boundary
    int iterations = 0, factorizations = 0;
    double residual = 0;        ///< largest angle defect, radians
    double flatness = 0;        ///< largest distance from the identity of the product around a triangle of original
    std::vector<int> inverted;  ///< faces whose geodesic triangle runs clockwise: edges there had to be flipped

    /// The step across a half-edge of original.
    const DiskIsometry& step(int halfedge) const { return steps[static_cast<std::size_t>(halfedge)]; }
    bool has_boundary() const { return !mirror.empty(); }
    /// Triangles of the surface itself, the first ones of original.
    int own_triangles() const { return metric.triangles.size(); }
    /// Area of the triangles of delaunay: 4π(genus − 1) up to rounding.
    double area() const;
};

/// The metric of curvature −1 that is discretely conformally equivalent to the surface's own: scale factors u for which
/// the angles around every vertex add up to 2π, by Newton's method on a convex energy, with flips that keep the
/// triangulation Delaunay. These are undone on the steps, so that the edges are those of the surface again.
/// Source: Bobenko, Pinkall, Springborn 2015, "Discrete conformal maps and ideal polyhedra" (energy); Gu, Guo, Luo,
/// Sun, Wu 2018, "A discrete uniformization theorem for polyhedral surfaces II" (flips, existence, uniqueness).
/// @throw Error bad_mesh unless the surface is one component with a negative Euler characteristic; not_solved
HyperbolicSurface hyperbolic_surface(const Surface& surface);

/// Lengths of the boundary loops, which are closed geodesics.
std::vector<double> boundary_lengths(const HyperbolicSurface& metric, const Topology& topology);

/// @throw Error bad_mesh naming a face that is not a triangle
void require_triangles(const Surface& surface);

}  // namespace beltrami
