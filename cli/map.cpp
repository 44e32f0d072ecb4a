#include <fmt/format.h>

#include <algorithm>

#include <beltrami/base/counted.h>
#include <beltrami/base/error.h>
#include <beltrami/base/memory.h>
#include <beltrami/report/timing.h>

#include "boundary_options.h"
#include "command.h"
#include "components.h"
#include "homotopy_options.h"
#include "iteration_options.h"
#include "map_methods.h"
#include "mesh_input.h"
#include "metric_option.h"
#include "onto_options.h"
#include "output.h"
#include "page.h"
#include "phi_option.h"
#include "slide_option.h"
#include "space_method.h"
#include "start_map_option.h"

namespace beltrami::cli {

namespace {

class Map final : public Command {
  public:
    explicit Map(CLI::App& parent) {
        CLI::App* app =
            parent.add_subcommand("map", "map a surface to the plane; by default the map of least dilatation");
        app->add_option("SOURCE", source_,
                        "OBJ, PLY, OFF or STL; one component of genus 0 with a boundary: a disk, with holes or without")
            ->required();
        output_.add_to(*app);
        std::vector<std::string> methods = baseline_names();
        methods.insert(methods.begin(), "extremal");
        methods.emplace_back(SpaceMethod::kName);
        app->add_option("--method", method_,
                        "lscm, arap and mips can leave the boundary free; lsqc goes into space, see --in-space; the "
                        "others need every "
                        "boundary vertex prescribed")
            ->check(CLI::IsMember(methods))
            ->capture_default_str();
        app->add_option("--minimize", minimize_,
                        "K: the dilatation, by the extremal map; max: the largest |mu| of a face of this mesh, without "
                        "folds, starting from the extremal map. Where parts of a boundary loop are free there is no "
                        "extremal map, and K is taken as max; whole loops may be free with max only")
            ->check(CLI::IsMember({"K", "max"}))
            ->capture_default_str();
        app->add_option("--certify", certify_,
                        "prove that the least dilatation lies between two numbers at most P percent apart, refining "
                        "the mesh for "
                        "that, and say why where that cannot be had; the map stays on SOURCE's mesh")
            ->check(CLI::PositiveNumber)
            ->type_name("P");
        app->add_option("--slack", slack_,
                        "boundary points may move by up to S edges along the target, by which K falls where the "
                        "outline of a scan is noisy; 0: not at all")
            ->check(CLI::NonNegativeNumber)
            ->type_name("S")
            ->capture_default_str();
        boundary_.add_to(*app);
        onto_.add_to(*app, OntoTarget::Kinds::prescribed_too);
        slide_.add_to(*app);
        homotopy_.add_to(*app);
        start_map_.add_to(*app);
        iteration_.add_to(*app);
        space_.add_to(*app);
        metric_.add_to(*app);
        phi_.add_to(*app);
        std::vector<std::string> others = baseline_names();
        others.insert(others.end(), sliding_baseline_names().begin(), sliding_baseline_names().end());
        app->add_option("--compare", compare_,
                        "further methods to set beside the map, on the same boundary values (lscm on its own free "
                        "boundary); with "
                        "--onto: t-map, the scheme of Ng, Gu and Lui for boundaries that slide")
            ->delimiter(',')
            ->check(CLI::IsMember(others))
            ->type_name("METHOD,...");
        app->add_flag("--each-component", each_component_,
                      "map the components one by one, each by itself with --boundary, and put the images in a row");
        options_.allow_each_component();
        options_.add_to(*app);
        common_.add_to(*app);
        app->footer(kExitCodes);
    }

