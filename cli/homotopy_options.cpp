#include "homotopy_options.h"

#include <limits>

#include <beltrami/base/error.h>
#include <beltrami/io/number_lists.h>

#include "parse.h"

namespace beltrami::cli {

void HomotopyOptions::add_to(CLI::App& app) {
    app.add_option("--turns", turns_,
                   "whole counter-clockwise turns n from the outer loop to the hole of loop h, numbered as `beltrami "
                   "info` prints it; holes not named get none; default: as the harmonic map turns them")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->type_name("h=n,...");
    app.add_option("--waypoints", waypoint_file_,
                   "how the holes move from SOURCE to their images, and so how they braid: a line `step loop x y` for "
                   "a hole's centre at a step, steps from 1; no lines: straight ways")
        ->type_name("FILE");
}

std::vector<NamedFile> HomotopyOptions::inputs() const {
    return {{"--waypoints", waypoint_file_}};
}

void HomotopyOptions::load() {
    if (!turns_.empty() && !waypoint_file_.empty())
        throw Error(Cause::bad_option, "--turns and --waypoints are both given",
                    "the way of the holes fixes their turns too: give one of them");
    for (const std::string& text : turns_) {
        const auto parts = of_loop(text);
        const auto turns = parts ? whole_number(parts->second) : std::nullopt;
        if (!turns)
            throw Error(Cause::bad_option, "--turns " + text + " is not h=n with a loop h and a whole number n",
                        "`beltrami info` prints the loops' numbers");
        for (const auto& [loop, other] : turns_of_loops_)
            if (loop == parts->first)
                throw Error(Cause::bad_option, "--turns is given twice for loop " + std::to_string(loop));
        turns_of_loops_.emplace_back(parts->first, *turns);
    }
    if (waypoint_file_.empty()) return;
    const IndexedRows rows = read_indexed_rows(waypoint_file_, 2, std::numeric_limits<int>::max(), 2, "a waypoint");
    for (Eigen::Index i = 0; i < rows.indices.rows(); ++i)
        waypoints_.push_back({rows.indices(i, 0), rows.indices(i, 1), Complex(rows.values(i, 0), rows.values(i, 1))});
}

void HomotopyOptions::require_hole(const Surface& source, int loop, int outer_loop, const std::string& option) const {
    const std::size_t loops = source.topology.boundary_loops.size();
    if (loops < 2)
        throw Error(Cause::bad_option, option + " says nothing about a surface without holes", "leave it out");
    if (loop == outer_loop || static_cast<std::size_t>(loop) >= loops)
        throw Error(Cause::bad_option,
                    option + " names the boundary loop " + std::to_string(loop) +
                        (loop == outer_loop ? ", which is the outer one" : ", which does not exist"),
                    "`beltrami info` prints the loops' numbers");
}

void HomotopyOptions::apply(const Surface& source, Correspondence& wanted) const {
    if (!turns_of_loops_.empty()) {
        wanted.turns.assign(source.topology.boundary_loops.size(), 0);
        for (const auto& [loop, turns] : turns_of_loops_) {
            require_hole(source, loop, wanted.outer_loop, "--turns");
            wanted.turns[loop] = turns;
        }
    }
    if (waypoint_file_.empty()) return;
    require_holes_of_waypoints(source, wanted.outer_loop);
    wanted.waypoints = waypoints_;
}

void HomotopyOptions::require_holes_of_waypoints(const Surface& source, int outer_loop) const {
    for (const Waypoint& waypoint : waypoints_) require_hole(source, waypoint.loop, outer_loop, "--waypoints");
    if (source.topology.boundary_loops.size() < 2) require_hole(source, 1, outer_loop, "--waypoints");
}

void HomotopyOptions::refuse_turns() const {
    if (!turns_of_loops_.empty())
        throw Error(Cause::bad_option, "--turns says nothing where the boundary slides",
                    "turned loops slide back; give --waypoints to braid holes");
}

}  // namespace beltrami::cli
