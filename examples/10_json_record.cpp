// The record that the command writes with --json, from a program.
#include <beltrami/beltrami.h>

#include <cstdio>

int main() {
    const beltrami::Surface disk(beltrami::disk(12));
    const beltrami::ExtremalMap map = beltrami::extremal_map(disk, beltrami::boundary_to_disk(disk, 0.5));
    beltrami::Record record;
    record.command = "example";
    record.source = beltrami::source_record(disk);
    record.map = beltrami::map_record(map);
    record.warnings = map.warnings;
    std::fputs(beltrami::to_json(record).c_str(), stdout);
}
