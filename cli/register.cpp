#include <fmt/format.h>

#include <beltrami/base/counted.h>
#include <beltrami/base/error.h>
#include <beltrami/forms/flat_torus.h>
#include <beltrami/hyperbolic/hyperbolic_domain.h>
#include <beltrami/registration/nearest_places.h>

#include "command.h"
#include "curve_option.h"
#include "landmark_options.h"
#include "marking_options.h"
#include "mesh_input.h"
#include "output.h"
#include "page.h"
#include "place_file.h"
#include "start_map_option.h"

namespace beltrami::cli {

namespace {

constexpr double kConformal = 1e-9;  // |μ| below which it has no direction

class Register final : public Command {
  public:
    explicit Register(CLI::App& parent) {
        CLI::App* app = parent.add_subcommand(
            "register",
            "carry a surface onto another one by the map of least dilatation that takes landmarks to their places, or "
            "handles to handles");
        app->add_option("SOURCE", source_,
                        "OBJ, PLY, OFF or STL; one component of any genus, closed or with a boundary")
            ->required();
        app->add_option("TARGET", target_, "likewise, of the same genus and with as many boundary loops")->required();
        app->add_option("-o,--output", output_,
                        "SOURCE's vertices at their places on TARGET, in PLY with per face mu_re, mu_im, abs_mu, K of "
                        "the map")
            ->required()
            ->type_name("OUT");
        landmarks_.add_to(*app);
        curves_.add_to(*app);
        app->add_option(
               "--method", method_,
               "extremal: least dilatation, with curves an estimate of it; lp: least Lᵖ norm of abs(mu); default: "
               "extremal, with --curves lp")
            ->check(CLI::IsMember({"extremal", "lp"}));
        app->add_option("--p", p_, "p of that norm; the larger the more even abs(mu) becomes")
            ->check(CLI::Range(2.0, 64.0))
            ->capture_default_str();
        marking_.add_to(*app);
        app->add_option("--start-map", start_,
                        "begin with the map that takes SOURCE's vertices to the points of TARGET nearest to this "
                        "mesh's: SOURCE's vertices and faces in their order, as OUT has them")
            ->type_name("FILE");
        app->add_option("--places", places_,
                        "write the place of every vertex on TARGET: lines `face b0 b1 b2`, of quads four weights")
            ->type_name("FILE");
        app->add_option("--max-iterations", max_iterations_, "of k and phi")->check(CLI::PositiveNumber);
        app->add_option("--outer", outer_, "of surfaces with a boundary: SOURCE's loop that goes to TARGET's outer one")
            ->check(CLI::NonNegativeNumber)
            ->capture_default_str()
            ->type_name("h");
        app->add_option("--target-outer", target_outer_, "that loop of TARGET")
            ->check(CLI::NonNegativeNumber)
            ->capture_default_str()
            ->type_name("h");
        options_.add_to(*app);
        common_.add_to(*app);
        app->footer(kExitCodes);
    }

