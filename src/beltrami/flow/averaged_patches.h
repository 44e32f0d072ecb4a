#pragma once

#include <vector>

#include <beltrami/constraints/target_constraints.h>

namespace beltrami {

/// Opens folds of a map to a target that its steps do not: vertices around flipped samples, in patches of one ring and
/// more, go to the means of their neighbours (Tutte 1963) with the rim of the patch at rest, and back to the target.
/// Each patch by itself; the first width at which fewer samples are flipped is kept.
/// @param held #V flags of vertices that stay
/// @return samples that are still flipped; the map is as it was where no width helps
int average_flipped_patches(const Surface& source, const Target& target, const std::vector<char>& held, TargetMap& map);

}  // namespace beltrami
