#pragma once

#include <optional>

#include <beltrami/starts/sliding_start.h>

namespace beltrami {

/// A start for boundaries that slide where the even harmonic map has folds (even_start): in the class of that map the
/// harmonic one between the doubles of source and target in their metrics of curvature −1, which is a diffeomorphism
/// between smooth surfaces whatever the target's shape. Its boundary slides to where it belongs by itself, so that
/// neither turns of the loops nor a way of the holes are to be found first.
/// @param even        even_start()
/// @param edge_length of the mesh of the target
/// @return nothing where there are fewer than three loops, or where it has folds too: of meshes nothing is guaranteed
std::optional<SlidingStart> hyperbolic_sliding_start(const Surface& source, const TargetModel& target,
                                                     const SlidingStart& even, double edge_length);

}  // namespace beltrami
