#pragma once

#include <span>

#include <Eigen/Core>

#include <beltrami/mesh/mesh.h>

namespace beltrami {

/// Points of the sphere after the Möbius map that brings some of them as near as it can to where they are wanted: the
/// one of least Σ w |image − wanted|² that is found by steps of Gauss and Newton, damped as Levenberg and Marquardt do,
/// from the best rotation. Up to three distinct points reach their places.
/// @param points    #V×3 unit vectors
/// @param landmarks those that are wanted somewhere
/// @param wanted    #landmarks×3 unit vectors
Positions moebius_fitted(Positions points, std::span<const int> landmarks, const Positions& wanted);

/// The rotation R of least Σ |R a_i − b_i|², rows being the points. Source: Kabsch 1976.
Eigen::Matrix3d best_rotation(const Positions& a, const Positions& b);

}  // namespace beltrami
