#include <fmt/format.h>

#include <beltrami/base/error.h>
#include <beltrami/charts/uniformization.h>
#include <beltrami/mesh/edge_table.h>

#include "command.h"
#include "mesh_input.h"
#include "metric_option.h"
#include "output.h"
#include "page.h"
#include "sphere_option.h"
#include "words.h"

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
            "conformal map to the canonical domain: a closed surface to the sphere, a disk to the round disk, a "
            "surface with holes to the disk less round holes, with its moduli");
        app->add_option("SOURCE", source_, "OBJ, PLY, OFF or STL; one component of genus 0")->required();
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
        if (closed)
            to_sphere(source, input, start);
        else
            to_circles(source, input, start);
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

    void conclude(const Surface& source, const Positions& map, const Distortion& d, const char* method) {
        write_page(common_.report, source.mesh, {{method, map, d.face_abs_mu}}, {}, record_, source_);
        finish(record_, common_, method, {output_.path(), common_.json, common_.report});
    }

    void check(const Surface& source) const {
        const Topology& topology = source.topology;
        const auto loops = static_cast<int>(topology.boundary_loops.size());
        if (topology.components == 1 && topology.genus > 0)
            throw Error(Cause::bad_mesh,
                        fmt::format("SOURCE is {} surface of genus {}, which cannot be uniformized yet",
                                    loops == 0 ? "a closed" : "an open", topology.genus),
                        "cut it until a surface of genus 0 is left");
        if (loops > 0 && sphere_.given())
            throw Error(Cause::bad_option, "--method is for closed surfaces, and SOURCE has a boundary",
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

    std::string source_;
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
