#pragma once

#include <beltrami/maps/sliding_boundary.h>
#include <beltrami/teichmuller/extremal_onto.h>

namespace beltrami {

/// Holds as many vertices as conformal maps of a domain to itself leave free, those that are held already counted: one
/// of an annulus, three of a disk, none where there are two or more holes. They are vertices of the outer loop that
/// share its curve as evenly as may be.
/// @param loops one for every boundary loop
/// @param outer the loop that goes to the outer curve
void hold_what_conformal_maps_move(const Surface& source, std::vector<SlidingLoop>& loops, int outer);

/// What became of the loops.
/// @param curves of every loop of the source
std::vector<LoopOnto> loops_onto(const Surface& source, const SlidingBoundary& boundary, const std::vector<int>& curves,
                                 const Eigen::VectorXcd& map);

/// @throw Error not_solved if the image of a loop encloses less than half of what its curve does: it has collapsed
void require_not_collapsed(const std::vector<LoopOnto>& loops);

}  // namespace beltrami
