#pragma once

#include <array>
#include <vector>

#include <beltrami/mesh/mesh.h>

namespace beltrami {

/// The triangles that stand for a polygon in space, running around as it does: the constrained Delaunay triangulation
/// of its projection along its vector area; where that projection crosses or touches itself, or the polygon is no more
/// than a line, the fan around corner 0. Time n log n.
/// @param corners n×2 or n×3, n ≥ 3
/// @return n − 2 triples of corners
std::vector<std::array<int, 3>> split_polygon(const Positions& corners);

}  // namespace beltrami
