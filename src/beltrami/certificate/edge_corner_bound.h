#pragma once

#include <vector>

#include <beltrami/constraints/boundary_condition.h>

namespace beltrami {

/// What the boundary values prove at one boundary vertex.
struct EdgeCornerBound {
    double K = 1;
    int vertex = -1;  ///< −1: none proves anything
};

/// The largest corner_bound() of a boundary vertex, with the slopes of the two edges beside it. The surface is a sector
/// at a vertex, its image another one, and the boundary values are linear on the two edges: blown up there, a map of
/// dilatation K tends to one of the whole sectors with these values, and the moduli of strips of them, in logarithmic
/// coordinates, bound its K. So this holds for the polygons and linear values exactly, not only for smooth data
/// that they are sampled from, however short the edges are.
/// @param map #V, of which the prescribed boundary vertices count
/// @pre the whole boundary is prescribed, its image bounds a domain on its left
EdgeCornerBound edge_corner_bound(const Surface& source, const Eigen::VectorXcd& map);
/// The bounds of all boundary vertices (#V), 1 inside.
std::vector<double> edge_corner_bounds(const Surface& source, const Eigen::VectorXcd& map);

}  // namespace beltrami
