#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <beltrami/base/counted.h>
#include <beltrami/base/error.h>
#include <beltrami/charts/chart_places.h>
#include <beltrami/flow/beltrami_flow.h>
#include <beltrami/flow/ring_module.h>
#include <beltrami/solve/quasiconformal_map.h>
#include <beltrami/starts/target_model.h>
#include <beltrami/targets/mesh_target.h>

#include "along_target.h"
#include "boundary_options.h"
#include "command.h"
#include "homotopy_options.h"
#include "mesh_input.h"
#include "metric_option.h"
#include "mu_option.h"
#include "onto_options.h"
#include "output.h"
#include "page.h"
#include "space_target.h"
#include "start_map_option.h"

namespace beltrami::cli {

namespace {

class Flow final : public Command {
  public:
    explicit Flow(CLI::App& parent) {
        CLI::App* app = parent.add_subcommand(
            "flow",
            "the map with a given Beltrami coefficient: with prescribed boundary values, onto a target along whose "
            "curves the boundary slides (the Beltrami holomorphic flow of Ng, Gu and Lui), or along a surface in "
            "space, "
            "there also that of least distortion (the discrete Beltrami flow of Wong and Zhao)");
        app->add_option(
               "SOURCE", source_,
               "OBJ, PLY, OFF or STL; one component with a boundary, with --onto of genus 0, along a surface in "
               "space of any kind")
            ->required();
        output_.add_to(*app);
        coefficient_.add_to(*app, "the Beltrami coefficient of the map");
        along_.add_to(*app);
        curves_.add_to(*app);
        boundary_.add_to(*app,
                         "; or, along a surface in space, how the boundary moves: fixed, where the start has it; "
                         "tangential, along that of TARGET (the default where TARGET has one); or free on TARGET",
                         "; along a surface in space `vertex x y z`, held there");
        onto_.add_to(*app);
        homotopy_.add_to(*app);
        start_map_.add_to(*app, "; along a surface in space its vertices stand near their images");
        metric_.add_to(*app);
        app->add_option("--tolerance", options_.tolerance,
                        "with --onto: stop when a step moves no boundary vertex by more, as part of its curve, and "
                        "changes the map by less, as part of its size; along a surface in space: no vertex by more, as "
                        "part of the image's size")
            ->check(CLI::PositiveNumber)
            ->capture_default_str()
            ->type_name("T");
        app->add_option("--max-iterations", options_.max_iterations, "with --onto: linear solves")
            ->check(CLI::PositiveNumber)
            ->capture_default_str()
            ->type_name("N");
        app->add_option("--step", options_.step,
                        "with --onto: the epsilon of the flow, above 0 and at most 1: every step asks for so much of "
                        "the coefficient and for that of the map at hand for the rest; not along a surface in space")
            ->capture_default_str()
            ->type_name("E");
        mesh_options_.add_to(*app);
        common_.add_to(*app);
        app->footer(kExitCodes);
    }

    int run() override {
        check();
        Record& record = record_;
        record.command = "flow";
        input_ = mesh_options_.load(source_, record.warnings);
        if (!AlongTarget::says_how_it_moves(boundary_.spec()) && !names_surface(onto_.path()) && !along_.minimizes())
            boundary_.load(input_);
        homotopy_.load();
        metric_.load(input_);
        const double start = seconds();
        const Surface source = metric_.surface_of(std::move(input_.mesh));
        add_findings(source.findings, record.warnings);
        record.source = source_record(source, input_.unit);
        if (along_surface(source)) {
            follow(source, start, record);
            return 0;
        }
        const Eigen::VectorXcd mu = coefficient_.values(source);
        record.flow.emplace();
        record.flow->coefficient = coefficient_.inputs()[0].path;
        record.solve.emplace();
        if (onto_.given()) {
            slide(source, mu, start, record);
        } else {
            prescribe(source, mu, start, record);
        }
        return 0;
    }

    std::string hint(const Error& error) const override { return mesh_options_.hint(error, source_); }

