#pragma once

#include <beltrami/solve/sliding_boundary.h>
#include <beltrami/teichmuller/extremal_onto.h>

namespace beltrami {

/// What became of the loops.
/// @param curves of every loop of the source
std::vector<LoopOnto> loops_onto(const Surface& source, const SlidingBoundary& boundary, const std::vector<int>& curves,
                                 const Eigen::VectorXcd& map);

/// @throw Error not_solved if the image of a loop encloses less than half of what its curve does: it has collapsed
void require_not_collapsed(const std::vector<LoopOnto>& loops);

}  // namespace beltrami
