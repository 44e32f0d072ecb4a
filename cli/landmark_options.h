#pragma once

#include <CLI/CLI.hpp>

#include <beltrami/io/number_lists.h>
#include <beltrami/registration/nearest_places.h>
#include <beltrami/registration/register_spheres.h>

#include "files.h"
#include "mesh_input.h"

namespace beltrami::cli {

/// The number of a vertex in a column of a row.
/// @throw Error unreadable
int index_at(const std::string& path, const NumberRow& row, std::size_t column);

/// The place on TARGET that a row names from some column on: a vertex, or a point of space.
/// @throw Error unreadable, bad_boundary
NearestPlace place_at(const std::string& path, const NumberRow& row, std::size_t column, const MeshInput& target);

/// Whether a point was farther from TARGET than one that is meant to be on it.
bool is_far(const NearestPlace& place, const MeshInput& target);

/// --landmarks, --weights and --waypoints of `register`.
class LandmarkOptions {
  public:
    void add_to(CLI::App& app);
    std::vector<NamedFile> inputs() const;
    /// Vertices are named as the files count them.
    /// @throw Error unreadable, bad_boundary
    std::vector<SurfaceLandmark> landmarks(const MeshInput& source, const MeshInput& target, Warnings& warnings) const;
    std::vector<SurfaceWaypoint> waypoints(const MeshInput& source, const MeshInput& target) const;

  private:
    std::string landmarks_, weights_, waypoints_;
};

}  // namespace beltrami::cli
