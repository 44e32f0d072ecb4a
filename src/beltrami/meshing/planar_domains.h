#pragma once

#include <Eigen/Core>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/mesh/mesh.h>
#include <beltrami/meshing/delaunay.h>
#include <beltrami/meshing/jitter.h>

namespace beltrami BELTRAMI_PUBLIC {

struct Circle {
    Eigen::Vector2d centre = Eigen::Vector2d::Zero();
    double radius = 1.0;
};

using Polygon = std::vector<Eigen::Vector2d>;

/// A point near which the edges are to be shorter.
struct SizeSource {
    Eigen::Vector2d point;
    double edge_length;
};

/// Edge lengths of a planar domain. The wanted length at a place is the smallest of all that apply; away from holes,
/// sources and corners it grows by @ref grading per unit of distance until it reaches edge_length.
struct DomainOptions {
    double edge_length = 0.05;
    double hole_edge_length = 0.0;    ///< at the holes; 0 = edge_length
    double corner_edge_length = 0.0;  ///< at the corners of polygons; 0 = edge_length
    double grading = 0.3;             ///< 0 < grading ≤ 1
    std::vector<SizeSource> sources = {};
    SizeField size = {};                                ///< a further bound; may be empty
    int least_hole_edges = 16;                          ///< a round hole has at least so many edges, at least 6
    std::vector<Eigen::Vector2d> interior_points = {};  ///< places that must be vertices
    double min_angle = 0.489;                           ///< radians, see TriangulateOptions
    bool split_ears = true;                             ///< see TriangulateOptions
    int smoothing_passes = 6;                           ///< see TriangulateOptions
    JitterOptions jitter = {};
    /// @throw Error bad_option if a value is impossible
    void validate() const;
};

/// A disk with round holes. Boundary vertices lie exactly (to rounding) on their circles; jitter slides them along.
/// Vertices: interior_points first, then the others.
/// @return #V×2 mesh, counter-clockwise
/// @throw Error bad_option naming the hole that touches or leaves the outer circle or touches another one
Mesh circle_domain(const Circle& outer, const std::vector<Circle>& holes, const DomainOptions& options = {});

/// A polygon with polygonal holes, each given in either direction, without repeating the first corner.
/// Vertices: the corners of the outer polygon, those of the holes in order, interior_points, then the others; jitter
/// leaves the boundary and interior_points where they are.
/// @return #V×2 mesh, counter-clockwise
/// @throw Error bad_option if sides cross, corners coincide or a hole lies outside
Mesh polygon_domain(const Polygon& outer, const std::vector<Polygon>& holes = {}, const DomainOptions& options = {});

}  // namespace beltrami
