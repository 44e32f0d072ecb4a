#include <algorithm>
#include <iterator>

#include <beltrami/applications/deform.h>
#include <beltrami/base/counted.h>
#include <beltrami/base/error.h>

#include "command.h"
#include "mesh_input.h"
#include "output.h"
#include "page.h"
#include "space_input.h"
#include "space_target.h"

namespace beltrami::cli {

namespace {

class Deform final : public Command {
  public:
    explicit Deform(CLI::App& parent) {
        CLI::App* app = parent.add_subcommand(
            "deform", "a surface in space deformed by handles, with small dilatation and without folds");
        app->add_option("MESH", source_, "OBJ, PLY, OFF or STL; of any topology, faces of any number of corners")
            ->required();
        app->add_option("--pin", pins_, "the handles: lines `vertex x y z`, boundary loops or any vertices")
            ->required()
            ->type_name("FILE");
        app->add_option("-o,--output", output_,
                        "the deformed mesh, in PLY with per face mu_re, mu_im, abs_mu, K of the deformation")
            ->required()
            ->type_name("OUT");
        app->add_option("--onto", target_,
                        std::string("the surface on which the result is to lie, a file or ") + kNamedSurfaces +
                            "; handles go to its nearest points")
            ->type_name("SURFACE");
        app->add_option("--minimize", goal_,
                        "what is made small of the map onto the surface: K, by the extremal map with bounds, where the "
                        "whole boundary of a MESH of genus 0 has places; max, the largest |mu|; spread, the standard "
                        "deviation of |mu|, by Gruber and Aulisa's iteration or the powers")
            ->check(CLI::IsMember({"K", "max", "spread"}))
            ->capture_default_str();
        app->add_option("--surface", surface_,
                        "without --onto: thin-plate, rigid (as rigid as possible), uniform (Gruber and Aulisa's QC "
                        "iteration), or the first of them without folds")
            ->check(CLI::IsMember({"automatic", "thin-plate", "rigid", "uniform"}))
            ->capture_default_str();
        app->add_option(
               "--p", wanted_.last_power,
               "of --minimize max and spread: up to which power |mu| counts, 2 for the mean, 32 for the largest")
            ->check(CLI::Range(2.0, 64.0))
            ->capture_default_str();
        options_.add_to(*app);
        common_.add_to(*app);
        app->footer(kExitCodes);
    }

    int run() override {
        require_mesh_format(output_);
        std::vector<NamedFile> inputs{{"MESH", source_}, {"--pin", pins_}};
        if (!names_surface(target_)) inputs.push_back({"--onto", target_});
        common_.check_files(inputs, {{"-o", output_}});
        if (!target_.empty() && surface_ != "automatic")
            throw Error(Cause::bad_option, "--surface chooses one where there is no --onto", "leave one of them out");
        record_.command = "deform";
        const Surface surface = surface_in_space(options_, source_, input_, record_);
        const PlacesInSpace handles = places_in_space(pins_, input_, "a handle");
        const double start = seconds();
        conclude(surface, handles.vertices.size(), solved(surface, handles), start);
        return 0;
    }

    std::string hint(const Error& error) const override {
        if (error.where().of == Things::edges && error.cause() == Cause::bad_boundary)
            return "--onto names a surface of your own";
        return options_.hint(error, source_);
    }

  private:
    Deformation solved(const Surface& surface, const PlacesInSpace& handles) {
        Progress progress(!common_.quiet);
        DeformOptions options = wanted_;
        options.progress = [&](int step, double value) {
            progress.show(step, value, goal_ == "K" ? "k" : "F");
            return true;
        };
        for (const DeformedSurface kind :
             {DeformedSurface::thin_plate, DeformedSurface::rigid, DeformedSurface::uniform})
            if (surface_ == to_string(kind)) options.surface = kind;
        for (const DeformGoal goal : {DeformGoal::dilatation, DeformGoal::largest, DeformGoal::spread})
            if (goal_ == to_string(goal)) options.goal = goal;
        DeformSolver solver(surface, handles.vertices, options);
        if (target_.empty()) return solver.solve(handles.places);
        if (names_surface(target_)) {
            if (input_.unit != 1)
                throw Error(Cause::bad_option, "MESH is too large or small for --onto " + target_,
                            "scale it to the surface's size");
            return solver.solve_onto(*named_surface(target_), handles.places);
        }
        return solver.solve_onto(MeshTarget(target_in_space(target_, input_.unit, record_.warnings)), handles.places);
    }

    void warn_of_flips(const Deformation& result) {
        const auto warn = [&](const std::vector<int>& faces, const char* why) {
            if (faces.empty()) return;
            record_.warnings.push_back({WarningKind::flipped_faces,
                                        counted(faces.size(), "face is flipped", "faces are flipped") +
                                            " on the surface, the first is face " + std::to_string(faces[0]) + why,
                                        {Things::faces, faces}});
        };
        warn(
            result.forced,
            ": all corners of a triangle there, or of a quad's corner, have places that turn it over, and no map opens "
            "it");
        std::vector<int> others;
        std::set_difference(result.distortion.flipped.begin(), result.distortion.flipped.end(), result.forced.begin(),
                            result.forced.end(), std::back_inserter(others));
        warn(others, ": move the handles in smaller steps, or take a finer mesh");
    }

    void conclude(const Surface& surface, std::size_t handles, const Deformation& result, double start) {
        append(record_.warnings, result.warnings);
        warn_of_flips(result);
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
        record_.solve.emplace();
        if (result.extremal) {
            take_bounds(map_record(*result.extremal));
            record_.solve = solve_record(*result.extremal, 0);
        } else {
            record_.solve->iterations = result.steps;
            record_.solve->termination =
                to_string(result.settled ? Termination::converged : Termination::iteration_limit);
        }
        record_.solve->factorizations = result.factorizations;
        record_.solve->seconds_total = seconds() - start;
        record_.deform = {to_string(result.kind),
                          to_string(result.goal),
                          static_cast<int>(handles),
                          result.of_surface.mean,
                          result.of_surface.max,
                          result.area_ratio,
                          result.folds};
        Mesh image = surface.mesh;
        image.positions = result.positions;
        write_with_texture(output_, image, input_.unit, result.distortion, input_.attributes);
        write_page(common_, surface.mesh, {{"deformed", image.positions, result.distortion.face_abs_mu}}, {}, record_,
                   source_);
        finish(record_, common_, "deformed", {output_, common_.json, common_.report});
    }

    /// k and what bounds it, of the map in the plane; what it does is measured on the surface.
    void take_bounds(MapRecord plane) {
        record_.map->k = plane.k;
        record_.map->K = plane.K;
        record_.map->K_lower = plane.K_lower;
        record_.map->K_lower_proved = plane.K_lower_proved;
        record_.map->K_upper = plane.K_upper;
        record_.map->bounds = std::move(plane.bounds);
    }

    std::string source_, pins_, output_, target_, surface_ = "automatic", goal_ = "max";
    DeformOptions wanted_;
    MeshInputOptions options_;
    MeshInput input_;
};

}  // namespace

std::unique_ptr<Command> make_deform(CLI::App& parent) {
    return std::make_unique<Deform>(parent);
}

}  // namespace beltrami::cli
