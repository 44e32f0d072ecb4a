#pragma once

#include <string>
#include <vector>

namespace beltrami::cli {

/// A file with the name the command line gives it: "SOURCE", "--json".
struct NamedFile {
    std::string name, path;
};

/// Tells inputs and outputs apart and tries the outputs, before anything is computed: no output is written where
/// another could not be. Nothing is left behind, and existing files stay as they are. Files without a path and "-"
/// (standard output) are passed over.
/// @throw Error bad_option if an output is also an input or another output, except that -o may replace SOURCE;
///        unwritable if an output cannot be written
void check_files(const std::vector<NamedFile>& inputs, const std::vector<NamedFile>& outputs);

}  // namespace beltrami::cli