    int run() override {
        require_mesh_format(output_);
        std::vector<NamedFile> inputs = landmarks_.inputs();
        const std::vector<NamedFile> curve_files = curves_.inputs();
        inputs.insert(inputs.end(), curve_files.begin(), curve_files.end());
        inputs.insert(inputs.end(), {{"SOURCE", source_}, {"TARGET", target_}, {"--start-map", start_}});
        const std::vector<NamedFile> paths = marking_.inputs();
        inputs.insert(inputs.end(), paths.begin(), paths.end());
        common_.check_files(inputs, {{"-o", output_}, {"--places", places_}});
        record_.command = "register";
        MeshInput source_input = load("SOURCE", source_), target_input = load("TARGET", target_);
        const std::vector<SurfaceLandmark> landmarks =
            landmarks_.landmarks(source_input, target_input, record_.warnings);
        RegistrationOptions options;
        options.waypoints = landmarks_.waypoints(source_input, target_input);
        if (max_iterations_) options.map.max_iterations = *max_iterations_;
        if (!start_.empty()) options.start = places_near(start_points(source_input.mesh, target_input), target_input);
        const Surface source = surface("SOURCE", source_input), target = surface("TARGET", target_input);
        record_.source = source_record(source);
        const int loops = static_cast<int>(source.topology.boundary_loops.size());
        // Of genus 0 with holes there are two ways: circle domains, and here, where a class is told.
        const bool holes_in_a_class =
            source.topology.genus == 0 && loops > 2 && (!marking_.given().empty() || !start_.empty());
        if (source.topology.components == 1 && (source.topology.genus > 0 || holes_in_a_class)) {
            if (!landmarks.empty() || !options.waypoints.empty())
                throw Error(Cause::bad_option,
                            holes_in_a_class
                                ? "--landmarks go with the class of circle domains, and another one is told"
                                : "--landmarks are for surfaces of genus 0: no extremal map of surfaces "
                                  "with handles is known here that takes points to points",
                            "leave them out; the class is told by --loop, --start-map or --twist");
            if (outer_ != 0 || target_outer_ != 0)
                throw Error(
                    Cause::bad_option,
                    "--outer and --target-outer are for circle domains: here boundary loops go to those nearest",
                    "leave them out");
            if (least_lp())
                throw Error(Cause::bad_option, "least Lᵖ maps and curves are registered on surfaces of genus 0",
                            "leave them out, or follow a norm with beltrami flow --onto TARGET");
            with_handles(source, target, source_input, target_input);
            return 0;
        }
        if (const std::string stray = marking_.given(); !stray.empty())
            throw Error(Cause::bad_option,
                        stray + " is for surfaces with handles or with three holes and more, and SOURCE is none",
                        "leave it out");
        if (is_closed(source) != is_closed(target))
            throw Error(Cause::bad_mesh, "one of SOURCE and TARGET is closed and the other has a boundary",
                        "fill the holes of the one, or cut the other open");
        if (least_lp()) {
            run_least_lp(source, target, landmarks, curves_.pairs(source_input, target_input, record_.warnings),
                         options, source_input, target_input);
            return 0;
        }
        Progress progress(!common_.quiet);
        options.map.progress = [&](int iteration, double k) {
            progress.show(iteration, k);
            return true;
        };
        if (is_closed(source))
            conclude(register_spheres(source, target, landmarks, options), source, source_input, target_input,
                     landmarks);
        else
            conclude(open(source, target, landmarks, options), source, source_input, target_input, landmarks);
        return 0;
    }

    std::string hint(const Error& error) const override {
        const std::string of_source = options_.hint(error, source_);
        return of_source.empty() ? options_.hint(error, target_) : of_source;
    }

  private:
    /// Curves are held by the flow, whatever is to be least.
    bool least_lp() const { return method_ == "lp" || curves_.given(); }

    void run_least_lp(const Surface& source, const Surface& target, const std::vector<SurfaceLandmark>& landmarks,
                      const std::vector<CurvePair>& curves, const RegistrationOptions& given,
                      const MeshInput& source_input, const MeshInput& target_input) {
        if (!given.waypoints.empty())
            throw Error(Cause::bad_option, "--waypoints belong to --method extremal without --curves",
                        "lead curves instead, or begin with --start-map");
        CurveRegistrationOptions options;
        options.p = p_;
        options.extremal = method_ == "extremal";
        options.start = given.start;
        options.outer_loop = outer_;
        options.target_outer_loop = target_outer_;
        if (max_iterations_) options.flow.max_iterations = *max_iterations_;
        Progress progress(!common_.quiet);
        options.extremal_progress = [&](int iteration, double k) {
            progress.show(iteration, k);
            return true;
        };
        const LpRegistration found = register_least_lp(source, target, landmarks, curves, options);
        append(record_.warnings, found.warnings);
        record_.map = map_record(found);
        record_.solve = solve_record(found.map, seconds() - begun_);
        record_.registration = registration_record(found, p_, target_, landmarks.size());
        record_.registration->lp->curve_distance *= target_input.unit;
        write(found, page_of(found, found.carried.distortion), found.carried.distortion, source_input, target_input);
    }

    static bool is_closed(const Surface& surface) { return surface.topology.boundary_loops.empty(); }

