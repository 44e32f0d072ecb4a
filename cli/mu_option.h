#pragma once

#include <CLI/CLI.hpp>

#include <beltrami/operators/frames.h>

#include "files.h"

namespace beltrami::cli {

/// --mu and --mu-frame: a Beltrami coefficient from a file.
class MuOption {
  public:
    CLI::Option* add_to(CLI::App& app, const std::string& what);
    bool given() const { return !path_.empty(); }
    std::vector<NamedFile> inputs() const { return {{"--mu", path_}}; }
    /// #S in the samples' frames. @pre given()
    /// @throw Error unreadable, bad_option
    Eigen::VectorXcd values(const Surface& source) const;

  private:
    std::string path_, frame_ = "samples";
};

}  // namespace beltrami::cli