    int run() override {
        check();
        Record& record = record_;
        record.command = "map";
        if (method_ == SpaceMethod::kName) {
            space_.run(options_, source_, output_.path(), common_, record);
            return 0;
        }
        input_ = options_.load(source_, record.warnings);
        boundary_.load(input_);
        homotopy_.load();
        metric_.load(input_);
        const double start = seconds();
        ready_memory_beside(method_ == "extremal" ? memory_of_map(input_.mesh.face_count()) : 0);
        const Surface source = metric_.surface_of(std::move(input_.mesh));
        std::vector<Finding> findings = source.findings;
        if (each_component_)  // several are what is asked for
            std::erase_if(findings,
                          [](const Finding& finding) { return finding.defect == Defect::several_components; });
        add_findings(findings, record.warnings);
        record.source = source_record(source, input_.unit);
        if (onto_.prescribes()) return run_onto_surface(source, start, record);
        if (onto_.given() || slide_.given()) return run_sliding(source, start, record);
        if (each_component_) return run_components(source, record);
        if (source.topology.genus > 0) require_genus_zero(source);
        const Shape shape(source);
        BoundaryCondition boundary = values(shape);
        const double unit = into_units(boundary);

        MethodResult result = solve(shape, boundary, start, record);
        const Surface& mapped = result.split ? *result.split : source;
        for (const std::string& other : compare_)
            if (other != method_) compare(mapped, boundary, other, result.pages, record);
        if (common_.wants_record() && unprescribed_boundary(boundary, source).empty() &&
            !source.topology.boundary_loops.empty())
            record.solve->seconds_harmonic = harmonic_seconds(source, boundary);

        output_.write(mapped.mesh, unit * result.map, result.distortion, attributes_of(result), input_.unit);
        phi_.write(mapped, result);
        const std::string name = result.pages[0].name;
        if (!common_.report.empty()) show_differential(mapped, result);
        write_page(common_, mapped.mesh, std::move(result.pages), result.history, record, source_);
        finish(record, common_, name, {output_.path(), phi_.path(), common_.json, common_.report});
        return 0;
    }

    std::string hint(const Error& error) const override {
        if (error.where() == Where{Things::vertices, free_})
            return "--boundary prescribes the outer loop, --hole a hole, --pin any vertex; --minimize max lets parts "
                   "be free";
        if (error.cause() == Cause::not_solved && error.where().of == Things::loops && minimize_ == "max")
            return "the extremal map, without --minimize max, keeps its turns";
        return options_.hint(error, source_);
    }

  private:
    /// Onto a mesh on whose boundary that of the source is prescribed.
    int run_onto_surface(const Surface& source, double start, Record& record) {
        onto_.load(input_, record.warnings);
        Correspondence wanted;
        wanted.outer_loop = boundary_.outer_loop();
        homotopy_.apply(source, wanted);
        ExtremalOptions options;
        iteration_.apply(options);
        options.start = start_map_.load(source.mesh, record.warnings);
        BoundaryCondition boundary;
        MethodResult result =
            run_between(source, onto_, wanted, std::move(options), start, !common_.quiet, record, boundary);
        for (const std::string& other : compare_)
            compare(result.split ? *result.split : source, boundary, other, result.pages, record);
        return write_onto(source, std::move(result), record);
    }

    int run_components(const Surface& source, Record& record) {
        std::vector<double> units;
        MethodResult result = map_components(
            source,
            [&](const Surface& component, Record& own) {
                const Shape shape(component);
                BoundaryCondition boundary = values(shape);
                units.push_back(into_units(boundary));
                return solve(shape, boundary, seconds(), own);
            },
            record);
        const Surface& mapped = result.split ? *result.split : source;
        output_.write(mapped.mesh, units[0] * result.map, result.distortion, attributes_of(result), input_.unit);
        write_page(common_, mapped.mesh, std::move(result.pages), {}, record, source_);
        if (common_.may_print())
            for (const ComponentRecord& part : record.components)
                fmt::print("{} from face {}: {}{}, {}\n", counted(part.faces, "face", "faces"), part.first_face,
                           part.map.K ? fmt::format("K {:.4f}, ", *part.map.K) : "",
                           counted(part.map.flipped, "flip", "flips"), part.solve.termination);
        finish(record, common_, "components", {output_.path(), common_.json, common_.report});
        return 0;
    }

    BoundaryCondition values(const Shape& shape) {
        BoundaryCondition boundary = boundary_.values(shape);
        free_ = unprescribed_boundary(boundary, shape.surface());
        return boundary;
    }

