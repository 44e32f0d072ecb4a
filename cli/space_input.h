#pragma once

#include <beltrami/operators/surface.h>
#include <beltrami/report/record.h>

#include "mesh_input.h"

namespace beltrami::cli {

/// What commands about surfaces in space begin with: SOURCE with polygons as they are, those that are not convex cut,
/// its findings and its record.
/// @throw Error unreadable, bad_mesh
Surface surface_in_space(const MeshInputOptions& options, const std::string& path, MeshInput& input, Record& record);

/// A surface that is a target, in the units of another mesh.
Mesh target_in_space(const std::string& path, double unit, Warnings& warnings);

/// #V positions from lines `vertex x y z`, and which vertices they are of.
struct PlacesInSpace {
    std::vector<int> vertices;  ///< different ones
    Positions places;           ///< one row each, in the input's unit
};
/// @param what "a handle"
/// @throw Error unreadable; bad_boundary for vertices that there are not, or that are named twice
PlacesInSpace places_in_space(const std::string& path, const MeshInput& input, const std::string& what);

}  // namespace beltrami::cli
