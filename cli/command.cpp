#include "command.h"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>

#include <beltrami/base/counted.h>
#include <beltrami/base/error.h>
#include <beltrami/base/parallel.h>
#include <beltrami/io/atomic_file.h>
#include <beltrami/io/read_file.h>
#include <beltrami/io/read_mesh.h>
#include <beltrami/report/page.h>
#include <beltrami/report/record_json.h>
#include <beltrami/report/record_text.h>

namespace beltrami::cli {

const char* const kExitCodes =
    "Exit codes:\n"
    "  0  done (read the warnings)            5  boundary data missing, contradictory or impossible\n"
    "  1  internal error                      6  a linear system or an iteration failed\n"
    "  2  wrong command line                  7  an output could not be written\n"
    "  3  an input file could not be read     130  interrupted\n"
    "  4  the mesh cannot carry the computation\n";

int exit_code(Cause cause) {
    switch (cause) {
        case Cause::bad_option:
            return 2;
        case Cause::unreadable:
            return 3;
        case Cause::bad_mesh:
            return 4;
        case Cause::bad_boundary:
            return 5;
        case Cause::not_solved:
            return 6;
        case Cause::unwritable:
            return 7;
        case Cause::cancelled:
            return 130;
    }
    return 1;
}

void CommonOptions::add_to(CLI::App& app, bool has_map) {
    app.add_option("--json", json, "write the record as JSON to FILE, or to standard output with -")->type_name("FILE");
    if (has_map) {
        CLI::Option* page =
            app.add_option("--report", report, "write a self-contained HTML page to FILE")->type_name("FILE.html");
        app.add_option(
               "--texture", texture,
               "lay an image (PNG, JPEG, WebP or GIF) over the page's figures: over the image of the map, or the "
               "source, whichever lies in the plane; in space around its middle")
            ->needs(page)
            ->type_name("FILE");
    }
    app.add_flag("--quiet", quiet, "print nothing but errors");
    app.add_option_function<int>(
           "--threads", [](int count) { set_thread_count(count); }, "use N threads; the result does not depend on it")
        ->type_name("N")
        ->check(CLI::Range(1, 1024));
}

void CommonOptions::check_files(std::vector<NamedFile> inputs, std::vector<NamedFile> outputs) const {
    if (!texture.empty()) require_texture(read_file(texture));
    inputs.push_back({"--texture", texture});
    outputs.push_back({"--json", json});
    outputs.push_back({"--report", report});
    cli::check_files(inputs, outputs);
}

Mesh load(const std::string& path, Warnings& warnings) {
    LoadedMesh loaded = read_mesh(path);
    append(warnings, loaded.warnings);
    return std::move(loaded.mesh);
}

void add_findings(const std::vector<Finding>& findings, Warnings& warnings) {
    for (const Finding& finding : findings)
        warnings.push_back({WarningKind::mesh,
                            finding.next_step.empty() ? finding.sentence : finding.sentence + ": " + finding.next_step,
                            finding.where()});
}

void finish(const Record& record, const CommonOptions& common, const std::string& method,
            const std::vector<std::string>& files) {
    if (common.json == "-") {
        fmt::print("{}", to_json(record));
    } else if (!common.json.empty()) {
        write_atomically(common.json, to_json(record));
    }
    if (common.may_print()) {
        fmt::print("{}", to_table(record, method));
        if (record.solve)
            fmt::print("{} after {}\n", record.solve->termination,
                       counted(record.solve->iterations, "iteration", "iterations"));
        if (record.grid) fmt::print("{}", to_table(*record.grid));
        fmt::print("{}", to_remarks(record));
        fmt::print("{}", to_sentence(record));
        for (const std::string& file : files)
            if (!file.empty() && file != "-") fmt::print("wrote {}\n", file);
    }
    if (!common.quiet) {
        for (const Warning& warning : record.warnings) complain("warning: " + warning.sentence);
        for (const std::string& hint : hints(record)) complain("hint: " + hint);
    }
    if (std::fflush(stdout) != 0) throw Error(Cause::unwritable, "standard output could not be written");
}

void complain(const std::string& line) {
    std::fputs((line + "\n").c_str(), stderr);
}

double seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

Progress::Progress(bool wanted) : terminal_(wanted && isatty(STDERR_FILENO)) {}

Progress::~Progress() {
    if (used_) std::fputs("\r\x1b[K", stderr);
}

void Progress::show(int iteration, double value, const char* name) {
    if (!terminal_) return;
    std::fputs(fmt::format("\riteration {}  {} {:.6f}\x1b[K", iteration, name, value).c_str(), stderr);
    std::fflush(stderr);
    used_ = true;
}

}  // namespace beltrami::cli
