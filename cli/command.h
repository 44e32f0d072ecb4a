#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include <beltrami/base/error.h>
#include <beltrami/report/record.h>

#include "files.h"
#include "hints.h"

namespace beltrami::cli {

/// What every subcommand offers: where the record goes, how much is said, how many threads.
struct CommonOptions {
    std::string json, report, texture;
    bool quiet = false;

    /// @param has_map whether there is a map for a page (--report)
    void add_to(CLI::App& app, bool has_map = true);
    /// check_files() of the inputs and the outputs, --texture, --json and --report among these.
    /// @throw Error unreadable or bad_option too, if --texture is no image
    void check_files(std::vector<NamedFile> inputs, std::vector<NamedFile> outputs = {}) const;
    /// Whether anything beyond the terminal wants the record.
    bool wants_record() const { return !json.empty() || !report.empty(); }
    /// Whether words may go to standard output (the record may own it).
    bool may_print() const { return !quiet && json != "-"; }
};

/// One subcommand: declares its options, then runs. run() returns the exit code.
class Command {
  public:
    virtual ~Command() = default;
    virtual int run() = 0;
    /// What has been found before run() ended or gave up, to be printed beside an error too.
    Warnings warnings() const { return common_.quiet ? Warnings() : record_.warnings; }
    /// Options that may help after an error; empty if none would.
    virtual std::string hint(const Error& error) const { return cli::hint(error); }

  protected:
    CommonOptions common_;
    Record record_;
};

std::unique_ptr<Command> make_info(CLI::App& parent);
std::unique_ptr<Command> make_measure(CLI::App& parent);
std::unique_ptr<Command> make_map(CLI::App& parent);
std::unique_ptr<Command> make_flatten(CLI::App& parent);
std::unique_ptr<Command> make_uniformize(CLI::App& parent);
std::unique_ptr<Command> make_flow(CLI::App& parent);
std::unique_ptr<Command> make_distance(CLI::App& parent);
std::unique_ptr<Command> make_grid(CLI::App& parent);
std::unique_ptr<Command> make_apply(CLI::App& parent);
std::unique_ptr<Command> make_register(CLI::App& parent);
std::unique_ptr<Command> make_transfer(CLI::App& parent);
std::unique_ptr<Command> make_batch(CLI::App& parent);
std::unique_ptr<Command> make_remesh(CLI::App& parent);
std::unique_ptr<Command> make_deform(CLI::App& parent);
std::unique_ptr<Command> make_image(CLI::App& parent);

/// Exit codes by cause; --help lists them.
int exit_code(Cause cause);
extern const char* const kExitCodes;

/// Reads a mesh; the reader's warnings are added to @p warnings.
Mesh load(const std::string& path, Warnings& warnings);

/// Adds the diagnosis' warnings.
void add_findings(const std::vector<Finding>& findings, Warnings& warnings);

/// Writes the record where the options want it; prints the table, what its bounds say, the warnings and the names of
/// the files otherwise.
void finish(const Record& record, const CommonOptions& common, const std::string& method,
            const std::vector<std::string>& files);

/// Writes a line to standard error; where that cannot be written nobody is listening.
void complain(const std::string& line);

/// Seconds since some fixed moment.
double seconds();

/// Writes "k 0.1234" of an iteration over the line before, if standard error is a terminal.
class Progress {
  public:
    explicit Progress(bool wanted);
    ~Progress();
    void show(int iteration, double value, const char* name = "k");

  private:
    bool terminal_, used_ = false;
};

}  // namespace beltrami::cli