  private:
    void check() const {
        output_.check();
        std::vector<NamedFile> inputs = boundary_.inputs();
        const auto add = [&](const std::vector<NamedFile>& more) {
            inputs.insert(inputs.end(), more.begin(), more.end());
        };
        add(coefficient_.inputs());
        add(homotopy_.inputs());
        if (!names_surface(onto_.path())) add(onto_.inputs());
        add(start_map_.inputs());
        add(metric_.inputs());
        add(curves_.inputs());
        add(along_.inputs());
        inputs.push_back({"SOURCE", source_});
        std::vector<NamedFile> outputs = onto_.outputs();
        outputs.insert(outputs.begin(), {"-o", output_.path()});
        common_.check_files(inputs, std::move(outputs));
        options_.validate();
        if (coefficient_.given() == along_.minimizes())
            throw Error(Cause::bad_option,
                        coefficient_.given() ? "--mu and --minimize-lp are two different maps"
                                             : "nothing says which map is meant",
                        "give one of --mu and --minimize-lp");
        if (curves_.given() && metric_.given())
            throw Error(Cause::bad_option, "--curves run along geodesics of SOURCE as it stands, not of another metric",
                        "leave one of --curves and --metric out");
        if (follows_by_options()) {
            check_along();
            return;
        }
        if (onto_.given()) {
            if (boundary_.given())
                throw Error(Cause::bad_option,
                            "--boundary, --hole or --pin prescribes boundary values, with --onto the boundary slides",
                            "leave one of them out");
            if (start_map_.given() && (homotopy_.given() || onto_.pairs_loops()))
                throw Error(Cause::bad_option,
                            "--start-map says already which loop goes where, and how: --loops, --match and --waypoints "
                            "do too",
                            "leave one of them out");
            return;
        }
        if (const std::string stray = onto_.stray(); !stray.empty())
            throw Error(Cause::bad_option, stray + " belongs to --onto");
        if (const std::string stray = along_.stray(); !stray.empty())
            throw Error(Cause::bad_option, stray + " belongs to --onto a surface in space");
        if (!boundary_.given())
            throw Error(Cause::bad_option, "the coefficient alone does not say where the boundary goes",
                        "give --boundary, --hole or --pin, or --onto TARGET");
        if (homotopy_.given() || start_map_.given())
            throw Error(Cause::bad_option,
                        "with prescribed boundary values the map is one linear solve: it has no start, and the class "
                        "that the coefficient gives it",
                        "leave out --start-map, --turns and --waypoints");
    }

    /// Whether the options alone say that the map goes along a surface in space.
    bool follows_by_options() const {
        return names_surface(onto_.path()) || along_.minimizes() || curves_.given() ||
               AlongTarget::says_how_it_moves(boundary_.spec());
    }
    bool along_surface(const Surface& source) const {
        return onto_.given() && (follows_by_options() || source.topology.boundary_loops.empty());
    }

    void check_along() const {
        if (!onto_.given())
            throw Error(Cause::bad_option,
                        (along_.minimizes() ? std::string("--minimize-lp is")
                         : curves_.given()  ? std::string("--curves are")
                                            : "--boundary " + boundary_.spec() + " is") +
                            " about maps along a surface",
                        "give --onto TARGET");
        if (!boundary_.spec().empty() && !AlongTarget::says_how_it_moves(boundary_.spec()))
            throw Error(Cause::bad_option,
                        "--boundary " + boundary_.spec() +
                            " says where the boundary goes, but along "
                            "a surface in space it is only to be said how it moves",
                        "give --boundary fixed, tangential or free, and --pin");
        if (options_.step != 1)
            throw Error(Cause::bad_option, "--step belongs to the flow whose boundary slides along curves of the plane",
                        "leave it out; steps along a surface find their own lengths");
        const std::string stray = onto_.stray();
        if (homotopy_.given() || (!stray.empty() && stray != "--places"))
            throw Error(
                Cause::bad_option,
                (stray.empty() || stray == "--places" ? std::string("--turns and --waypoints do") : stray + " does") +
                    " not belong to a map along a surface in space",
                "leave it out; --start-map says where the map begins");
    }

