#pragma once

#include <CLI/CLI.hpp>

#include <beltrami/targets/correspondence.h>

#include "files.h"

namespace beltrami::cli {

/// --turns and --waypoints: which homotopy class of maps is meant, where the surface has holes.
class HomotopyOptions {
  public:
    void add_to(CLI::App& app);
    /// The files the options name.
    std::vector<NamedFile> inputs() const;
    bool given() const { return !turns_.empty() || !waypoint_file_.empty(); }
    /// Reads the options and their files. @throw Error bad_option, unreadable
    void load();
    /// Hands the class to the solver. @pre load() @throw Error bad_option naming a loop that cannot turn
    void apply(const Surface& source, Correspondence& wanted) const;
    /// @throw Error bad_option where turns are given: boundaries that slide take none
    void refuse_turns() const;

  private:
    /// @throw Error bad_option naming a waypoint of no hole
    void require_holes_of_waypoints(const Surface& source, int outer_loop) const;
    void require_hole(const Surface& source, int loop, int outer_loop, const std::string& option) const;

    std::vector<std::string> turns_;
    std::string waypoint_file_;
    std::vector<std::pair<int, int>> turns_of_loops_;
    std::vector<Waypoint> waypoints_;
};

}  // namespace beltrami::cli
