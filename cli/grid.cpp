#include <map>

#include <beltrami/applications/conformal_carrier.h>
#include <beltrami/applications/fitting_grid.h>
#include <beltrami/applications/grid_on_surface.h>
#include <beltrami/applications/image_domain.h>
#include <beltrami/applications/reached_corners.h>
#include <beltrami/base/counted.h>
#include <beltrami/base/error.h>
#include <beltrami/io/write_mesh.h>
#include <beltrami/mesh/planar.h>
#include <beltrami/mesh/texture_map.h>

#include "command.h"
#include "map_methods.h"
#include "mesh_input.h"
#include "onto_options.h"
#include "output.h"
#include "page.h"
#include "start_map_option.h"

namespace beltrami::cli {

namespace {

const std::map<std::string, GridLines> kLines{{"auto", GridLines::automatic},
                                              {"rectangular", GridLines::rectangular},
                                              {"polar", GridLines::polar},
                                              {"log-polar", GridLines::log_polar}};

class Grid final : public Command {
  public:
    explicit Grid(CLI::App& parent) {
        CLI::App* app = parent.add_subcommand(
            "grid", "a structured grid of quads on a surface, carried there from a simple domain of the plane");
        app->add_option("SURFACE", source_,
                        "OBJ, PLY, OFF or STL; one component of genus 0 with a boundary: a disk, with holes or without")
            ->required();
        app->add_option("-o,--output", output_,
                        "the grid as OBJ, PLY (with the column and row of every face's cell) or OFF; its places in the "
                        "domain are vt or u, v")
            ->required()
            ->type_name("OUT");
        app->add_option("--map", map_,
                        "extremal: the map of least dilatation between SURFACE and TARGET; conformal: that to a disk "
                        "with round holes of SURFACE's own, without a TARGET")
            ->check(CLI::IsMember({"extremal", "conformal"}))
            ->capture_default_str();
        app->add_option("--from-map", from_map_,
                        "instead of --map: the map that this file has of SURFACE, as vt or as positions in the plane, "
                        "which may have any boundary and holes: the OUT of `map`")
            ->type_name("OUT");
        target_.add_to(*app, OntoTarget::Kinds::domains);
        app->add_option("--outer", outer_, "the boundary loop that goes to the outer curve")
            ->check(CLI::NonNegativeNumber)
            ->capture_default_str();
        app->add_option("--cells", cells_,
                        "rectangular: cells along the longer side of the domain; polar, log-polar: around")
            ->check(CLI::Range(1, 1000000))
            ->capture_default_str();
        std::vector<std::string> lines;
        lines.reserve(kLines.size());
        for (const auto& [name, kind] : kLines) lines.push_back(name);
        app->add_option("--lines", lines_,
                        "auto: log-polar on a ring between two circles of one centre, else rectangular, along the "
                        "sides of an outer rectangle")
            ->check(CLI::IsMember(lines))
            ->capture_default_str();
        app->add_option("--pattern", pattern_, "checker: cells are coloured like a checkerboard's")
            ->check(CLI::IsMember({"grid", "checker"}))
            ->capture_default_str();
        app->add_option("--border", border_,
                        "stepped: cells that the boundary cuts are left out, so that all faces are quads (but those "
                        "at the centre of polar lines); trimmed: their part inside becomes triangles and quads")
            ->check(CLI::IsMember({"stepped", "trimmed"}))
            ->capture_default_str();
        app->add_option("--places", places_,
                        "where on SURFACE every vertex of the grid lies: a line `vertex face a b c wa wb wc` each, "
                        "the face's vertices a b c with their barycentric weights")
            ->type_name("FILE");
        fit_.add_to(*app);
        options_.add_to(*app);
        common_.add_to(*app);
        app->footer(kExitCodes);
    }

    int run() override {
        check();
        Record& record = record_;
        record.command = "grid";
        MeshInput input = options_.load(source_, record.warnings);
        const double start = seconds();
        const Surface source(std::move(input.mesh));
        add_findings(source.findings, record.warnings);
        record.source = source_record(source, input.unit);
        TargetDomain domain = TargetDomain{TargetCurve::circle(0, 1), {}};
        MethodResult result = !from_map_.empty()   ? sampled(source, domain, record)
                              : map_ == "extremal" ? run_extremal_onto(source, input, start, domain, record)
                                                   : run_conformal(source, start, domain, record);
        const Surface& mapped = result.split ? *result.split : source;

        const PlaneGrid lines = fitting_grid(domain, cells_, kLines.at(lines_));
        GridOptions how;
        how.border = border_ == "trimmed" ? GridOptions::Border::trimmed : GridOptions::Border::stepped;
        SurfaceGrid grid = grid_on_surface(mapped, result.map, lines, how);
        record.grid = grid_record(grid, source.mesh);
        record.grid->carried_by = carrier();
        record.grid->lines = lines_of(lines);
        record.grid->cells = cells_;
        record.grid->trimmed = border_ == "trimmed";
        record.grid->checker = pattern_ == "checker";
        add_warnings(grid, record);

        grid.mesh.positions *= input.unit;
        write_grid(grid);
        if (!places_.empty()) write_places(places_, grid.parents);
        if (!common_.report.empty()) show_differential(mapped, result);
        write_page(common_, mapped.mesh, std::move(result.pages), result.history, record, source_);
        finish(record, common_, carrier(), {output_, places_, common_.json, common_.report});
        return 0;
    }

    std::string hint(const Error& error) const override { return options_.hint(error, source_); }