    void check_in_space() const {
        const auto refuse = [](bool given, const std::string& what) {
            if (given)
                throw Error(Cause::bad_option, what + " says nothing of --method lsqc, which goes into space",
                            "leave one of them out");
        };
        refuse(boundary_.given(), "--boundary, --hole or --pin");
        refuse(onto_.given() || slide_.given(), "--onto or --slide");
        refuse(homotopy_.given() || start_map_.given(), "--turns, --waypoints or --start-map");
        refuse(metric_.given(), "--metric");
        refuse(phi_.given(), "--phi");
        refuse(each_component_, "--each-component");
        refuse(certify_.has_value() || slack_ > 0 || minimize_ != "K", "--certify, --slack or --minimize");
        refuse(!compare_.empty(), "--compare");
    }

    void check_each_component() const {
        const auto refuse = [](bool given, const std::string& what) {
            if (given)
                throw Error(Cause::bad_option, what + " is about one component, --each-component about all",
                            "leave one of them out");
        };
        refuse(onto_.given() || slide_.given(), "--onto or --slide");
        refuse(homotopy_.given(), "--turns or --waypoints");
        refuse(metric_.given(), "--metric");
        refuse(phi_.given(), "--phi");
        refuse(boundary_.names_vertices(), "--corners, --first-vertex, --pin or --hole");
        refuse(!compare_.empty(), "--compare");
    }

    /// Goes over to the unit of the prescribed images, or, where nothing is prescribed, to that of the source; returns
    /// it.
    double into_units(BoundaryCondition& boundary) {
        double size = 0;
        for (const Complex image : boundary.images) size = std::max(size, std::abs(image - boundary.images[0]));
        const bool given = boundary.vertices.size() > 1 || !boundary.lines.empty();
        const double unit = given ? unit_of(size) : input_.unit;
        for (Complex& image : boundary.images) image /= unit;
        for (BoundaryCondition::Line& line : boundary.lines) line.point /= unit;
        unit_ = unit;
        return unit;
    }

    /// What the file of the source says of the mesh that was mapped.
    FileAttributes attributes_of(const MethodResult& result) const {
        if (!result.split) return input_.attributes;
        std::vector<std::vector<int>> vertices;
        for (std::size_t v = 0; v < input_.vertices.size(); ++v) vertices.push_back({static_cast<int>(v)});
        for (const std::vector<int>& added : record_.split->added)
            vertices.emplace_back(added.begin() + 1, added.end());
        return carried(input_.attributes, vertices, result.face_parents);
    }

    /// The boundary slides, or a part of it.
    int run_sliding(const Surface& source, double start, Record& record) {
        Constraints constraints;
        constraints.correspondence.outer_loop = boundary_.outer_loop();
        if (onto_.given()) {
            onto_.load(input_, record.warnings);
            onto_.apply(constraints);
        }
        homotopy_.refuse_turns();
        homotopy_.apply(source, constraints.correspondence);
        if (boundary_.given()) constraints.prescribed = boundary_.values(source);
        constraints.arcs = slide_.arcs(source, boundary_);
        if (!constraints.all_slides() && !compare_.empty())
            throw Error(Cause::bad_option, "--compare is for boundaries that slide everywhere, or nowhere",
                        "leave it out");
        ExtremalOptions options;
        iteration_.apply(options);
        options.start = start_map_.load(source.mesh, record.warnings);
        MethodResult result =
            run_onto(source, onto_, constraints, std::move(options), start, !common_.quiet, record, compare_);
        return write_onto(source, std::move(result), record);
    }

    int write_onto(const Surface& source, MethodResult result, const Record& record) const {
        const Surface& mapped = result.split ? *result.split : source;
        if (result.positions) {
            output_.write(mapped.mesh, *result.positions, result.map, result.distortion, attributes_of(result));
        } else {
            output_.write(mapped.mesh, result.map, result.distortion, attributes_of(result), input_.unit);
        }
        onto_.write_places(result.places);
        phi_.write(mapped, result);
        const std::string name = result.pages[0].name;
        if (!common_.report.empty()) show_differential(mapped, result);
        write_page(common_, mapped.mesh, std::move(result.pages), result.history, record, source_);
        finish(record, common_, name, {output_.path(), onto_.places_file(), phi_.path(), common_.json, common_.report});
        return 0;
    }

