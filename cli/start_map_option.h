#pragma once

#include <CLI/CLI.hpp>

#include <optional>

#include <beltrami/base/warning.h>
#include <beltrami/mesh/mesh.h>

#include "files.h"

namespace beltrami::cli {

/// A mesh with SOURCE's vertices and faces in their order. Warnings of the reader are added.
/// @throw Error unreadable, bad_mesh naming what differs from SOURCE
Mesh load_of_same_faces(const std::string& option, const std::string& path, const Mesh& source, Warnings& warnings);

/// --start-map: a map of SOURCE from which the iteration begins, as the vt of a mesh of the same faces.
class StartMapOption {
  public:
    /// @param also more of what FILE may be
    void add_to(CLI::App& app, const std::string& also = {});
    bool given() const { return !path_.empty(); }
    std::vector<NamedFile> inputs() const { return {{"--start-map", path_}}; }
    const std::string& path() const { return path_; }
    /// #V images; nothing if there is none. Warnings of the reader are added.
    /// @throw Error unreadable, bad_mesh naming what differs from SOURCE
    std::optional<Eigen::VectorXcd> load(const Mesh& source, Warnings& warnings) const;

  private:
    std::string path_;
};

}  // namespace beltrami::cli
