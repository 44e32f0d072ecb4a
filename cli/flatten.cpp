#include <beltrami/charts/round_disk.h>
#include <beltrami/uniformize/flatten.h>

#include "command.h"
#include "output.h"
#include "page.h"
#include "words.h"

namespace beltrami::cli {

namespace {

class Flatten final : public Command {
  public:
    explicit Flatten(CLI::App& parent) {
        CLI::App* app = parent.add_subcommand(
            "flatten", "conformal map of a disk-like surface to the plane, by conformal equivalence");
        app->add_option("SOURCE", source_, "OBJ, PLY, OFF or STL; a disk: one component, one boundary loop, genus 0")
            ->required();
        output_.add_to(*app);
        app->add_flag("--disk", disk_, "go on to the round unit disk");
        common_.add_to(*app);
        app->footer(kExitCodes);
    }

    int run() override {
        output_.check();
        common_.check_files({{"SOURCE", source_}}, {{"-o", output_.path()}});
        Record record;
        record.command = "flatten";
        Mesh mesh = load(source_, record.warnings);
        const double start = seconds();
        const Surface source(std::move(mesh));
        add_findings(source.findings, record.warnings);
        record.source = source_record(source);
        SolveRecord solve;
        Eigen::VectorXcd map;
        if (disk_) {
            Chart chart = round_disk_chart(source);
            map = std::move(chart.vertices);
            solve.factorizations = chart.factorizations;
            record.warnings.insert(record.warnings.end(), chart.warnings.begin(), chart.warnings.end());
        } else {
            Flattening flat = flatten(source.mesh);
            map = std::move(flat.positions);
            solve.iterations = flat.iterations;
            solve.factorizations = flat.factorizations;
            if (!flat.flipped.empty())
                record.warnings.push_back(counted(flat.flipped.size(), "face comes", "faces come") +
                                          " out turned over, with edges flipped on the way; the first is face " +
                                          std::to_string(flat.flipped[0]));
        }
        solve.termination = to_string(Termination::converged);
        solve.seconds_total = seconds() - start;
        record.solve = solve;
        const Distortion d = distortion(source.operators, map);
        record.map = map_record(d);
        output_.write(source.mesh, map, d);
        write_page(common_.report, source.mesh, {{"conformal", positions_of(map), d.face_abs_mu}}, {}, record, source_);
        finish(record, common_, "conformal", {output_.path(), common_.json, common_.report});
        return 0;
    }

  private:
    std::string source_;
    bool disk_ = false;
    OutputOptions output_;
    CommonOptions common_;
};

}  // namespace

std::unique_ptr<Command> make_flatten(CLI::App& parent) {
    return std::make_unique<Flatten>(parent);
}

}  // namespace beltrami::cli
