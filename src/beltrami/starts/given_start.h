#pragma once

#include <utility>
#include <vector>

#include <beltrami/starts/sliding_start.h>

namespace beltrami {

/// A given map, folded or not, as a start: every loop goes to its curve, its vertices to the nearest points there, in
/// order (plane/increasing.h); marked vertices to their places. What
/// is inside stays, so that the homotopy class is that of the map. Where conformal maps leave vertices free, none is
/// held yet (hold_what_conformal_maps_move()).
/// @param map    #V in the target's plane
/// @param wanted loops and marks on curves; loops that nothing pairs go to the curves that their vertices are nearest
/// to
/// @throw Error bad_option (sizes, numbers that are not finite), bad_boundary: another number of loops, two loops on
/// one
///        curve, a loop that does not run around its curve once
SlidingStart given_start(const Surface& source, const TargetDomain& target, const Eigen::VectorXcd& map,
                         const Correspondence& wanted = {});

/// @throw Error bad_option unless a map has a finite value for every vertex
void require_values(const Surface& source, const Eigen::VectorXcd& map);

/// One loop of that: its vertices at the nearest points of the curve, in order, and so that those which are held lie at
/// their places, vertices between moved along in proportion.
/// @param places (position in the loop, parameter on the curve) of what is held, in the order of the loop
/// @throw Error bad_boundary as given_start
SlidingLoop given_loop(const Surface& source, int loop, const TargetCurve& curve, const Eigen::VectorXcd& map,
                       const std::vector<std::pair<std::size_t, double>>& places);

}  // namespace beltrami
