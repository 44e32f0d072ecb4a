#pragma once

#include <Eigen/Core>

#include <beltrami/base/public.h>
#include <beltrami/mesh/mesh.h>

namespace beltrami BELTRAMI_PUBLIC {

/// True if the faces of a planar mesh run clockwise: their signed areas have a negative sum.
/// @pre is_planar(mesh), indices in range
bool seen_from_below(const Mesh& mesh);

/// x + iy of every vertex, seen from the side from which the faces run counter-clockwise: conjugated if
/// seen_from_below().
/// @pre is_planar(mesh), indices in range
Eigen::VectorXcd planar_coordinates(const Mesh& mesh);

/// Points moved and scaled uniformly so that their bounding box lies in [0, 1]², at 0, its longer side from 0 to 1.
/// @param points n×2, finite
Positions fitted_to_unit_square(const Positions& points);

}  // namespace beltrami