    /// Along a surface in space.
    void follow(const Surface& source, double start, Record& record) {
        check_along();
        if (!names_surface(onto_.path())) onto_.load(input_, record.warnings);
        std::optional<Eigen::VectorXcd> mu;
        record.surface_flow.emplace();
        if (coefficient_.given()) {
            mu = coefficient_.values(source);
            record.surface_flow->coefficient = coefficient_.inputs()[0].path;
        }
        const SurfaceFlowMap flow = [&] {
            Progress progress(!common_.quiet);
            SurfaceFlowOptions options;
            options.tolerance = options_.tolerance;
            options.max_iterations = options_.max_iterations;
            options.progress = [&](int iteration, const SurfaceFlowIteration& now, const TargetMap&) {
                progress.show(iteration, now.error.l2, "rms of mu's error");
                return true;
            };
            return along_.run(
                {source, input_, onto_, start_map_, curves_, boundary_.spec(), boundary_.pin_file(), mu, options},
                *record.surface_flow, record.warnings);
        }();
        record.solve.emplace();
        record.solve->iterations = flow.iterations;
        record.solve->termination = to_string(flow.termination);
        record.solve->factorizations = flow.factorizations;
        record.solve->seconds_total = seconds() - start;
        if (mu && !flow.fits) name_module(source, *mu, record);
        record.map = map_record(flow.distortion);
        const Positions images = positions_of(flow.map.points);
        if (AlongTarget::flat(onto_)) {
            output_.write(source.mesh, Eigen::VectorXcd(images.col(0) + Complex(0, 1) * images.col(1)), flow.distortion,
                          input_.attributes, input_.unit);
        } else {
            write_at(output_.path(), source.mesh.faces, images, flow.distortion, input_.attributes);
        }
        if (onto_.surface()) onto_.write_places(places_of(flow.map.points));
        write_page(common_, source.mesh, {{"flow", images, flow.distortion.face_abs_mu}}, {}, record, source_);
        finish(record, common_, "flow", {output_.path(), onto_.places_file(), common_.json, common_.report});
    }

    /// What a ring would have to be for the coefficient.
    static void name_module(const Surface& source, const Eigen::VectorXcd& mu, Record& record) {
        if (source.topology.genus != 0 || source.topology.boundary_loops.size() != 2 ||
            source.operators.sample_count() != source.mesh.face_count())
            return;
        const double module = ring_module(source, mu);
        record.warnings.push_back(
            {WarningKind::coefficient, fmt::format("the coefficient is that of maps onto rings of module {:.4f}, with "
                                                   "radii 1 and {:.4f}",
                                                   module, std::exp(-module))});
    }

    /// A loop of which nothing is said has been forgotten.
    static void require_loops(const Surface& source, const BoundaryCondition& boundary) {
        std::vector<char> prescribed(static_cast<std::size_t>(source.mesh.vertex_count()), 0);
        for (const int v : boundary.vertices) prescribed[v] = 1;
        for (const std::vector<int>& loop : source.topology.boundary_loops)
            if (std::none_of(loop.begin(), loop.end(), [&](int v) { return prescribed[v]; }))
                require_whole_boundary(boundary, source);
    }

    void prescribe(const Surface& source, const Eigen::VectorXcd& mu, double start, Record& record) const {
        const BoundaryCondition boundary = boundary_.values(source);
        require_loops(source, boundary);
        if (const std::size_t free = unprescribed_boundary(boundary, source).size(); free > 0)
            record.warnings.push_back({WarningKind::free_boundary,
                                       counted(free, "boundary vertex is", "boundary vertices are") +
                                           " free: of all maps with the others in their places this is the one whose "
                                           "coefficient is nearest in the least-squares sense"});
        const Eigen::VectorXcd map = quasiconformal_map(source, mu, boundary);
        record.solve->termination = to_string(Termination::converged);
        record.solve->iterations = record.solve->factorizations = 1;
        record.solve->seconds_total = seconds() - start;
        record.flow->error = coefficient_error(source, map, mu);
        if (!coefficient_fits(record.flow->error))
            record.warnings.push_back(
                {WarningKind::coefficient,
                 "the boundary values are not those of a map with this coefficient: the relative residual is " +
                     std::to_string(record.flow->error.residual) + ", of which " +
                     std::to_string(record.flow->error.misfit) +
                     " are no error of the mesh; the map is the least-squares one"});
        const Distortion measured = distortion(source.operators, map);
        if (!measured.flipped.empty())
            record.warnings.push_back({WarningKind::flipped_faces,
                                       "flipped faces in the result: " + std::to_string(measured.flipped.size()) +
                                           "; it is not one-to-one there",
                                       {Things::faces, measured.flipped}});
        output_.write(source.mesh, map, measured, input_.attributes, input_.unit);
        close(source, map, measured, record);
    }

