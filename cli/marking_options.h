#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <utility>
#include <vector>

#include <beltrami/registration/register_handles.h>

#include "files.h"
#include "mesh_input.h"

namespace beltrami::cli {

/// --align, --marking, --loop and --twist of `register`: the class of a map between closed surfaces with handles.
class MarkingOptions {
  public:
    void add_to(CLI::App& app);
    std::vector<NamedFile> inputs() const;
    /// The name of an option that was given; empty: none was.
    std::string given() const;
    /// Whether the least dilatation of all classes is asked for.
    bool searches() const { return marking_ == "search"; }
    Alignment alignment() const;
    /// Reads the paths; vertices are named as the files count them.
    /// @throw Error unreadable, bad_boundary, bad_option
    HandleMarking load(const MeshInput& source, const MeshInput& target) const;

  private:
    std::string align_ = "none", marking_ = "closest";
    std::vector<std::pair<std::string, std::string>> loops_;
    std::vector<std::string> twists_;
    const CLI::App* app_ = nullptr;
};

/// --align and --marking alone, of `distance`.
CLI::Option* add_align_option(CLI::App& app, std::string& align);
CLI::Option* add_marking_option(CLI::App& app, std::string& marking);
Alignment alignment_of(const std::string& align);

}  // namespace beltrami::cli