  private:
    std::string carrier() const { return from_map_.empty() ? map_ : "file"; }

    /// The map of a file, whose boundary is that of the domain.
    MethodResult sampled(const Surface& source, TargetDomain& domain, Record& record) const {
        const Mesh image = load_of_same_faces("--from-map", from_map_, source.mesh, record.warnings);
        MethodResult done;
        if (image.texture) {
            done.map = texture_map(image);
        } else if (is_planar(image)) {
            done.map.resize(image.vertex_count());
            for (int v = 0; v < image.vertex_count(); ++v) done.map[v] = {image.positions(v, 0), image.positions(v, 1)};
        } else {
            throw Error(Cause::bad_mesh, "--from-map " + from_map_ + " has no vt, and does not lie in the plane",
                        "give what `map` has written");
        }
        done.distortion = distortion(source.operators, done.map);
        if (2 * done.distortion.flipped.size() > static_cast<std::size_t>(source.mesh.face_count())) {
            done.map = done.map.conjugate().eval();  // a map seen from below
            done.distortion = distortion(source.operators, done.map);
        }
        record.map = map_record(done.distortion);
        domain = image_domain(source, done.map);
        done.pages.push_back({"file", positions_of(done.map), done.distortion.face_abs_mu});
        return done;
    }

    void check() const {
        require_mesh_format(output_);
        std::vector<NamedFile> inputs = target_.inputs();
        inputs.push_back({"SURFACE", source_});
        inputs.push_back({"--from-map", from_map_});
        common_.check_files(inputs, {{"-o", output_}, {"--places", places_}});
        if (!from_map_.empty()) {
            if (target_.given() || map_ != "extremal")
                throw Error(Cause::bad_option, "--from-map gives the map, which --onto and --map conformal would make",
                            "leave out one or the other");
            return;
        }
        if (map_ == "extremal" && !target_.given())
            throw Error(Cause::bad_option, "the extremal map needs a parameter domain",
                        "give one with --onto, or --map conformal, or a map with --from-map");
        if (map_ == "extremal") return;
        if (target_.given())
            throw Error(Cause::bad_option,
                        "the conformal map goes to a domain that SURFACE alone determines, not to that of --onto",
                        "leave out --onto or --map conformal");
        if (const std::string stray = target_.stray(); !stray.empty())
            throw Error(Cause::bad_option, stray + " belongs to --onto");
    }

    MethodResult run_extremal_onto(const Surface& source, const MeshInput& input, double start, TargetDomain& domain,
                                   Record& record) {
        target_.load(input, record.warnings);
        domain = *target_.domain();
        Constraints constraints;
        constraints.correspondence.outer_loop = outer_;
        target_.apply(constraints);
        MethodResult done = run_onto(source, target_, constraints, {}, start, !common_.quiet, record);
        reach_corners(done.split ? *done.split : source, domain, record.onto->loops, constraints.correspondence.marks,
                      done.map);
        return done;
    }

    MethodResult run_conformal(const Surface& source, double start, TargetDomain& domain, Record& record) const {
        ConformalCarrier carrier = conformal_carrier(source, outer_);
        domain = std::move(carrier.domain);
        MethodResult done;
        if (carrier.split) {
            record.split = split_record(*carrier.split, source.mesh.vertex_count());
            done.split = surface_of(std::move(carrier.split->mesh), std::move(carrier.split->metric));
        }
        record.map = map_record(carrier.distortion);
        record.solve.emplace();
        record.solve->iterations = carrier.iterations;
        record.solve->termination = to_string(carrier.termination);
        record.solve->factorizations = carrier.factorizations;
        record.solve->seconds_total = seconds() - start;
        append(record.warnings, carrier.warnings);
        done.map = std::move(carrier.map);
        done.distortion = std::move(carrier.distortion);
        done.pages.push_back({"conformal", positions_of(done.map), done.distortion.face_abs_mu});
        return done;
    }

    static void add_warnings(const SurfaceGrid& grid, Record& record) {
        if (const auto& folded = grid.quality.folded; !folded.empty())
            record.warnings.push_back({WarningKind::flipped_faces,
                                       counted(folded.size(), "face of the grid is", "faces of the grid are") +
                                           " flipped or not convex on the surface: at a corner of the domain that its "
                                           "boundary has not, or where it turns back; the first is face " +
                                           std::to_string(folded[0]),
                                       {Things::faces, folded}});
    }

    void write_grid(const SurfaceGrid& grid) const {
        const int faces = grid.mesh.face_count();
        std::vector<Column> columns{{"column", Eigen::VectorXd(faces)}, {"row", Eigen::VectorXd(faces)}};
        std::vector<Shade> shades;
        for (int f = 0; f < faces; ++f) {
            const auto [column, row] = grid.cells[f];
            columns[0].values[f] = column, columns[1].values[f] = row;
            if (pattern_ == "checker") shades.push_back((column + row) % 2 == 0 ? Shade::light : Shade::dark);
        }
        write_mesh(output_,
                   {grid.mesh, fit_.fitted(positions_of(grid.parameter)), std::move(columns), std::move(shades)});
    }

    std::string source_, output_, map_ = "extremal", lines_ = "auto", pattern_ = "grid", border_ = "stepped", places_,
                                  from_map_;
    int cells_ = 40, outer_ = 0;
    OntoTarget target_;
    MeshInputOptions options_;
    FitOption fit_;
};

}  // namespace

std::unique_ptr<Command> make_grid(CLI::App& parent) {
    return std::make_unique<Grid>(parent);
}

}  // namespace beltrami::cli