    /// The start of a flow onto a domain.
    SlidingStart start_on(const Surface& source, const TargetDomain& target, const Correspondence& wanted,
                          Record& record) const {
        std::optional<Eigen::VectorXcd> map = start_map_.load(source.mesh, record.warnings);
        if (!map) return flow_start(source, target, wanted);
        std::vector<int> held;
        for (const Mark& mark : wanted.marks) {
            if (mark.vertex >= 0 && mark.vertex < map->size())
                (*map)[mark.vertex] = target.curve(on_curve(mark).curve).point(on_curve(mark).parameter);
            held.push_back(mark.vertex);
        }
        return flow_start(source, target, *map, held);
    }

    void slide(const Surface& source, const Eigen::VectorXcd& mu, double start, Record& record) {
        onto_.load(input_, record.warnings);
        Correspondence where;
        where.outer_loop = boundary_.outer_loop();
        onto_.apply(where);
        homotopy_.refuse_turns();
        homotopy_.apply(source, where);
        std::optional<CircleDomainChart> circles;  // of a target that is a surface
        if (onto_.surface()) {
            circles = circle_domain_chart(*onto_.surface());
            where = correspondence_on_circles(where, *onto_.surface(), *circles);
        }
        const TargetDomain target = circles ? circle_target(*circles) : *onto_.domain();
        const FlowMap flow = [&] {
            Progress progress(!common_.quiet);
            FlowOptions options = options_;
            options.progress = [&](int iteration, const FlowIteration& now, const Eigen::VectorXcd&) {
                progress.show(iteration, now.error.residual, "residual");
                return true;
            };
            return beltrami_flow(source, mu, start_on(source, target, where, record), options);
        }();
        record.solve->iterations = flow.iterations;
        record.solve->termination = to_string(flow.termination);
        record.solve->factorizations = flow.factorizations + (circles ? circles->factorizations : 0);
        record.solve->seconds_total = seconds() - start;
        record.flow->target = onto_.path();
        record.flow->error = flow.error;
        record.flow->loops = flow.loops;
        append(record.warnings, flow.warnings);
        if (!flow.fits) name_module(source, mu, record);
        if (circles) {
            const std::vector<Complex> images(flow.map.begin(), flow.map.end());
            const std::vector<MeshPoint> places = locate_in_chart(*onto_.surface(), circles->chart.vertices, images);
            output_.write(source.mesh, positions_on(onto_.surface()->mesh, places), flow.map, flow.distortion,
                          input_.attributes);
            onto_.write_places(places);
        } else {
            output_.write(source.mesh, flow.map, flow.distortion, input_.attributes, input_.unit);
        }
        close(source, flow.map, flow.distortion, record);
    }

    /// The page, the record and the terminal.
    void close(const Surface& source, const Eigen::VectorXcd& map, const Distortion& measured, Record& record) const {
        record.flow->fits = coefficient_fits(record.flow->error);
        record.map = map_record(measured);
        write_page(common_, source.mesh, {{"flow", positions_of(map), measured.face_abs_mu}}, {}, record, source_);
        finish(record, common_, "flow", {output_.path(), onto_.places_file(), common_.json, common_.report});
    }

    std::string source_;
    FlowOptions options_;
    OutputOptions output_;
    MuOption coefficient_;
    AlongTarget along_;
    CurveOption curves_;
    BoundaryOptions boundary_;
    OntoTarget onto_;
    HomotopyOptions homotopy_;
    StartMapOption start_map_;
    MetricOption metric_;
    MeshInputOptions mesh_options_;
    MeshInput input_;
};

}  // namespace

std::unique_ptr<Command> make_flow(CLI::App& parent) {
    return std::make_unique<Flow>(parent);
}

}  // namespace beltrami::cli
