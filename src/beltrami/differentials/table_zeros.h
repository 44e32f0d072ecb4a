#pragma once

#include <vector>

#include <beltrami/differentials/zeros_and_poles.h>

namespace beltrami {

/// zeros_and_poles of values at the samples.
/// @param phi   #S in the samples' frames
/// @param poles vertices at which there may be simple poles, ascending
std::vector<CriticalPoint> zeros_and_poles_of_table(const Surface& source, const Eigen::VectorXcd& phi,
                                                    const std::vector<int>& poles);

}  // namespace beltrami