    OpenRegistration open(const Surface& source, const Surface& target, const std::vector<SurfaceLandmark>& landmarks,
                          const RegistrationOptions& given) const {
        OpenRegistrationOptions options;
        options.start = given.start;
        options.waypoints = given.waypoints;
        options.map.progress = given.map.progress;
        if (max_iterations_) options.map.max_iterations = *max_iterations_;
        options.outer_loop = outer_;
        options.target_outer_loop = target_outer_;
        return register_open(source, target, landmarks, options);
    }

    template <class Found>
    void conclude(const Found& found, const Surface& surface, const MeshInput& source, const MeshInput& target,
                  const std::vector<SurfaceLandmark>& landmarks) {
        append(record_.warnings, found.warnings);
        record_.registration = registration_record(found, target_, landmarks.size());
        if (record_.registration->largest_distance) *record_.registration->largest_distance *= target.unit;
        const Distortion own = own_distortion(found.map, surface);
        RegistrationPage page = page_of(found, own);
        page.history = found.map.history;
        // Where edges of the source were split φ belongs to another mesh.
        const bool same = found.map.phi.size() == surface.operators.sample_count();
        if (wants_page() && same && !found.map.differential.zero())
            page.map.differential = page_differential(surface, found.map.phi, found.map.differential);
        conclude_with(found, found.map, std::move(page), source, target, own);
    }

    /// Of the surface's own faces, where the map is one of a mesh with edges split.
    static Distortion own_distortion(const ExtremalMap& map, const Surface& surface) {
        if (!map.split) return map.distortion;
        return distortion(surface.operators, Eigen::VectorXcd(map.map.head(surface.mesh.vertex_count())));
    }
    static const Distortion& own_distortion(const ExtremalSphereMap& map, const Surface&) { return map.distortion; }

    template <class Map>
    void conclude_with(const CarriedSurface& carried, const Map& map, RegistrationPage&& page, const MeshInput& source,
                       const MeshInput& target) {
        conclude_with(carried, map, std::move(page), source, target, map.distortion);
    }

    template <class Map>
    void conclude_with(const CarriedSurface& carried, const Map& map, RegistrationPage&& page, const MeshInput& source,
                       const MeshInput& target, const Distortion& of_faces) {
        record_.map = map_record(map);
        record_.solve = solve_record(map, seconds() - begun_);
        write(carried, std::move(page), of_faces, source, target);
    }

    bool wants_page() const { return !common_.report.empty(); }
    static RegistrationPage page_of(const CarriedSurface& found, const Distortion& distortion) {
        return {{"registration", found.positions, distortion.face_abs_mu}};
    }

    void write(const CarriedSurface& found, RegistrationPage page, const Distortion& distortion,
               const MeshInput& source, const MeshInput& target) {
        write_at(output_, source.mesh.faces, target.unit * found.positions, distortion, source.attributes);
        if (!places_.empty()) write_places(places_, target.mesh, found.places);
        write_page(common_, source.mesh, std::move(page), record_, source_);
        finish(record_, common_, "registration", {output_, places_, common_.json, common_.report});
    }

    MeshInput load(const char* name, const std::string& path) {
        Warnings warnings;
        MeshInput input = options_.load(path, warnings);
        cut_folded_quads(input, warnings);
        for (Warning& warning : warnings) record_.warnings.push_back(prefixed(name, std::move(warning)));
        return input;
    }

    Surface surface(const char* name, const MeshInput& input) {
        try {
            Surface result(input.mesh);
            Warnings findings;
            add_findings(result.findings, findings);
            for (Warning& finding : findings) record_.warnings.push_back(prefixed(name, std::move(finding)));
            return result;
        } catch (const Error& error) {
            throw Error(error.cause(), std::string(name) + ": " + error.what(), {}, error.where());
        }
    }

    /// The vertices of --start-map, in the target's unit.
    Positions start_points(const Mesh& source, const MeshInput& target) {
        const Mesh mesh = load_of_same_faces("--start-map", start_, source, record_.warnings);
        Positions points(mesh.vertex_count(), 3);
        for (int v = 0; v < mesh.vertex_count(); ++v) points.row(v) = mesh.point(v) / target.unit;
        return points;
    }

