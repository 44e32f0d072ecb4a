#include <set>

#include <fmt/format.h>

#include <beltrami/applications/deform.h>
#include <beltrami/base/error.h>
#include <beltrami/io/number_lists.h>

#include "command.h"
#include "mesh_input.h"
#include "output.h"
#include "page.h"
#include "words.h"

namespace beltrami::cli {

namespace {

class Deform final : public Command {
  public:
    explicit Deform(CLI::App& parent) {
        CLI::App* app = parent.add_subcommand(
            "deform", "a surface in space deformed by handles, with small dilatation and without folds");
        app->add_option("MESH", source_, "OBJ, PLY, OFF or STL; of any topology, triangles and quads")->required();
        app->add_option("--pin", pins_, "the handles: lines `vertex x y z`, boundary loops or any vertices")
            ->required()
            ->type_name("FILE");
        app->add_option("-o,--output", output_,
                        "the deformed mesh, in PLY with per face mu_re, mu_im, abs_mu, K of the deformation")
            ->required()
            ->type_name("OUT");
        app->add_option("--onto", target_,
                        "the surface on which the result is to lie; handles go to its nearest points")
            ->type_name("SURFACE");
        app->add_option("--surface", surface_,
                        "without --onto: thin-plate, rigid (as rigid as possible), uniform (Gruber and Aulisa's QC "
                        "iteration), or the first of them without folds")
            ->check(CLI::IsMember({"automatic", "thin-plate", "rigid", "uniform"}))
            ->capture_default_str();
        app->add_option("--p", wanted_.last_power,
                        "up to which power the dilatation counts: 2 for the mean, 32 for the largest |mu|")
            ->check(CLI::Range(2.0, 64.0))
            ->capture_default_str();
        options_.add_to(*app);
        common_.add_to(*app);
        app->footer(kExitCodes);
    }

    int run() override {
        require_mesh_format(output_);
        common_.check_files({{"MESH", source_}, {"--pin", pins_}, {"--onto", target_}}, {{"-o", output_}});
        record_.command = "deform";
        input_ = options_.load(source_, record_.warnings);
        cut_folded_quads(input_, record_.warnings);
        const Surface surface(input_.mesh);
        add_findings(surface.findings, record_.warnings);
        record_.source = source_record(surface, input_.unit);
        const auto [handles, places] = read_pins();
        const double start = seconds();
        conclude(surface, handles.size(), solved(surface, handles, places), start);
        return 0;
    }

    std::string hint(const Error& error) const override {
        if (error.where().of == Things::edges && error.cause() == Cause::bad_boundary)
            return "--onto names a surface of your own";
        return options_.hint(error, source_);
    }

  private:
    std::pair<std::vector<int>, Positions> read_pins() const {
        const IndexedRows rows =
            read_indexed_rows(pins_, 1, static_cast<int>(input_.numbers.size()), 3, "a handle: vertex x y z");
        std::vector<int> handles;
        std::set<int> seen;
        for (Eigen::Index i = 0; i < rows.indices.rows(); ++i) {
            handles.push_back(input_.number_of(rows.indices(i, 0), "a handle"));
            if (!seen.insert(handles.back()).second)
                throw Error(Cause::bad_boundary, fmt::format("{} names vertex {} twice", pins_, rows.indices(i, 0)),
                            "give one place", {Things::vertices, {handles.back()}});
        }
        return {std::move(handles), rows.values / input_.unit};
    }

    Deformation solved(const Surface& surface, const std::vector<int>& handles, const Positions& places) {
        Progress progress(!common_.quiet);
        DeformOptions options = wanted_;
        options.progress = [&](int step, double value) {
            progress.show(step, value, "F");
            return true;
        };
        for (const DeformedSurface kind :
             {DeformedSurface::thin_plate, DeformedSurface::rigid, DeformedSurface::uniform})
            if (surface_ == to_string(kind)) options.surface = kind;
        DeformSolver solver(surface, handles, options);
        if (target_.empty()) return solver.solve(places);
        MeshInput target = MeshInputOptions().load(target_, record_.warnings);
        cut_folded_quads(target, record_.warnings);
        target.mesh.positions *= target.unit / input_.unit;
        return solver.solve_onto(MeshTarget(target.mesh), places);
    }

    void conclude(const Surface& surface, std::size_t handles, const Deformation& result, double start) {
        append(record_.warnings, result.warnings);
        if (!result.folds.empty()) {
            std::vector<int> ends;
            for (const auto& edge : result.folds) ends.insert(ends.end(), edge.begin(), edge.end());
            record_.warnings.push_back({WarningKind::flipped_faces,
                                        counted(result.folds.size(), "edge folds", "edges fold") +
                                            " that did not before, the first from vertex " + std::to_string(ends[0]) +
                                            " to " + std::to_string(ends[1]),
                                        {Things::edges, std::move(ends)}});
        }
        record_.map = map_record(result.distortion);
        SolveRecord solve;
        solve.iterations = result.steps;
        solve.factorizations = result.factorizations;
        solve.termination = to_string(Termination::converged);
        solve.seconds_total = seconds() - start;
        record_.solve = solve;
        record_.deform = {to_string(result.kind), static_cast<int>(handles), result.of_surface.mean,
                          result.of_surface.max,  result.area_ratio,         result.folds};
        Mesh image = surface.mesh;
        image.positions = result.positions;
        write_with_texture(output_, image, input_.unit, result.distortion, input_.attributes);
        write_page(common_, surface.mesh, {{"deformed", image.positions, result.distortion.face_abs_mu}}, {}, record_,
                   source_);
        finish(record_, common_, "deformed", {output_, common_.json, common_.report});
    }

    std::string source_, pins_, output_, target_, surface_ = "automatic";
    DeformOptions wanted_;
    MeshInputOptions options_;
    MeshInput input_;
};

}  // namespace

std::unique_ptr<Command> make_deform(CLI::App& parent) {
    return std::make_unique<Deform>(parent);
}

}  // namespace beltrami::cli
