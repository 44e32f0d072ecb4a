#pragma once

#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/locate/planar_locator.h>

namespace beltrami BELTRAMI_PUBLIC {

/// A place of a mesh and how far a point is from it.
struct NearestPlace {
    MeshPoint place;
    double distance = 0;
};

/// The places of a mesh that are nearest to points of space (#P×3); quads are two triangles.
/// @throw Error bad_mesh if there is no face; bad_option naming points that are not finite
std::vector<NearestPlace> nearest_places(const Mesh& mesh, const Positions& points);

}  // namespace beltrami
