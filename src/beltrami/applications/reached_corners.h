#pragma once

#include <span>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/starts/sliding_loops.h>
#include <beltrami/targets/correspondence.h>

namespace beltrami BELTRAMI_PUBLIC {

/// Lets the image of a map whose boundary slid have the corners of its target: with no vertex at a corner its polygon
/// cuts the corner off. The boundary vertex nearest to a corner moves there along its curve, by less than an edge,
/// where no face folds by that.
/// @param source  the mesh that was mapped
/// @param loops   of the map, as extremal_map returns them
/// @param marks   their vertices stay
/// @param map     #V images in the target's plane; changed
/// @return number of corners at which a vertex lies in the end, of all loops
int reach_corners(const Surface& source, const TargetDomain& target, const std::vector<LoopOnto>& loops,
                  std::span<const Mark> marks, Eigen::VectorXcd& map);

}  // namespace beltrami
