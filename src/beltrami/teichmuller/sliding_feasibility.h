#pragma once

#include <beltrami/teichmuller/mixed_start.h>

namespace beltrami {

/// Refuses mixed conditions that no one-to-one, orientation-preserving map obeys: what require_feasible() of
/// boundary_feasibility.h refuses of the prescribed vertices alone, prescribed vertices on or beyond the image of a
/// loop that slides, and sliding loops that lie on the wrong side of another loop.
/// @param loops of those that slide, where the prescribed vertices of each stand; the image of a loop does not depend
///              on the places of the others
/// @throw Error bad_boundary naming vertices
void require_feasible(const Surface& source, const MixedBoundary& boundary, const std::vector<SlidingLoop>& loops,
                      int outer_loop);

}  // namespace beltrami
