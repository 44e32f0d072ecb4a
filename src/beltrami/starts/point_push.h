#pragma once

#include <vector>

#include <beltrami/operators/surface.h>

namespace beltrami {

/// Carries a map's inner vertices so that those in question come to their places and none of their surroundings folds:
/// each is pushed straight to its place, a disk about it that holds no other one and no boundary along with it, less
/// towards the rim of the disk. A harmonic map with such vertices would fold around them. Every push is an isotopy, so
/// that the ways of the points are the homotopy class.
/// @param vertices inside
/// @param places   of those
/// @param map      #V
/// @return whether all have come
bool push_points(const Surface& source, const std::vector<int>& vertices, const std::vector<Complex>& places,
                 Eigen::VectorXcd& map);

}  // namespace beltrami