    void check_prescribed_onto() const {
        const auto refuse = [](bool given, const std::string& what) {
            if (given)
                throw Error(Cause::bad_option, what + " says nothing where --correspondence prescribes the boundary",
                            "leave one of them out");
        };
        refuse(boundary_.given(), "--boundary, --hole or --pin");
        refuse(onto_.pairs_loops(), "--loops or --match");
        refuse(onto_.has_marks(), "--marks or --mark-vertices");
        refuse(certify_.has_value(), "--certify");
        refuse(minimize_ != "K", "--minimize");
        refuse(method_ != "extremal", "--method " + method_);
        for (const std::string& other : compare_) refuse(slides(other), "--compare " + other);
        iteration_.require_no_power();
    }

    void check_onto() const {
        const auto refuse = [](bool given, const std::string& what) {
            if (given)
                throw Error(Cause::bad_option,
                            what + " is about prescribed boundary values, with --onto or --slide they slide",
                            "leave one of them out");
        };
        refuse(certify_.has_value(), "--certify");
        refuse(slack_ > 0, "--slack");
        refuse(minimize_ != "K", "--minimize");
        for (const std::string& other : compare_) refuse(!slides(other), "--compare " + other);
        refuse(method_ != "extremal", "--method " + method_);
    }

    static bool slides(const std::string& method) {
        const std::vector<std::string>& names = sliding_baseline_names();
        return std::find(names.begin(), names.end(), method) != names.end();
    }

    void check() const {
        output_.check();
        std::vector<NamedFile> inputs = boundary_.inputs();
        const auto add = [&](const std::vector<NamedFile>& more) {
            inputs.insert(inputs.end(), more.begin(), more.end());
        };
        add(homotopy_.inputs());
        add(onto_.inputs());
        add(slide_.inputs());
        add(start_map_.inputs());
        add(metric_.inputs());
        add(space_.inputs());
        inputs.push_back({"SOURCE", source_});
        std::vector<NamedFile> outputs = onto_.outputs();
        outputs.insert(outputs.begin(), {"-o", output_.path()});
        outputs.push_back(phi_.output());
        common_.check_files(inputs, std::move(outputs));
        if (method_ == SpaceMethod::kName) {
            check_in_space();
            return;
        }
        if (const std::string stray = space_.stray(); !stray.empty())
            throw Error(Cause::bad_option, stray + " belongs to --method lsqc", "leave it out");
        if (each_component_) check_each_component();
        iteration_.check({method_, (onto_.given() && !onto_.prescribes()) || slide_.given()});
        if (start_map_.given() && homotopy_.given())
            throw Error(Cause::bad_option,
                        "--start-map has a homotopy class of its own: --turns and --waypoints ask for one",
                        "leave one of them out");
        if (onto_.given() || slide_.given()) {
            onto_.prescribes() ? check_prescribed_onto() : check_onto();
            return;
        }
        if (const std::string stray = onto_.stray(); !stray.empty())
            throw Error(Cause::bad_option, stray + " belongs to --onto");
        for (const std::string& other : compare_)
            if (slides(other))
                throw Error(Cause::bad_option, "--compare " + other + " belongs to --onto: its boundary slides",
                            "leave it out, or give --onto TARGET");
        if (certify_ && minimize_ == "max")
            throw Error(Cause::bad_option, "--certify is about the extremal map, not about --minimize max",
                        "leave one of them out");
        if (slack_ > 0 && (certify_ || minimize_ == "max" || method_ != "extremal"))
            throw Error(Cause::bad_option,
                        "--slack belongs to the extremal map; with --certify, --minimize max and the other methods the "
                        "boundary values stay as they are",
                        "leave one of them out");
        if (phi_.given() && (minimize_ == "max" || method_ != "extremal"))
            throw Error(Cause::bad_option,
                        "--phi is about the extremal map: with --minimize max and the other methods there is no φ",
                        "leave one of them out");
        if (method_ == "extremal") return;
        if (certify_) throw Error(Cause::bad_option, "--certify belongs to --method extremal");
        if (start_map_.given())
            throw Error(Cause::bad_option, "--start-map belongs to --method extremal",
                        "the other methods have starts of their own");
        if (homotopy_.given())
            throw Error(Cause::bad_option, "--turns and --waypoints belong to --method extremal",
                        "the other methods take the homotopy class as it comes");
        if (minimize_ != "K")
            throw Error(Cause::bad_option, "--minimize " + minimize_ + " belongs to --method extremal");
    }

