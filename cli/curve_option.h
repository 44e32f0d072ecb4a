#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include <beltrami/registration/register_curves.h>

#include "files.h"
#include "mesh_input.h"

namespace beltrami::cli {

/// --curves: curves and their partners, block by block,
///
///     curve slide            # or fixed
///     12                     # vertices of SOURCE …
///     40
///     onto
///     7                      # … and of TARGET, or points x y z, as many
///     0.1 0.4 2
///
/// A curve whose last point is its first is closed.
class CurveOption {
  public:
    void add_to(CLI::App& app);
    bool given() const { return !path_.empty(); }
    std::vector<NamedFile> inputs() const { return {{"--curves", path_}}; }
    /// @throw Error unreadable with file and line, bad_boundary
    std::vector<CurvePair> curves(const MeshInput& source, const MeshInput& target, Warnings& warnings) const;

  private:
    std::string path_;
};

}  // namespace beltrami::cli
