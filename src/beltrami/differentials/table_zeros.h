#pragma once

#include <vector>

#include <beltrami/differentials/zeros_and_poles.h>

namespace beltrami {

/// zeros_and_poles of values at the samples.
/// @param phi   #S in the samples' frames
/// @param poles vertices at which there may be simple poles, ascending
/// @param real  φ was found as one that is real along boundary loops; else these are looked at
std::vector<CriticalPoint> zeros_and_poles_of_table(const Surface& source, const Eigen::VectorXcd& phi,
                                                    const std::vector<int>& poles, bool real);

}  // namespace beltrami
