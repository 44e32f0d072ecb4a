#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include <beltrami/io/number_lists.h>
#include <beltrami/registration/held_curves.h>
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
///     7                      # … and of TARGET, or points x y z of it, as many
///     0.1 0.4 2
///
/// A curve whose last point is its first is closed.
class CurveOption {
  public:
    void add_to(CLI::App& app);
    bool given() const { return !path_.empty(); }
    std::vector<NamedFile> inputs() const { return {{"--curves", path_}}; }
    /// On a mesh. A point that is far from it is warned of, one that is off by a tenth of its diagonal refused.
    /// @throw Error unreadable with file and line, bad_boundary
    std::vector<CurveOnto> curves(const MeshInput& source, const MeshInput& target, Warnings& warnings) const;
    /// On another target.
    std::vector<CurveOnto> curves(const MeshInput& source, const Target& target, Warnings& warnings) const;
    /// Those on a mesh, as `register` takes them.
    std::vector<CurvePair> pairs(const MeshInput& source, const MeshInput& target, Warnings& warnings) const;

  private:
    /// The point of the target that a row names, and how far off the row is, in parts of the target's size.
    using PlaceOf = std::function<std::pair<Target::Point, double>(const NumberRow& row)>;
    std::vector<CurveOnto> read(const MeshInput& source, const PlaceOf& place_of, Warnings& warnings) const;

    std::string path_;
};

}  // namespace beltrami::cli
