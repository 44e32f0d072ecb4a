#pragma once

#include <array>

#include <beltrami/hyperbolic/hyperbolic_surface.h>

namespace beltrami::detail {

/// A walk in the hyperbolic Delaunay triangulation of a surface to the triangle that contains a point.
struct TargetWalk {
    int halfedge = -1;              ///< of that triangle; −1 if the walk does not end
    DiskIsometry frame;             ///< of the point, seen from the tail of the half-edge
    DiskIsometry way;               ///< from the tail of the first half-edge to that of the last
    std::array<double, 3> weights;  ///< projective, of the triangle's corners
};

/// @param frame seen from the tail of the half-edge
TargetWalk walk(const HyperbolicSurface& surface, int halfedge, const DiskIsometry& frame);

/// A half-edge of the Delaunay triangulation at every vertex; −1 where there is no triangle.
std::vector<int> first_halfedges(const HyperbolicSurface& surface);

}  // namespace beltrami::detail
