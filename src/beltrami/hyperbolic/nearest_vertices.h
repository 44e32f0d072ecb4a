#pragma once

#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/mesh/mesh.h>
#include <beltrami/mesh/topology.h>

namespace beltrami BELTRAMI_PUBLIC {

/// The vertices nearest to points (#P×3): of the corners of the nearest triangle the one with the largest weight.
std::vector<int> nearest_vertices(const Mesh& target, const FaceList& triangles, const Positions& points);
/// The vertices of the target nearest to the source's when these lie at points (#V×3); of a boundary loop those of the
/// loop that is nearest to it on the mean.
/// @param triangles of the target
/// @throw Error bad_option if that pairs no loops off
std::vector<int> nearest_vertices(const Topology& source, const Topology& of_target, const Mesh& target,
                                  const FaceList& triangles, const Positions& points);

}  // namespace beltrami
