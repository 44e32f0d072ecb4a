#pragma once

#include <vector>

#include <beltrami/operators/surface.h>

namespace beltrami {

/// Vertices inside around which the images of the faces wind more than once: there a map is not one-to-one although no
/// face need be flipped. Where the boundary is prescribed and simple a map without flipped faces has none; where it is
/// free it may.
/// @param map #V images
/// @return ascending
std::vector<int> branch_points(const Surface& source, const Eigen::VectorXcd& map);

}  // namespace beltrami
