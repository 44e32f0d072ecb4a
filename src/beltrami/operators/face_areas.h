#pragma once

#include <vector>

#include <beltrami/mesh/mesh.h>

namespace beltrami {

/// The faces that operators() refuses, ascending: triangles without area, quads whose bilinear element has no positive
/// area at some sample.
/// @pre triangles and quads only, whose vertices exist
std::vector<int> faces_without_area(const Mesh& mesh);

}  // namespace beltrami
