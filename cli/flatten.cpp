#include <optional>

#include <beltrami/base/counted.h>
#include <beltrami/base/error.h>
#include <beltrami/charts/fold_free_disk.h>
#include <beltrami/charts/round_disk.h>
#include <beltrami/forms/cut_open.h>
#include <beltrami/uniformize/fold_free_flattening.h>

#include "command.h"
#include "mesh_input.h"
#include "output.h"
#include "page.h"

namespace beltrami::cli {

namespace {

class Flatten final : public Command {
  public:
    explicit Flatten(CLI::App& parent) {
        CLI::App* app = parent.add_subcommand(
            "flatten",
            "conformal map of a disk-like surface, or of a closed one that is cut open, to the plane, by conformal "
            "equivalence");
        app->add_option(
               "SOURCE", source_,
               "OBJ, PLY, OFF or STL; one component: a disk, with one boundary loop and genus 0, or closed, of any "
               "genus; that is cut open along edges, and vt is written per face corner")
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
        std::optional<CutOpen> cut;
        if (source.topology.components == 1 && source.topology.boundary_loops.empty()) {
            output_.check_seams();
            output_.check_layout();
            cut = cut_open(source);
            record.warnings.push_back({WarningKind::mended, "the surface is closed: it was cut open along " +
                                                                counted(cut->seam_edges, "edge", "edges")});
        }
        const Surface disk = cut ? Surface(cut->disk) : source;
        SolveRecord solve;
        const Eigen::VectorXcd map = disk_ ? to_disk(disk, solve) : input.unit * to_plane(disk, solve);
        solve.termination = to_string(Termination::converged);
        solve.seconds_total = seconds() - start;
        record.solve = solve;
        const Distortion d = distortion(disk.operators, disk_ ? map : Eigen::VectorXcd(map / input.unit));
        record.map = map_record(d);
        if (cut) {
            output_.write_layout(source.mesh, {positions_of(map), disk.mesh.faces.vertices()}, d, input.attributes,
                                 input.unit);
        } else {
            output_.write(source.mesh, map, d, input.attributes, input.unit);
        }
        write_page(common_, disk.mesh, {{"conformal", positions_of(map), d.face_abs_mu}}, {}, record, source_);
        finish(record, common_, "conformal", {output_.path(), common_.json, common_.report});
        return 0;
    }

    std::string hint(const Error& error) const override { return options_.hint(error, source_); }

  private:
    Eigen::VectorXcd to_disk(const Surface& source, SolveRecord& solve) {
        Chart chart = round_disk_chart(source);
        // Here the chart is what is asked for, and no differential is.
        for (Warning& warning : chart.warnings)
            if (warning.kind == WarningKind::chart && warning.where.of == Things::faces)
                warning.sentence = "the conformal map is far from conformal at " +
                                   counted(warning.where.indices.size(), "face", "faces");
        append(record_.warnings, chart.warnings);
        FoldFreeDisk disk = fold_free_disk(source, chart.vertices);
        solve.factorizations = chart.factorizations + disk.factorizations;
        if (!disk.fold_free) refuse("the map to the disk");
        if (disk.changed) record_.warnings.push_back({WarningKind::mended, what_was_mended(disk)});
        return std::move(disk.map);
    }

    /// In the unit of the source: with its boundary kept, edges there keep their lengths.
    Eigen::VectorXcd to_plane(const Surface& source, SolveRecord& solve) {
        FoldFreeFlattening flat = fold_free_flattening(source);
        solve.iterations = flat.flattening.iterations;
        solve.factorizations = flat.factorizations;
        if (!flat.fold_free) refuse("the flattening");
        if (!flat.unfolded.empty())
            record_.warnings.push_back(
                {WarningKind::mended,
                 counted(flat.unfolded.size(), "face came", "faces came") +
                     " out flipped, as edges were flipped on the way; the first is face " +
                     std::to_string(flat.unfolded[0]) + ". They were unfolded" +
                     (flat.kept_boundary ? ""
                                         : ", for which the boundary had to move: its edges do not keep their lengths"),
                 {Things::faces, flat.unfolded}});
        return std::move(flat.flattening.positions);
    }

    [[noreturn]] static void refuse(const std::string& what) {
        throw Error(Cause::not_solved,
                    what + " has folds that do not open: faces differ so much in size that rounding decides about them",
                    "remesh the surface, with edges of like length side by side");
    }

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
