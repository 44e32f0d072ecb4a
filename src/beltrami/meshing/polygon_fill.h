#pragma once

#include <array>
#include <vector>

#include <beltrami/mesh/mesh.h>

namespace beltrami {

/// Triangles that fill a polygon and meet its sides edge to edge.
struct PolygonFill {
    std::vector<Complex> added;                 ///< vertices inside; numbered after the corners
    std::vector<std::array<int, 3>> triangles;  ///< counter-clockwise
};

/// Fills a simple polygon. Every corner becomes a vertex and no side is split; triangles grow away from the sides, so
/// that n sides cost a multiple of n triangles. No triangle edge joins two corners but the sides themselves (a chord
/// might be an edge of the mesh already that the polygon is a hole of).
/// @pre simple, counter-clockwise, at least 3 corners
/// @throw Error bad_option, not_solved as triangulate()
PolygonFill fill_polygon(const std::vector<Complex>& corners);

/// The convex polygon with the given side lengths whose corners lie on a circle about 0; corner i starts side i,
/// counter-clockwise from the positive real axis.
/// @return empty where the sides cannot close, or the centre would lie outside the polygon
std::vector<Complex> cyclic_polygon(const std::vector<double>& lengths);

}  // namespace beltrami
