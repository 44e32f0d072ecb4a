#pragma once

#include <vector>

#include <beltrami/operators/surface.h>

namespace beltrami {

/// Signs of the corners of a disk's faces that describe functions on its double cover branched at some inner vertices:
/// functions known up to sign that change it around each of these. A function has one value a vertex (0 where it
/// branches), and the value times the sign at a corner; inside a face, and across all edges but those of some chains
/// from the branch points to the boundary, the signs agree.
/// @param branches inner vertices, each once
/// @return beside operators.vertices
/// @pre a disk of triangles
std::vector<signed char> branched_signs(const Surface& source, const std::vector<int>& branches);

}  // namespace beltrami
