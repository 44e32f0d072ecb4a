#pragma once

#include <vector>

#include <Eigen/Core>

#include <beltrami/base/complex.h>

namespace beltrami {

/// What samples count for in a step towards k conj(φ)/|φ|, of sum 1 and a little: their part of ∫|φ|, and in any case
/// 5 % of their area, since where φ vanishes faces would be left to flip.
/// @param areas, phi #S
std::vector<double> weights_of_differential(const std::vector<double>& areas, const Eigen::VectorXcd& phi);

}  // namespace beltrami
