#pragma once

#include <CLI/CLI.hpp>

#include <beltrami/operators/surface.h>

#include "files.h"
#include "mesh_input.h"

namespace beltrami::cli {

/// --metric FILE|vt: a metric of its own for the source.
class MetricOption {
  public:
    void add_to(CLI::App& app);
    bool given() const { return !metric_.empty(); }
    /// The files the option names.
    std::vector<NamedFile> inputs() const;
    /// Reads the file. @throw Error unreadable
    void load(const MeshInput& input);
    /// The mesh with its metric. @pre load() @throw Error bad_mesh
    Surface surface_of(Mesh mesh) const;

  private:
    bool from_file() const { return !metric_.empty() && metric_ != "vt"; }

    std::string metric_;
    std::vector<EdgeLength> lengths_;
};

}  // namespace beltrami::cli
