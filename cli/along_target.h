#pragma once

#include <CLI/CLI.hpp>

#include <memory>
#include <optional>

#include <beltrami/flow/surface_flow.h>
#include <beltrami/report/record.h>

#include "files.h"
#include "mesh_input.h"
#include "onto_options.h"
#include "start_map_option.h"

namespace beltrami::cli {

/// --minimize-lp, --weight, --scheme, and what `flow` does where the map goes along a surface in space: its target,
/// its start, what is held, the map.
class AlongTarget {
  public:
    void add_to(CLI::App& app);
    /// Whether least Lᵖ norm is asked for.
    bool minimizes() const { return p_.has_value(); }
    /// Whether an option was given that belongs here only; its name.
    std::string stray() const;
    /// Whether --boundary says how the boundary moves, and not where it goes.
    static bool says_how_it_moves(const std::string& boundary);

    /// What `flow` was told beside.
    struct Request {
        const Surface& source;
        const MeshInput& input;
        const OntoTarget& onto;
        const StartMapOption& start_map;
        std::string boundary, pin_file;
        std::optional<Eigen::VectorXcd> mu;
        SurfaceFlowOptions options;
    };
    /// @throw Error
    SurfaceFlowMap run(const Request& request, SurfaceFlowRecord& record, Warnings& warnings) const;

    /// Whether the target is flat, so that the map is one of the plane.
    static bool flat(const OntoTarget& onto);

  private:
    LpNorm norm(const Surface& source) const;

    std::optional<double> p_;
    std::string weight_ = "area", scheme_ = "automatic";
};

}  // namespace beltrami::cli
