#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace beltrami::cli {

/// One command of a batch, as one would type it.
struct BatchJob {
    std::string id;
    std::vector<std::string> args;  ///< from the subcommand on
};

/// What became of a job.
struct BatchOutcome {
    std::string id;
    std::vector<std::string> args;
    int exit_code = 0;
    std::string cause;    ///< empty: it is done; else as exit codes have it, or "killed"
    std::string message;  ///< what the job complained of
    double seconds = 0;
    std::map<std::string, double> numbers;  ///< K, K_lower_proved, K_max, mean, flipped … of its record
    std::vector<std::string> files;         ///< in its folder

    bool done() const { return cause.empty(); }
};

/// Reads a file of JSON lines {"id": …, "args": […]}; empty lines are passed over.
/// @throw Error unreadable naming the line; bad_option naming lines whose id occurs twice or names no folder, or whose
///        args are no command
std::vector<BatchJob> read_batch_jobs(const std::filesystem::path& path);

/// The outcome as one line of JSON, and back; nothing where a line is none.
std::string to_line(const BatchOutcome& outcome);
std::optional<BatchOutcome> outcome_of(const std::string& line);

/// The numbers of a record (docs/json.md); none where it cannot be read.
std::map<std::string, double> numbers_of_record(const std::filesystem::path& path);

/// The arguments with outputs of relative paths in a folder, and a record.
struct BatchCommand {
    std::vector<std::string> args;
    std::string record;               ///< its file in the folder; empty if it goes elsewhere
    std::optional<std::string> mesh;  ///< what -o writes, if that is in the folder
};
/// @param threads for the job, unless it says itself
BatchCommand command_in(const std::filesystem::path& folder, const std::vector<std::string>& args, int threads);

}  // namespace beltrami::cli
