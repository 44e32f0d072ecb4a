#pragma once

#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/mesh/mesh.h>

namespace beltrami BELTRAMI_PUBLIC {

/// Shape of the faces of a grid that lies on a surface. Angles in radians.
struct GridQuality {
    double min_angle = 0;
    double max_angle = 0;
    double mean_skew = 0;    ///< how far a corner of a quad is from a right angle, the mean over all of them
    double mean_aspect = 0;  ///< longest edge of a face over its shortest, the mean over all faces
    double max_aspect = 0;
    double area_ratio = 1;    ///< largest area of a quad over the smallest
    std::vector<int> folded;  ///< faces with a corner that is flat or reflex, or flipped against the surface
};

/// @param normals #V×3 normals of the surface at the vertices of the grid
GridQuality grid_quality(const Mesh& grid, const Positions& normals);

}  // namespace beltrami
