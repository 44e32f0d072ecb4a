#pragma once

#include <beltrami/base/public.h>
#include <beltrami/mesh/mesh.h>

namespace beltrami BELTRAMI_PUBLIC {

/// Shape of the faces of a mesh. Angles in radians, lengths in the units of the positions.
struct MeshQuality {
    double min_angle = 0.0;
    double mean_min_angle = 0.0;  ///< mean over the faces of their smallest angle
    double max_angle = 0.0;
    double min_edge = 0.0;
    double mean_edge = 0.0;
    double max_edge = 0.0;
    double max_aspect = 0.0;  ///< longest edge of a face over its shortest, the largest of all faces
    int ears = 0;             ///< faces whose vertices all lie on the boundary
    int face_count = 0;
};

/// Measures a mesh.
/// @throw Error bad_mesh if it is not an oriented manifold
MeshQuality quality(const Mesh& mesh);

}  // namespace beltrami
