#pragma once

#include <CLI/CLI.hpp>

#include "files.h"
#include "mesh_input.h"

namespace beltrami::cli {

/// --reference: the shapes that the faces of a mesh ought to have.
class ReferenceOption {
  public:
    CLI::Option* add_to(CLI::App& app);
    bool given() const { return given_; }
    const std::string& name() const { return reference_; }
    std::vector<NamedFile> inputs() const;
    /// #corners×2 or ×3.
    /// @throw Error unreadable, bad_option, bad_mesh
    Positions shapes(const MeshInput& input) const;

  private:
    bool is_file() const;
    Positions from_file(const MeshInput& input) const;

    std::string reference_ = "equilateral";
    bool given_ = false;
};

}  // namespace beltrami::cli
