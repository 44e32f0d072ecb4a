#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include <beltrami/base/counted.h>
#include <beltrami/base/error.h>
#include <beltrami/certificate/refined_problem.h>
#include <beltrami/charts/uniformization.h>
#include <beltrami/constraints/prescribed_split.h>
#include <beltrami/forms/flat_torus.h>
#include <beltrami/forms/period_matrix.h>
#include <beltrami/hyperbolic/hyperbolic_domain.h>
#include <beltrami/io/atomic_file.h>
#include <beltrami/mesh/edge_table.h>

#include "command.h"
#include "mesh_input.h"
#include "metric_option.h"
#include "output.h"
#include "page.h"
#include "sphere_option.h"

namespace beltrami::cli {

namespace {

/// Whether every edge has a face on both sides.
bool is_closed(const Mesh& mesh) {
    const EdgeTable table = edge_table(mesh.faces, mesh.vertex_count());
    if (table.edge_count() == 0) return false;
    for (int e = 0; e < table.edge_count(); ++e)
        if (table.corners_of(e).size() < 2) return false;
    return true;
}

class Uniformize final : public Command {
  public:
    explicit Uniformize(CLI::App& parent) {
        CLI::App* app = parent.add_subcommand(
            "uniformize",
            "conformal map to the canonical domain: a closed surface to the sphere or, of genus 1, the flat torus, a "
            "disk "
            "to the round disk, a surface with holes to the disk less round holes, with its moduli; a closed surface "
            "of "
            "genus 2 or more, or one with handles and a boundary, to a fundamental polygon of the hyperbolic plane, in "
            "the unit disk");
        app->add_option("SOURCE", source_, "OBJ, PLY, OFF or STL; one component of any genus")->required();
        output_.add_to(*app);
        app->add_option("--outer", outer_,
                        "the boundary loop, numbered as `beltrami info` prints it, that goes to the unit circle; "
                        "default: 0")
            ->check(CLI::NonNegativeNumber)
            ->type_name("h");
        app->add_option(
               "--centre", centre_,
               "the loop whose circle goes around 0, the next one's centre to the positive real axis; default: "
               "the first one that is not the outer loop")
            ->check(CLI::NonNegativeNumber)
            ->type_name("h");
        app->add_option("--loops", loops_,
                        "of surfaces with handles: write short closed paths of vertices to PREFIX0.txt … and, of "
                        "genus 2 or more, generators of the fundamental group to PREFIX_generator0.txt …")
            ->type_name("PREFIX");
        sphere_.add_to(*app);
        metric_.add_to(*app);
        options_.add_to(*app);
        common_.add_to(*app);
        app->footer(kExitCodes);
    }

    int run() override {
        output_.check();
        std::vector<NamedFile> inputs = metric_.inputs();
        inputs.push_back({"SOURCE", source_});
        common_.check_files(inputs, {{"-o", output_.path()}});
        Record& record = record_;
        record.command = "uniformize";
        MeshInput input = options_.load(source_, record.warnings);
        const bool closed = is_closed(input.mesh);
        if (closed) {
            output_.check_seams();
            if (!metric_.given()) cut_folded_quads(input, record.warnings);
        }
        metric_.load(input);
        const double start = seconds();
        const Surface source = metric_.surface_of(std::move(input.mesh));
        add_findings(source.findings, record.warnings);
        record.source = source_record(source, input.unit);
        check(source);
        if (!closed && source.topology.genus == 0)
            to_circles(source, input, start);
        else if (source.topology.genus == 0)
            to_sphere(source, input, start);
        else if (closed && source.topology.genus == 1)
            to_torus(source, input, start);
        else
            to_hyperbolic_plane(source, input, start);
        return 0;
    }

    std::string hint(const Error& error) const override { return options_.hint(error, source_); }

  private:
    void to_circles(const Surface& source, const MeshInput& input, double start) {
        const Uniformization found = uniformization(source, outer_.value_or(0), centre_);
        const CircleDomainChart& chart = found.chart;
        SolveRecord solve;
        solve.iterations = chart.steps;
        solve.factorizations = chart.factorizations;
        solve.termination = to_string(chart.converged ? Termination::converged : Termination::iteration_limit);
        solve.seconds_total = seconds() - start;
        record_.solve = solve;
        record_.uniformization = uniformization_record(found);
        append(record_.warnings, chart.chart.warnings);
        const Distortion d = distortion(source.operators, found.map);
        if (!d.flipped.empty())
            record_.warnings.push_back({WarningKind::flipped_faces,
                                        counted(d.flipped.size(), "face comes", "faces come") +
                                            " out flipped; the first is face " + std::to_string(d.flipped[0]),
                                        {Things::faces, d.flipped}});
        record_.map = map_record(d);
        output_.write(source.mesh, found.map, d, input.attributes, input.unit);
        conclude(source, positions_of(found.map), d, "conformal");
    }

