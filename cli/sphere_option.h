#pragma once

#include <CLI/CLI.hpp>

#include <beltrami/uniformize/sphere_map.h>

namespace beltrami::cli {

/// --method of maps to the sphere.
class SphereMethodOption {
  public:
    void add_to(CLI::App& app);
    bool given() const { return !name_.empty(); }
    SphereMapOptions options() const;

  private:
    std::string name_;
};

}  // namespace beltrami::cli
