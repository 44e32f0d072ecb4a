#pragma once

#include <CLI/CLI.hpp>

#include <beltrami/conformal/boundary_values.h>

namespace beltrami::cli {

/// --boundary, --corners, --start, --speed, --pin: what the user prescribes about the boundary.
class BoundaryOptions {
  public:
    void add_to(CLI::App& app);
    bool given() const { return !spec_.empty() || !pin_file_.empty(); }
    /// @throw Error bad_option, unreadable, bad_boundary
    BoundaryCondition read(const Surface& source) const;

  private:
    BoundaryCondition outer_loop(const Surface& source) const;

    std::string spec_, speed_ = "arclength", pin_file_;
    std::vector<int> corners_;
    std::optional<int> start_;
};

}  // namespace beltrami::cli
