#pragma once

#include <vector>

#include <beltrami/mesh/topology.h>

namespace beltrami {

/// A multivalued function that grows by 1 around one boundary loop, as its values at the corners of faces (#corners, 0
/// or 1): within a face differences are those of the function, and from face to face it is constant but for a strip of
/// faces between two boundary loops, whose one side is 1 higher. A closed 1-form that is 0 but on the edges that the
/// strip crosses. As signs, 1 − 2 · value describes functions that change sign around the loop.
/// @pre orientable, one component; two different loops
std::vector<double> jumps_across_strip(const Mesh& mesh, const Topology& topology, int from_loop, int to_loop);

}  // namespace beltrami
