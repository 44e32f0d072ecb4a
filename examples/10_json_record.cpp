// The record that the command writes with --json, from a program.
#include <beltrami/beltrami.h>

#include <chrono>
#include <cstdio>

int main() {
    const beltrami::Surface disk(beltrami::disk(12));
    const auto start = std::chrono::steady_clock::now();
    const beltrami::ExtremalMap map = beltrami::extremal_map(disk, beltrami::boundary_to_disk(disk, 0.5));
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    beltrami::Record record;
    record.command = "map";  // docs/record.schema.json knows the subcommands
    record.source = beltrami::source_record(disk);
    record.map = beltrami::map_record(map);
    record.solve = beltrami::solve_record(map, seconds.count());
    record.warnings = map.warnings;
    std::fputs(beltrami::to_json(record).c_str(), stdout);
}
