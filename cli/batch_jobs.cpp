#include "batch_jobs.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include <beltrami/base/error.h>

namespace beltrami::cli {

namespace {

using BatchJson = nlohmann::ordered_json;

/// Whether a name can be that of a folder anywhere.
bool names_folder(const std::string& id) {
    const auto plain = [](unsigned char c) { return std::isalnum(c) || c == '.' || c == '_' || c == '-' || c >= 0x80; };
    return !id.empty() && id.size() <= 200 && id[0] != '.' && std::all_of(id.begin(), id.end(), plain);
}

BatchJob job_of(const std::string& text, const std::string& where) {
    const BatchJson line = BatchJson::parse(text, nullptr, false);
    if (line.is_discarded() || !line.is_object())
        throw Error(Cause::unreadable, where + " is no JSON object",
                    R"(give {"id": "a", "args": ["map", "a.obj", …]})");
    BatchJob job;
    try {
        job = {line.at("id").get<std::string>(), line.at("args").get<std::vector<std::string>>()};
    } catch (const nlohmann::json::exception&) {
        throw Error(Cause::unreadable, where + " lacks an id or args, or they are no text",
                    R"(give {"id": "a", "args": ["map", "a.obj", …]})");
    }
    if (!names_folder(job.id))
        throw Error(Cause::bad_option, where + ": the id \"" + job.id + "\" is no name of a folder",
                    "use letters, digits, '.', '_' and '-', and begin with none of these dots");
    if (job.args.empty() || job.args[0].empty() || job.args[0][0] == '-' || job.args[0] == "batch")
        throw Error(Cause::bad_option, where + ": args do not begin with a subcommand", "give those of one command");
    return job;
}

/// Options whose value is a file that is written.
bool is_batch_output(const std::string& option, const std::string& subcommand) {
    static const std::set<std::string> outputs{"-o",        "--output", "--json",  "--report",
                                               "--picture", "--phi",    "--places"};
    return outputs.contains(option) && !(option == "--places" && subcommand == "transfer");
}

}  // namespace

std::vector<BatchJob> read_batch_jobs(const std::filesystem::path& path) {
    std::ifstream file(path);
    if (!file) throw Error(Cause::unreadable, path.string() + " cannot be read");
    std::vector<BatchJob> jobs;
    std::set<std::string> ids;
    std::string text;
    for (int line = 1; std::getline(file, text); ++line) {
        if (text.find_first_not_of(" \t\r") == std::string::npos) continue;
        const std::string where = path.string() + ", line " + std::to_string(line);
        BatchJob job = job_of(text, where);
        if (!ids.insert(job.id).second)
            throw Error(Cause::bad_option, where + ": the id " + job.id + " has been used", "give each job its own",
                        {Things::lines, {line - 1}});
        jobs.push_back(std::move(job));
    }
    if (jobs.empty()) throw Error(Cause::unreadable, path.string() + " has no jobs");
    return jobs;
}

std::string to_line(const BatchOutcome& outcome) {
    BatchJson line{{"id", outcome.id},
                   {"status", outcome.done() ? "done" : "failed"},
                   {"seconds", outcome.seconds},
                   {"exit_code", outcome.exit_code}};
    if (!outcome.done()) {
        line["cause"] = outcome.cause;
        line["message"] = outcome.message;
    }
    for (const auto& [name, number] : outcome.numbers) line["numbers"][name] = number;
    line["files"] = outcome.files;
    line["args"] = outcome.args;
    return line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::optional<BatchOutcome> outcome_of(const std::string& text) {
    const BatchJson line = BatchJson::parse(text, nullptr, false);
    if (line.is_discarded() || !line.is_object()) return {};
    try {
        BatchOutcome outcome;
        outcome.id = line.at("id").get<std::string>();
        outcome.args = line.at("args").get<std::vector<std::string>>();
        outcome.exit_code = line.at("exit_code").get<int>();
        outcome.seconds = line.at("seconds").get<double>();
        outcome.files = line.at("files").get<std::vector<std::string>>();
        outcome.cause = line.value("cause", "");
        outcome.message = line.value("message", "");
        if (line.contains("numbers")) outcome.numbers = line.at("numbers").get<std::map<std::string, double>>();
        return outcome;
    } catch (const nlohmann::json::exception&) {
        return {};
    }
}

std::map<std::string, double> numbers_of_record(const std::filesystem::path& path) {
    std::map<std::string, double> numbers;
    std::ifstream file(path);
    const BatchJson record = BatchJson::parse(file, nullptr, false);
    if (record.is_discarded() || !record.is_object()) return numbers;
    const auto take = [&](const BatchJson& from, const char* name) {
        if (from.contains(name) && from[name].is_number()) numbers[name] = from[name].get<double>();
    };
    if (record.contains("map") && record["map"].is_object()) {
        const BatchJson& map = record["map"];
        for (const char* name : {"k", "K", "K_lower", "K_lower_proved", "K_max", "mean", "flipped"}) take(map, name);
        if (map.contains("distortion") && map["distortion"].is_object())
            for (const char* name : {"mean", "max", "flipped"}) take(map["distortion"], name);
    }
    if (record.contains("solve") && record["solve"].is_object()) take(record["solve"], "iterations");
    if (record.contains("source") && record["source"].is_object()) take(record["source"], "faces");
    return numbers;
}

BatchCommand command_in(const std::filesystem::path& folder, const std::vector<std::string>& args, int threads) {
    BatchCommand command;
    bool has_record = false, has_threads = false;
    const auto placed = [&](const std::string& option, const std::string& value) {
        const bool here = value != "-" && std::filesystem::path(value).is_relative();
        std::string path = here ? (folder / value).string() : value;
        if (here) std::filesystem::create_directories(std::filesystem::path(path).parent_path());
        if (option == "--json") {
            has_record = true;
            if (here) command.record = path;
        }
        if (here && (option == "-o" || option == "--output")) command.mesh = path;
        return path;
    };
    for (std::size_t i = 0; i < args.size(); ++i) {
        const std::string& arg = args[i];
        const std::size_t equals = arg.find('=');
        const std::string option = arg.substr(0, equals);
        has_threads = has_threads || option == "--threads";
        if (equals != std::string::npos && is_batch_output(option, args[0])) {
            command.args.push_back(option + "=" + placed(option, arg.substr(equals + 1)));
        } else if (is_batch_output(arg, args[0]) && i + 1 < args.size()) {
            command.args.push_back(arg);
            command.args.push_back(placed(arg, args[++i]));
        } else {
            command.args.push_back(arg);
        }
    }
    if (!has_record) {
        command.args.emplace_back("--json");
        command.args.push_back(placed("--json", "record.json"));
    }
    if (!has_threads) {
        command.args.emplace_back("--threads");
        command.args.push_back(std::to_string(threads));
    }
    return command;
}

}  // namespace beltrami::cli
