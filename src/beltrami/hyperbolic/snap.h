#pragma once

#include <beltrami/hyperbolic/equivariant_map.h>

namespace beltrami {

/// Takes away what rounding has done to a map's class: every step becomes the product of the target's steps along the
/// walk that it describes, which is exact, as the steps of a map told by long words are not. Bases are then corners of
/// the triangles in which the images lie. Where edges are short, as those of harmonic maps are, nothing else changes.
/// @return the largest change of a step, from the identity; infinity where a walk does not end at the next image
double snap_to_target(const Surface& source, const HyperbolicSurface& target, EquivariantMap& map);

}  // namespace beltrami
