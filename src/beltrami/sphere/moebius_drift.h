#pragma once

#include <Eigen/Core>

#include <beltrami/mesh/mesh.h>

namespace beltrami {

/// A tangent motion of points of the unit sphere less what it has of Möbius maps, rotations and shifts, in the
/// least-squares sense: to first order it neither moves the centre of mass nor turns.
/// @param points  #V×3 unit vectors
/// @param weights #V, not negative
Positions without_moebius_drift(const Positions& points, const Positions& motion, const Eigen::VectorXd& weights);

}  // namespace beltrami
