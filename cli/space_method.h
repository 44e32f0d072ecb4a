#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

#include <beltrami/report/record.h>

#include "command.h"
#include "mesh_input.h"
#include "reference_option.h"

namespace beltrami::cli {

/// map --method lsqc: the least-squares quasiconformal map of a surface into space, of Gruber and Aulisa.
class SpaceMethod {
  public:
    static constexpr const char* kName = "lsqc";

    void add_to(CLI::App& app);
    /// The first of these options that was given; empty if none was.
    std::string stray() const;
    std::vector<NamedFile> inputs() const;
    /// The map, written to a file; the record and the page with it.
    void run(const MeshInputOptions& options, const std::string& source, const std::string& output,
             const CommonOptions& common, Record& record) const;

  private:
    Eigen::VectorXcd coefficient(const Operators& operators) const;

    std::string places_, preserve_, mu_;
    bool uniform_ = false;
    ReferenceOption reference_;
};

}  // namespace beltrami::cli
