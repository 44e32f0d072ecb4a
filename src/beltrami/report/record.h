#pragma once

#include <optional>
#include <string>
#include <vector>

#include <beltrami/teichmuller/extremal_map.h>

namespace beltrami {

/// What was read. Topology is absent for a mesh on which it is not defined.
struct SourceRecord {
    int vertices = 0, faces = 0;
    struct Shape {
        int components, genus;
        std::vector<double> boundary_loops;  ///< lengths, loop 0 first
    };
    std::optional<Shape> shape;
};

/// What a map does. Absent numbers do not apply; NaN and infinity become null in JSON.
struct MapRecord {
    std::optional<double> k, K, K_lower, K_max;
    std::vector<Bound> bounds;
    double mean = 0, standard_deviation = 0, p99 = 0, max = 0;
    int flipped = 0, degenerate = 0;
    std::optional<double> boundary_residual;
};

/// How it was found.
struct SolveRecord {
    int iterations = 0;
    std::string termination;
    int factorizations = 0;
    double seconds_total = 0;
    std::optional<double> seconds_harmonic;
};

/// One line of a comparison.
struct MethodRecord {
    std::string method;
    MapRecord map;
    SolveRecord solve;
};

/// The record of one command, as docs/json.md describes it.
struct Record {
    std::string command;
    SourceRecord source;
    std::optional<MapRecord> map;
    std::optional<SolveRecord> solve;
    std::vector<MethodRecord> comparison;
    std::vector<std::string> warnings;
};

SourceRecord source_record(const Mesh& mesh);
SourceRecord source_record(const Mesh& mesh, const Topology& topology);
SourceRecord source_record(const Surface& surface);
MapRecord map_record(const Distortion& distortion);
MapRecord map_record(const ExtremalMap& result);
SolveRecord solve_record(const ExtremalMap& result, double seconds_total);

/// The record as JSON, keys in the documented order, ending with a newline.
std::string to_json(const Record& record);

/// The record's map and comparison as a table for the terminal; empty without a map.
/// @param method name of the record's own map
std::string to_table(const Record& record, const std::string& method);

/// What the lower bound on K says and how near the map comes, in plain words for the terminal; empty without a bound.
std::string to_sentence(const Record& record);

}  // namespace beltrami
