#pragma once

#include <CLI/CLI.hpp>

#include <beltrami/conformal/boundary_values.h>

#include "files.h"

namespace beltrami::cli {

/// --boundary, --corners, --start, --speed, --pin: what the user prescribes about the boundary.
class BoundaryOptions {
  public:
    void add_to(CLI::App& app);
    /// The files the options name.
    std::vector<NamedFile> inputs() const;
    /// Reads the options and their files. @throw Error bad_option, unreadable
    void load(const Mesh& source);
    /// The values on the source's boundary. @pre load() @throw Error bad_option, bad_boundary
    BoundaryCondition values(const Surface& source) const;

  private:
    enum class Target { none, disk, rectangle, polygon };

    void parse_spec();
    /// Of polygon:FILE.
    std::string polygon_file() const;
    BoundaryCondition outer_loop(const Surface& source) const;

    std::string spec_, speed_ = "arclength", pin_file_;
    std::vector<int> corners_;
    std::optional<int> start_;

    Target target_ = Target::none;
    std::vector<double> sizes_;     // amplitude of a disk; width and height of a rectangle
    std::vector<Complex> polygon_;  // points
    BoundaryCondition pins_;
};

}  // namespace beltrami::cli