    MethodResult solve(const Shape& shape, const BoundaryCondition& boundary, double start, Record& record) const {
        const Surface& source = shape.surface();
        if (method_ == "extremal") {
            Constraints constraints(boundary);
            constraints.correspondence.outer_loop = boundary_.outer_loop();
            homotopy_.apply(source, constraints.correspondence);
            LeastDilatationOptions options;
            options.what = minimize_ == "max" ? Least::maximum : Least::dilatation;
            options.extremal.shapes = {&shape};
            options.extremal.slack = slack_;
            options.extremal.start = start_map_.load(source.mesh, record.warnings);
            if (options.extremal.start) *options.extremal.start /= unit_;
            options.maximum.extremal = options.extremal;
            iteration_.apply(options.extremal);
            iteration_.apply(options.maximum);
            if (certify_)
                return run_certified(source, constraints, std::move(options.extremal), *certify_ / 100, start,
                                     !common_.quiet, record);
            const bool least_maximum = takes_least_maximum(source, constraints, options.what);
            if (!least_maximum) iteration_.require_no_power();
            if (least_maximum && phi_.given())
                throw Error(Cause::bad_boundary, "parts of the boundary are free: there is no extremal map, and no φ",
                            "prescribe the whole boundary, or leave out --phi");
            return run_least_dilatation(source, constraints, std::move(options), start, !common_.quiet, record);
        }
        MethodRecord main;
        BaselineOptions options;
        iteration_.apply(options);
        MethodResult result = run_baseline(source, boundary, method_, options, start, main, record.warnings);
        record.map = std::move(main.map);
        record.solve = std::move(main.solve);
        return result;
    }

    /// A method that cannot do this is a warning, not an error of the command.
    static void compare(const Surface& mapped, const BoundaryCondition& boundary, const std::string& method,
                        std::vector<PageMap>& pages, Record& record) {
        MethodRecord line;
        MethodResult other;
        try {
            other = run_baseline(mapped, method == "lscm" ? BoundaryCondition() : boundary, method, {}, seconds(), line,
                                 record.warnings);
        } catch (const Error& error) {
            record.warnings.push_back({WarningKind::comparison, method + " is not in the comparison: " + error.what()});
            return;
        }
        record.comparison.push_back(std::move(line));
        // A page of that name without a record (the start of the extremal map) gives way.
        std::erase_if(pages, [&](const PageMap& page) { return page.name == method; });
        pages.push_back(std::move(other.pages[0]));
    }

    std::string source_, method_ = "extremal", minimize_ = "K";
    std::optional<double> certify_;
    double slack_ = 0;
    bool each_component_ = false;
    std::vector<std::string> compare_;
    SpaceMethod space_;
    MeshInputOptions options_;
    MeshInput input_;
    double unit_ = 1;        // of the images
    std::vector<int> free_;  // boundary vertices of the source
    OutputOptions output_;
    BoundaryOptions boundary_;
    OntoTarget onto_;
    SlideOption slide_;
    HomotopyOptions homotopy_;
    StartMapOption start_map_;
    IterationOptions iteration_;
    MetricOption metric_;
    PhiOption phi_;
};

}  // namespace

std::unique_ptr<Command> make_map(CLI::App& parent) {
    return std::make_unique<Map>(parent);
}

}  // namespace beltrami::cli
