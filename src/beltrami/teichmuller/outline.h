#pragma once

#include <functional>
#include <optional>

#include <beltrami/teichmuller/boundary_slack.h>
#include <beltrami/teichmuller/extremal_map.h>

namespace beltrami {

/// What the noise of the outline of a disk costs, where it costs much: an outline of many vertices, of which little of
/// the energy of boundary_slack.h is left with slack.
/// @param K_with an estimate of K with other boundary values
/// @return nothing for quiet outlines, and where the boundary values do not run forward
std::optional<NoiseCost> noise_of_outline(const Surface& source, const Chart& chart, const BoundaryCondition& boundary,
                                          const std::function<double(const BoundaryCondition&)>& K_with);

}  // namespace beltrami