    static std::vector<MeshPoint> places_near(const Positions& points, const MeshInput& target) {
        std::vector<MeshPoint> places;
        for (const NearestPlace& nearest : nearest_places(target.mesh, points)) places.push_back(nearest.place);
        return places;
    }

    /// Surfaces of genus 1 and more, and of genus 0 with holes.
    void with_handles(const Surface& source, const Surface& target, const MeshInput& source_input,
                      const MeshInput& target_input) {
        const auto topology = [](const Surface& surface) {
            const std::size_t loops = surface.topology.boundary_loops.size();
            return fmt::format(
                "{}genus {}{}", loops == 0 ? "a closed surface of " : "", surface.topology.genus,
                loops == 0 ? std::string() : " with " + counted(loops, "boundary loop", "boundary loops"));
        };
        if (topology(source) != topology(target))
            throw Error(Cause::bad_mesh, fmt::format("SOURCE is {}, and TARGET {}", topology(source), topology(target)),
                        "take surfaces of one topology");
        HandleMarking marking = marking_.load(source_input, target_input);
        if (!start_.empty()) marking.start = start_points(source_input.mesh, target_input);
        if (source.topology.genus > 1 || !is_closed(source)) {
            onto_hyperbolic(triangles("SOURCE", source_input), triangles("TARGET", target_input), marking);
            return;
        }
        const TorusMap found =
            register_tori(source, target, marking_.searches() ? std::nullopt : std::optional(std::move(marking)));
        append(record_.warnings, found.warnings);
        record_.registration = registration_record(found, target_);
        RegistrationPage page = page_of(found, found.distortion);
        if (wants_page()) {
            const FlatTorus torus = flat_torus(source);
            page.domain = page_domain(source, torus);
            if (found.k > kConformal) page.map.differential = page_differential(source, torus, found.mu);
        }
        conclude_with(found, found, std::move(page), source_input, target_input);
    }

    /// The mesh in triangles.
    MeshInput triangles(const char* name, const MeshInput& input) {
        MeshInput result = input;
        Warnings warnings;
        cut_into_triangles(result, warnings);
        for (Warning& warning : warnings) record_.warnings.push_back(prefixed(name, std::move(warning)));
        return result;
    }

    void onto_hyperbolic(const MeshInput& source_input, const MeshInput& target_input, HandleMarking marking) {
        const Surface source(source_input.mesh), target(target_input.mesh);
        const HyperbolicShape from(source), to(target);
        if (marking.search)
            marking.search->progress = [&](int done, int all) {
                if (!common_.quiet) fmt::print(stderr, "start {} of {}\n", done, all);
                return true;
            };
        HyperbolicMapOptions options;
        if (max_iterations_) options.max_iterations = *max_iterations_;
        Progress progress(!common_.quiet);
        options.progress = [&](int iteration, double k) {
            progress.show(iteration, k);
            return true;
        };
        const HandleRegistration found = register_handles(from, to, marking, options);
        append(record_.warnings, found.map.warnings);
        record_.registration = registration_record(found, from, target_);
        RegistrationPage page = page_of(found.map, found.map.distortion);
        page.history = found.map.history;
        if (wants_page()) {
            page.domain = page_domain(from.surface(), from.metric(), hyperbolic_domain(from.surface(), from.metric()));
            if (!found.map.differential.zero())
                page.map.differential = page_differential(from.surface(), found.map.phi, found.map.differential);
        }
        MeshInput mapped = source_input;
        if (from.split()) {
            record_.split = split_record(*from.split(), source.mesh.vertex_count());
            take_split(mapped, *from.split());
        }
        conclude_with(found.map, found.map, std::move(page), mapped, target_input);
    }

    std::string source_, target_, output_, start_, places_;
    std::optional<int> max_iterations_;
    int outer_ = 0, target_outer_ = 0;
    double begun_ = seconds();
    LandmarkOptions landmarks_;
    CurveOption curves_;
    std::string method_;
    double p_ = 2;
    MarkingOptions marking_;
    MeshInputOptions options_;
};

}  // namespace

std::unique_ptr<Command> make_register(CLI::App& parent) {
    return std::make_unique<Register>(parent);
}

}  // namespace beltrami::cli
