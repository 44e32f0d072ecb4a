#pragma once

#include <vector>

#include <beltrami/constraints/target_constraints.h>

namespace beltrami {

/// Opens folds of a map to a target that neither its steps nor means open: patches of two rings
/// and more, are seen along the target's normals in the tangent plane at their middle and unfolded there
/// (fold_free.h), their rims at rest. Patches that turn away from that plane are left, of the sphere only those that
/// reach its other side, and so is what would be most of the surface.
/// @param held #V flags of vertices that stay
/// @return samples that are still flipped; no patch has more than it had
int unfold_flipped_patches(const Surface& source, const Target& target, const std::vector<char>& held, TargetMap& map);

}  // namespace beltrami
