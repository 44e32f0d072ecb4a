#pragma once

#include <optional>

#include <beltrami/starts/sliding_start.h>
#include <beltrami/teichmuller/extremal_options.h>

namespace beltrami {

/// The start of a large problem: the extremal map of a coarse mesh of the source's circle domain, carried over. Its
/// boundary vertices are where they belong up to the error of the coarse mesh, and few steps are left for the fine one.
/// @return nothing where it would not pay (few vertices) or marks would have to be vertices of the coarse mesh
/// @throw Error as extremal_map
std::optional<SlidingStart> coarse_sliding_start(const Surface& source, const CircleDomainChart& chart,
                                                 const TargetModel& target, const Correspondence& wanted,
                                                 const ExtremalOptions& options);

}  // namespace beltrami
