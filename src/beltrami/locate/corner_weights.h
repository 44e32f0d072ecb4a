#pragma once

#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/locate/planar_locator.h>

namespace beltrami BELTRAMI_PUBLIC {

/// Barycentric weights of a place for all corners of its face, in the face's order: 0 at the corner of a quad that is
/// not of the place's triangle.
std::vector<double> corner_weights(const Mesh& mesh, const MeshPoint& place);

}  // namespace beltrami
