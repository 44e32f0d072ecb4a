#pragma once

#include <beltrami/teichmuller/extremal_mixed.h>

namespace beltrami {

/// Constraints that mix, loop by loop: the curve of each loop of which something slides.
///
/// Loops are paired with the target's curves as the correspondence says or, where it says nothing, by their circle
/// domains (loop_partners.h); holes that are prescribed
/// take the curves nearest to their images. Marks are vertices prescribed on their curves.
/// @param edge_length of a mesh of the target, for loops that are to be matched; 0: that of the source, relatively
/// @throw Error bad_boundary naming an arc that lies on no loop, or a loop that slides and has no curve; bad_option for
///        a target that is a surface, and for turns and waypoints, which mean nothing where boundaries slide
MixedConditions mixed_conditions(const Surface& source, const Constraints& constraints, double edge_length = 0);

}  // namespace beltrami