    void to_sphere(const Surface& source, const MeshInput& input, double start) {
        const SphereMap found = sphere_map(source, sphere_.options());
        SolveRecord solve;
        solve.iterations = found.iterations;
        solve.factorizations = found.factorizations;
        solve.termination = to_string(Termination::converged);
        solve.seconds_total = seconds() - start;
        record_.solve = solve;
        record_.sphere = sphere_record(found);
        append(record_.warnings, found.warnings);
        record_.map = map_record(found.distortion);
        output_.write_sphere(source.mesh, found.positions, found.distortion, input.attributes, input.unit);
        conclude(source, found.positions, found.distortion,
                 found.method == SphereMethod::tutte ? "tutte" : "conformal");
    }

    void to_torus(const Surface& source, const MeshInput& input, double start) {
        output_.check_layout();
        const FlatTorus found = flat_torus(source);
        record_.solve = direct_solve(found.factorizations, start);
        record_.periods =
            periods_record(found.homology, found.generators, Eigen::MatrixXcd::Constant(1, 1, found.tau), input.unit);
        short_loops_ = found.homology.loops;
        record_.torus = torus_record(found);
        finish_layout(source, input, found.layout, found.distortion, [&] { return page_domain(source, found); });
    }

    /// Edges across it that join two boundary vertices are split first: along the boundary, a geodesic, their faces
    /// have no area.
    void to_hyperbolic_plane(const Surface& source, MeshInput& input, double start) {
        output_.check_layout();
        std::optional<SplitProblem> split;
        if (!source.topology.boundary_loops.empty() && all_triangles(source.mesh)) split = split_bridges(source);
        if (!split || split->split_edges == 0) {
            to_polygon(source, source, input, start);
            return;
        }
        record_.split = split_record(*split, source.mesh.vertex_count());
        record_.warnings.push_back(
            {WarningKind::edges_split, counted(split->split_edges, "edge", "edges") + " between boundary vertices " +
                                           (split->split_edges == 1 ? "was" : "were") + " split at the midpoint"});
        input.mesh = source.mesh;
        take_split(input, *split);
        for (const std::array<int, 4>& parents : split->parents) beside_.push_back(parents[0]);
        to_polygon(source, surface_of(split->mesh, split->metric), input, start);
    }

    /// @param given the source before vertices were added
    void to_polygon(const Surface& given, const Surface& source, const MeshInput& input, double start) {
        const HyperbolicSurface metric = hyperbolic_surface(source);
        HyperbolicDomain found = hyperbolic_domain(source, metric);
        HomologyBasis basis;
        if (metric.has_boundary()) {
            record_.solve = direct_solve(metric.factorizations, start);
            basis = homology_basis(given);
            record_.periods = periods_record(basis, {}, {}, input.unit);
        } else {
            const HarmonicBasis harmonic = harmonic_basis(source);
            const PeriodMatrix periods = period_matrix(source, harmonic);
            basis = harmonic.homology;
            record_.solve = direct_solve(metric.factorizations + harmonic.factorizations, start);
            record_.periods = periods_record(basis, periods.basis, periods.periods, input.unit);
        }
        short_loops_ = basis.loops;
        beside_added(found.paths, given.mesh.vertex_count());
        record_.solve->iterations = metric.iterations;
        record_.hyperbolic = hyperbolic_record(metric, found);
        if (metric.inverted.size() > found.distortion.flipped.size())
            record_.warnings.push_back(
                {WarningKind::unfolded, counted(metric.inverted.size(), "face", "faces") +
                                            " came out flipped, as edges were flipped on the way, and vertices around "
                                            "them were moved"});
        finish_layout(source, input, found.layout, found.distortion,
                      [&] { return page_domain(source, metric, found); });
    }

    /// Closed paths past an end of an edge that was split instead of over its midpoint: vertices that the file has.
    void beside_added(std::vector<std::vector<int>>& paths, int given) const {
        if (beside_.empty()) return;
        for (std::vector<int>& path : paths) {
            for (int& v : path)
                if (v >= given) v = beside_[static_cast<std::size_t>(v - given)];
            path.erase(std::unique(path.begin(), path.end()), path.end());
            if (path.size() > 1 && path.front() == path.back()) path.pop_back();
        }
    }

