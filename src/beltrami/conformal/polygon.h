#pragma once

#include <vector>

#include <beltrami/mesh/mesh.h>

namespace beltrami {

/// Signed area of a closed polygon, positive if counter-clockwise.
double signed_area(const std::vector<Complex>& polygon);

/// @throw Error bad_boundary for fewer than 3 points, repeated neighbours, clockwise order, or edges that meet (both
/// named)
void require_simple_polygon(const std::vector<Complex>& polygon);

}  // namespace beltrami
