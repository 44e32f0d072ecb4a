#pragma once

#include <Eigen/Core>

#include <beltrami/mesh/mesh.h>

namespace beltrami {

/// Q ↦ (1 − |c|²)(Q + c)/|Q + c|² + c: the Möbius map of the sphere that takes −c to the centre of the ball.
/// @param points #V×3 unit vectors
/// @pre |c| < 1
Positions moebius_shifted(const Positions& points, const Eigen::RowVector3d& c);

}  // namespace beltrami
