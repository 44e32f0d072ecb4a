#include <fmt/format.h>

#include <beltrami/base/error.h>
#include <beltrami/charts/uniformization.h>

#include "command.h"
#include "mesh_input.h"
#include "metric_option.h"
#include "output.h"
#include "page.h"
#include "words.h"

namespace beltrami::cli {

namespace {

class Uniformize final : public Command {
  public:
    explicit Uniformize(CLI::App& parent) {
        CLI::App* app = parent.add_subcommand(
            "uniformize",
            "conformal map to the canonical domain: a disk to the round disk, a surface with holes to the disk less "
            "round holes, with its moduli");
        app->add_option("SOURCE", source_, "OBJ, PLY, OFF or STL; one component of genus 0 with a boundary")
            ->required();
        output_.add_to(*app);
        app->add_option("--outer", outer_,
                        "the boundary loop, numbered as `beltrami info` prints it, that goes to the unit circle")
            ->check(CLI::NonNegativeNumber)
            ->capture_default_str()
            ->type_name("h");
        app->add_option(
               "--centre", centre_,
               "the loop whose circle goes around 0, the next one's centre to the positive real axis; default: "
               "the first one that is not the outer loop")
            ->check(CLI::NonNegativeNumber)
            ->type_name("h");
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
        metric_.load(input);
        const double start = seconds();
        const Surface source = metric_.surface_of(std::move(input.mesh));
        add_findings(source.findings, record.warnings);
        record.source = source_record(source);
        check(source);
        const Uniformization found = uniformization(source, outer_, centre_);
        const CircleDomainChart& chart = found.chart;
        SolveRecord solve;
        solve.iterations = chart.steps;
        solve.factorizations = chart.factorizations;
        solve.termination = to_string(chart.converged ? Termination::converged : Termination::iteration_limit);
        solve.seconds_total = seconds() - start;
        record.solve = solve;
        record.uniformization = uniformization_record(found);
        const std::vector<std::string>& more = chart.chart.warnings;
        record.warnings.insert(record.warnings.end(), more.begin(), more.end());
        const Distortion d = distortion(source.operators, found.map);
        if (!d.flipped.empty())
            record.warnings.push_back(counted(d.flipped.size(), "face comes", "faces come") +
                                      " out flipped; the first is face " + std::to_string(d.flipped[0]));
        record.map = map_record(d);
        output_.write(source.mesh, found.map, d, input.attributes, input.unit);
        write_page(common_.report, source.mesh, {{"conformal", positions_of(found.map), d.face_abs_mu}}, {}, record,
                   source_);
        finish(record, common_, "conformal", {output_.path(), common_.json, common_.report});
        return 0;
    }

    std::string hint() const override { return options_.hint(source_); }

  private:
    void check(const Surface& source) const {
        const Topology& topology = source.topology;
        const auto loops = static_cast<int>(topology.boundary_loops.size());
        if (topology.components == 1 && (loops == 0 || topology.genus > 0))
            throw Error(Cause::bad_mesh,
                        fmt::format("SOURCE is {} surface of genus {}, which cannot be uniformized yet",
                                    loops == 0 ? "a closed" : "an open", topology.genus),
                        loops == 0 && topology.genus == 0
                            ? "cut it open: remove a face, or cut along edges"
                            : "cut it until a surface of genus 0 with a boundary is left");
        const auto require = [&](int loop, const char* option) {
            if (loop >= loops)
                throw Error(Cause::bad_option, fmt::format("{} {}: there is no such boundary loop", option, loop),
                            "`beltrami info` prints the loops' numbers");
        };
        if (topology.components == 1) require(outer_, "--outer");
        if (!centre_) return;
        require(*centre_, "--centre");
        if (*centre_ == outer_)
            throw Error(Cause::bad_option, fmt::format("--centre {} is the outer loop", *centre_),
                        "name another loop, or another outer one with --outer");
    }

    std::string source_;
    int outer_ = 0;
    std::optional<int> centre_;
    OutputOptions output_;
    MetricOption metric_;
    MeshInputOptions options_;
};

}  // namespace

std::unique_ptr<Command> make_uniformize(CLI::App& parent) {
    return std::make_unique<Uniformize>(parent);
}

}  // namespace beltrami::cli
