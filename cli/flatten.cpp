#include <beltrami/base/error.h>
#include <beltrami/charts/fold_free_disk.h>
#include <beltrami/charts/round_disk.h>
#include <beltrami/uniformize/flatten.h>

#include "command.h"
#include "mesh_input.h"
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
        options_.add_to(*app);
        common_.add_to(*app);
        app->footer(kExitCodes);
    }

    int run() override {
        output_.check();
        common_.check_files({{"SOURCE", source_}}, {{"-o", output_.path()}});
        Record& record = record_;
        record.command = "flatten";
        MeshInput input = options_.load(source_, record.warnings);
        const double start = seconds();
        const Surface source(std::move(input.mesh));
        add_findings(source.findings, record.warnings);
        record.source = source_record(source, input.unit);
        SolveRecord solve;
        Eigen::VectorXcd map;
        if (disk_) {
            Chart chart = round_disk_chart(source);
            solve.factorizations = chart.factorizations;
            append(record.warnings, chart.warnings);
            FoldFreeDisk disk = fold_free_disk(source, chart.vertices);
            solve.factorizations += disk.factorizations;
            if (!disk.fold_free)
                throw Error(
                    Cause::not_solved,
                    "the map to the disk has folds that do not open: faces differ so much in size that rounding "
                    "decides about them",
                    "remesh the surface, with edges of like length side by side");
            if (disk.changed) record.warnings.push_back({WarningKind::mended, what_was_mended(disk)});
            map = std::move(disk.map);
        } else {
            Flattening flat = flatten(source.mesh);
            map = input.unit * flat.positions;  // edges of the boundary keep their lengths
            solve.iterations = flat.iterations;
            solve.factorizations = flat.factorizations;
            if (!flat.flipped.empty())
                record.warnings.push_back({WarningKind::flipped_faces,
                                           counted(flat.flipped.size(), "face comes", "faces come") +
                                               " out flipped, as edges were flipped on the way; the first is face " +
                                               std::to_string(flat.flipped[0]),
                                           {Things::faces, flat.flipped}});
        }
        solve.termination = to_string(Termination::converged);
        solve.seconds_total = seconds() - start;
        record.solve = solve;
        const Distortion d = distortion(source.operators, disk_ ? map : Eigen::VectorXcd(map / input.unit));
        record.map = map_record(d);
        output_.write(source.mesh, map, d, input.attributes, input.unit);
        write_page(common_, source.mesh, {{"conformal", positions_of(map), d.face_abs_mu}}, {}, record, source_);
        finish(record, common_, "conformal", {output_.path(), common_.json, common_.report});
        return 0;
    }

    std::string hint(const Error& error) const override { return options_.hint(error, source_); }

  private:
    static std::string what_was_mended(const FoldFreeDisk& disk) {
        const std::string boundary =
            !disk.kept_boundary ? "its boundary does not go round once, so that arc length decides about its places; "
            : disk.moved_boundary > 0
                ? counted(disk.moved_boundary, "boundary edge runs", "boundary edges run") + " backwards or too short; "
                : "";
        return "the conformal map is not one-to-one on this mesh: " + boundary +
               "this is the map without folds nearest to a conformal one";
    }

    std::string source_;
    bool disk_ = false;
    MeshInputOptions options_;
    OutputOptions output_;
};

}  // namespace

std::unique_ptr<Command> make_flatten(CLI::App& parent) {
    return std::make_unique<Flatten>(parent);
}

}  // namespace beltrami::cli
