#pragma once

#include <functional>

#include <beltrami/differentials/differential_space.h>

namespace beltrami {

/// Values ψ of differentials in the canonical domain, pulled back to points by φ = ψ(g) g′², chunk by chunk on all
/// threads.
/// @param functions number of columns
/// @param values    of all functions at places of the domain: #places × functions
/// @return #points × functions
Eigen::MatrixXcd pulled_back(const ChartPoints& points, Eigen::Index functions,
                             const std::function<Eigen::MatrixXcd(const Eigen::VectorXcd& places)>& values);

}  // namespace beltrami
