#pragma once

#include <CLI/CLI.hpp>

#include "files.h"
#include "map_methods.h"

namespace beltrami::cli {

/// --phi: μ and φ of an extremal map, and the zeros and poles of φ, as JSON.
class PhiOption {
  public:
    void add_to(CLI::App& app);
    bool given() const { return !path_.empty(); }
    const std::string& path() const { return path_; }
    NamedFile output() const { return {"--phi", path_}; }
    /// Nothing where it is not given.
    /// @throw Error unwritable
    void write(const Surface& mapped, const MethodResult& result) const;

  private:
    std::string path_;
};

}  // namespace beltrami::cli
