#include "files.h"

#include <unistd.h>

#include <filesystem>
#include <system_error>

#include <beltrami/base/error.h>
#include <beltrami/io/atomic_file.h>

namespace beltrami::cli {

namespace {

namespace fs = std::filesystem;

bool is_named(const NamedFile& file) {
    return !file.path.empty() && file.path != "-";
}

/// True if both paths lead to one file, which may not exist yet. Pipes and devices can be shared.
bool same_file(const fs::path& a, const fs::path& b) {
    std::error_code error;
    if (fs::exists(a, error) && fs::exists(b, error))
        return fs::is_regular_file(a, error) && fs::equivalent(a, b, error);
    const fs::path full_a = fs::weakly_canonical(fs::absolute(a, error), error);
    if (error) return false;
    const fs::path full_b = fs::weakly_canonical(fs::absolute(b, error), error);
    return !error && full_a == full_b;
}

void try_to_write(const NamedFile& output) {
    std::error_code error;
    const fs::file_status status = fs::status(output.path, error);
    const bool is_stream = fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
    // Who reads a pipe would take its being opened and closed for the end.
    if (is_stream && ::access(output.path.c_str(), W_OK) == 0) return;
    const AtomicFile file(output.path);
}

}  // namespace

void check_files(const std::vector<NamedFile>& inputs, const std::vector<NamedFile>& outputs) {
    for (std::size_t i = 0; i < outputs.size(); ++i) {
        const NamedFile& output = outputs[i];
        if (!is_named(output)) continue;
        for (const NamedFile& input : inputs) {
            const bool in_place = output.name == "-o" && input.name == "SOURCE";
            if (is_named(input) && !in_place && same_file(input.path, output.path))
                throw Error(Cause::bad_option, output.name + " would overwrite " + input.name + ", " + input.path,
                            "choose another file");
        }
        for (std::size_t j = 0; j < i; ++j)
            if (is_named(outputs[j]) && same_file(outputs[j].path, output.path))
                throw Error(Cause::bad_option,
                            outputs[j].name + " and " + output.name + " are the same file, " + output.path,
                            "give each output a file of its own");
    }
    for (const NamedFile& output : outputs)
        if (is_named(output)) try_to_write(output);
}

}  // namespace beltrami::cli
