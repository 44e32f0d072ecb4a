#pragma once

#include <beltrami/base/public.h>
#include <beltrami/constraints/target_constraints.h>

namespace beltrami BELTRAMI_PUBLIC {

/// A map whose held vertices have been led to their places.
struct LedMap {
    TargetMap map;         ///< held vertices are where they were to go, arrived or not
    bool arrived = false;  ///< on the way no sample was flipped that was not before
    int flips = 0;         ///< samples that are flipped in map
    int rounds = 0;
};

/// Leads the vertices that are held from where a map has them to where another one does, and the others along: each
/// round by the harmonic extension of what is left of their ways, cut where a sample would flip, and then steps of
/// least distortion with the held ones at rest. So a start obeys curves and pins it knew nothing of, without folds, and
/// stays in its homotopy class.
/// @param constraints whose fixed and sliding vertices are led
/// @param from        #V points, on the target
/// @param to          target_map(source, target, constraints, …) of which the held vertices' points are used
/// @throw Error bad_option (sizes)
LedMap led_map(const Surface& source, const Target& target, const TargetConstraints& constraints, TargetMap from,
               const TargetMap& to, int most_rounds = 100);

}  // namespace beltrami
