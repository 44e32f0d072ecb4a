#pragma once

#include <CLI/CLI.hpp>

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <beltrami/flow/surface_flow.h>
#include <beltrami/registration/natural_start.h>
#include <beltrami/report/record.h>
#include <beltrami/teichmuller/extremal_sphere.h>

#include "curve_option.h"
#include "files.h"
#include "mesh_input.h"
#include "onto_options.h"
#include "start_map_option.h"

namespace beltrami::cli {

/// --minimize-lp and --weight: the Lᵖ norm of |μ| that a map along a surface makes least.
class NormOption {
  public:
    void add_to(CLI::App& app);
    bool given() const { return p_.has_value(); }
    /// Whether --weight says something.
    bool weighted() const { return weight_ != "area"; }
    std::vector<NamedFile> inputs() const;
    double p() const { return *p_; }
    /// As the record has it: area or phi.
    std::string weight() const { return weighted() ? "phi" : "area"; }
    /// |φ| at the samples of a surface; empty where areas count as they are.
    /// @param landmarks where the target is the unit sphere: what is held there
    /// @throw Error bad_option where no φ is known, unreadable
    std::vector<double> densities(const Surface& source, std::span<const SphereLandmark> landmarks) const;

  private:
    std::vector<double> of_file(const Surface& source) const;

    std::optional<double> p_;
    std::string weight_ = "area";
};

/// --minimize-lp, --weight, --scheme, and what `flow` does where the map goes along a surface in space: its target,
/// its start, what is held, the map.
class AlongTarget {
  public:
    void add_to(CLI::App& app);
    /// Whether least Lᵖ norm is asked for.
    bool minimizes() const { return norm_.given(); }
    std::vector<NamedFile> inputs() const { return norm_.inputs(); }
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
        const CurveOption& curves;
        std::string boundary, pin_file;
        std::optional<Eigen::VectorXcd> mu;
        SurfaceFlowOptions options;
    };
    /// @throw Error
    SurfaceFlowMap run(const Request& request, SurfaceFlowRecord& record, Warnings& warnings) const;

    /// Whether the target is flat, so that the map is one of the plane.
    static bool flat(const OntoTarget& onto);

  private:
    /// @param faces of the request's source, for those of the surface that is mapped; empty: they are the same
    SurfaceFlowMap flow(const Request& request, const Target& target, const Surface& source,
                        const std::vector<int>& faces, const std::optional<Eigen::VectorXcd>& mu,
                        const TargetConstraints& constraints, TargetMap start, SurfaceFlowRecord& record) const;
    /// Along faces that are divided along the curves; of the map the source's own vertices.
    SurfaceFlowMap flow_with_curves(const Request& request, const Target& target, const std::vector<CurveOnto>& curves,
                                    NaturalStart start, SurfaceFlowRecord& record, Warnings& warnings) const;
    NormOption norm_;
    std::string scheme_ = "automatic";
};

}  // namespace beltrami::cli
