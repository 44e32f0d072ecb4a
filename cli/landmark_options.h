#pragma once

#include <CLI/CLI.hpp>

#include <beltrami/registration/register_spheres.h>

#include "files.h"
#include "mesh_input.h"

namespace beltrami::cli {

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
