#pragma once

#include <beltrami/teichmuller/extremal_map.h>

namespace beltrami {

/// What follows of a map that is affine in a conformal coordinate of the surface: φ, the square of ∂u with the sign
/// that the map's coefficient has, K in its bracket and the bounds.
/// @param result whose map and distortion are known
/// @param u      #V the real part of the coordinate
/// @param least, most the bracket of the ratio of the moduli, in either sense
void complete_direct(const Surface& source, const Eigen::VectorXd& u, double least, double most, ExtremalMap& result);

/// Takes a bracket of K* that moduli prove into a result: bounds, K and K_upper.
void record_moduli(double lower, double upper, ExtremalMap& result);

}  // namespace beltrami
