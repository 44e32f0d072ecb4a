#pragma once

#include <CLI/CLI.hpp>

#include <beltrami/constraints/constraints.h>

#include "boundary_options.h"
#include "files.h"

namespace beltrami::cli {

/// --slide: arcs of boundary loops that slide between prescribed ends.
class SlideOption {
  public:
    void add_to(CLI::App& app);
    bool given() const { return !path_.empty(); }
    std::vector<NamedFile> inputs() const { return {{"--slide", path_}}; }
    /// The arcs, each along the curve of its loop's values, if those lie on one, else along that of --onto.
    /// @throw Error unreadable, bad_boundary
    std::vector<SlidingArc> arcs(const Surface& source, const BoundaryOptions& boundary) const;

  private:
    std::string path_;
};

}  // namespace beltrami::cli