    /// A map with seams is written, and the record.
    /// @param domain the same for a page
    template <class Domain>
    void finish_layout(const Surface& source, const MeshInput& input, const TextureCoordinates& layout,
                       const Distortion& d, Domain&& domain) {
        if (!d.flipped.empty())
            record_.warnings.push_back({WarningKind::flipped_faces,
                                        counted(d.flipped.size(), "face comes", "faces come") +
                                            " out flipped, as edges were flipped on the way; the first is face " +
                                            std::to_string(d.flipped[0]),
                                        {Things::faces, d.flipped}});
        record_.map = map_record(d);
        output_.write_layout(source.mesh, layout, d, input.attributes, input.unit);
        if (!loops_.empty()) write_loops(input);
        if (!common_.report.empty()) {
            PageDomain page = domain();
            PageMap map{"conformal", std::move(page.layout), d.face_abs_mu};
            map.outline = std::move(page.outline);
            write_page(common_, page.mesh, {std::move(map)}, {}, record_, source_, std::move(page.joined));
        }
        finish(record_, common_, "conformal", {output_.path(), common_.json, common_.report});
    }

    /// Short simple loops, PREFIX0.txt …, and generators through one vertex, PREFIX_generator0.txt ….
    void write_loops(const MeshInput& input) const {
        const auto write = [&](const std::string& name, const std::vector<int>& path) {
            std::string text;
            for (const int v : path) text += std::to_string(input.vertices[static_cast<std::size_t>(v)]) + "\n";
            write_atomically(loops_ + name + ".txt", text);
        };
        for (std::size_t l = 0; l < short_loops_.size(); ++l) write(std::to_string(l), short_loops_[l]);
        if (!record_.hyperbolic) return;
        for (std::size_t i = 0; i < record_.hyperbolic->generators.size(); ++i)
            write("_generator" + std::to_string(i), record_.hyperbolic->generators[i].vertices);
    }

    /// One linear solve.
    static SolveRecord direct_solve(int factorizations, double start) {
        SolveRecord solve;
        solve.iterations = 1;
        solve.factorizations = factorizations;
        solve.termination = to_string(Termination::converged);
        solve.seconds_total = seconds() - start;
        return solve;
    }

    void conclude(const Surface& source, const Positions& map, const Distortion& d, const char* method) {
        write_page(common_, source.mesh, {{method, map, d.face_abs_mu}}, {}, record_, source_);
        finish(record_, common_, method, {output_.path(), common_.json, common_.report});
    }

    void check(const Surface& source) const {
        const Topology& topology = source.topology;
        const auto loops = static_cast<int>(topology.boundary_loops.size());
        if (!loops_.empty() && topology.genus == 0)
            throw Error(Cause::bad_option, "--loops is for surfaces with handles, and SOURCE is none", "leave it out");
        if (topology.genus > 0 && (outer_ || centre_))
            throw Error(Cause::bad_option,
                        fmt::format("{} is for circle domains, and SOURCE has genus {}",
                                    outer_ ? "--outer" : "--centre", topology.genus),
                        "leave it out");
        if (sphere_.given() && (loops > 0 || topology.genus > 0))
            throw Error(Cause::bad_option,
                        fmt::format("--method is for closed surfaces of genus 0, and SOURCE has {}",
                                    loops > 0 ? "a boundary" : "a handle"),
                        "leave it out");
        const auto require = [&](int loop, const char* option) {
            if (loop >= loops)
                throw Error(Cause::bad_option, fmt::format("{} {}: there is no such boundary loop", option, loop),
                            "`beltrami info` prints the loops' numbers");
        };
        if (outer_ && topology.components == 1) require(*outer_, "--outer");
        if (!centre_) return;
        require(*centre_, "--centre");
        if (*centre_ == outer_.value_or(0))
            throw Error(Cause::bad_option, fmt::format("--centre {} is the outer loop", *centre_),
                        "name another loop, or another outer one with --outer");
    }

    std::string source_, loops_;
    std::vector<std::vector<int>> short_loops_;
    std::vector<int> beside_;  // of every added vertex one that was there
    std::optional<int> outer_, centre_;
    SphereMethodOption sphere_;
    OutputOptions output_;
    MetricOption metric_;
    MeshInputOptions options_;
};

}  // namespace

std::unique_ptr<Command> make_uniformize(CLI::App& parent) {
    return std::make_unique<Uniformize>(parent);
}

}  // namespace beltrami::cli
