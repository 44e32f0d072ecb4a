#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <beltrami/base/counted.h>
#include <beltrami/base/error.h>
#include <beltrami/forms/flat_torus.h>
#include <beltrami/io/number_lists.h>
#include <beltrami/io/write_mesh.h>
#include <beltrami/remeshing/carried_data.h>
#include <beltrami/remeshing/feature_curves.h>
#include <beltrami/remeshing/remesh.h>
#include <beltrami/space/corner_elements.h>
#include <beltrami/space/polygon_surface.h>
#include <beltrami/space/uniform_map.h>

#include "command.h"
#include "mesh_input.h"
#include "output.h"
#include "page.h"
#include "place_file.h"
#include "reference_option.h"
#include "space_input.h"

namespace beltrami::cli {

namespace {

constexpr double kDegree = std::numbers::pi / 180;

class Remesh final : public Command {
  public:
    explicit Remesh(CLI::App& parent) {
        CLI::App* app = parent.add_subcommand(
            "remesh", "better shapes of a mesh's faces: its vertices move along it, its connectivity stays");
        app->add_option("MESH", source_, "OBJ, PLY, OFF or STL; of any topology, faces of any number of corners")
            ->required();
        app->add_option("-o,--output", output_,
                        "the mesh with its vertices moved; its texture and the values of its vertices are carried "
                        "along, in PLY with per face mu_re, mu_im, abs_mu, K against the reference")
            ->required()
            ->type_name("OUT");
        reference_.add_to(*app);
        app->add_option("--p", wanted_.power, "2: good faces on average; 8: the worst ones")
            ->check(CLI::Range(2.0, 64.0))
            ->capture_default_str();
        app->add_option("--max-distance", wanted_.max_distance,
                        "how far the result may be from the mesh, as part of the diagonal of the box around it (kept "
                        "up to a factor of 1.4)")
            ->check(CLI::PositiveNumber)
            ->type_name("T")
            ->capture_default_str();
        app->add_option("--even-size", wanted_.even_size, "weight of keeping the areas of the faces; 1 is a lot")
            ->check(CLI::NonNegativeNumber)
            ->type_name("W")
            ->capture_default_str();
        app->add_option("--sizing", sizing_,
                        "lines `vertex factor`: by how much edges there ought to be longer than they are (vertices "
                        "that are not named: 1); with --even-size 1")
            ->type_name("FILE");
        app->add_option("--border", border_, "whether vertices of the border slide along it, corners staying")
            ->check(CLI::IsMember({"slide", "fixed"}))
            ->capture_default_str();
        app->add_option("--features", features_,
                        "edges at which the mesh turns by more stay where they are, their vertices slide along them")
            ->check(CLI::Range(1.0, 179.0))
            ->type_name("DEGREES");
        app->add_option(
               "--seams", seams_,
               "of MESH's vt: keep, vertices slide along them and the texture is carried along; drop, vertices "
               "move freely and OUT has no vt")
            ->check(CLI::IsMember({"keep", "drop"}))
            ->capture_default_str();
        app->add_flag("--open-angles", wanted_.open_angles,
                      "then open the smallest angles further, at the cost of the mean over all faces");
        app->add_flag("--fast", wanted_.fast, "one linear solve and the nearest points: a preview");
        app->add_option("--preserve", preserve_,
                        "the least-squares map of Gruber and Aulisa instead, which leaves the surface: with its "
                        "normals, or its area, preserved")
            ->check(CLI::IsMember({"normals", "area"}));
        app->add_flag("--uniform", uniform_, "with --preserve: go on to equal |mu| by their QC iteration");
        app->add_option("--places", places_,
                        "write where every vertex is now on MESH: lines `face b0 b1 b2`, of quads four weights")
            ->type_name("FILE");
        options_.add_to(*app);
        common_.add_to(*app);
        app->footer(kExitCodes);
    }

    int run() override {
        check();
        record_.command = "remesh";
        const Surface surface = surface_in_space(options_, source_, input_, record_);
        const Positions shapes = reference_.shapes(input_);
        const double start = seconds();
        const RemeshedSurface result =
            preserve_.empty() ? along_surface(surface, shapes) : least_squares(surface, shapes);
        conclude(surface, shapes, result, seconds() - start);
        return 0;
    }

    std::string hint(const Error& error) const override {
        if (error.cause() == Cause::not_solved && wanted_.fast) return "leave out --fast";
        return options_.hint(error, source_);
    }

  private:
    void check() {
        require_mesh_format(output_);
        std::vector<NamedFile> inputs = reference_.inputs();
        inputs.insert(inputs.end(), {{"MESH", source_}, {"--sizing", sizing_}});
        common_.check_files(inputs, {{"-o", output_}, {"--places", places_}});
        if (uniform_ && preserve_.empty())
            throw Error(Cause::bad_option, "--uniform belongs to --preserve", "give that, or leave it out");
        if (!preserve_.empty() && (wanted_.fast || wanted_.open_angles || !places_.empty() || !sizing_.empty()))
            throw Error(Cause::bad_option,
                        "--fast, --open-angles, --places and --sizing are about vertices that stay on the surface, "
                        "which --preserve does not promise",
                        "leave one of them out");
        if (wanted_.fast && wanted_.open_angles)
            throw Error(Cause::bad_option, "--fast takes one linear solve, and --open-angles further steps",
                        "leave one of them out");
        wanted_.slide_border = border_ == "slide";
        wanted_.keep_seams = seams_ == "keep";
        if (features_) wanted_.feature_angle = *features_ * kDegree;
    }

    RemeshedSurface along_surface(const Surface& surface, const Positions& shapes) {
        RemeshOptions options = wanted_;
        if (!sizing_.empty()) options.sizing = sizes();
        Progress progress(!common_.quiet);
        options.progress = [&](int step, double value) {
            progress.show(step, value, "F");
            return true;
        };
        return remesh(surface, shapes, options);
    }

    Eigen::VectorXd sizes() const {
        Eigen::VectorXd sizes = Eigen::VectorXd::Ones(input_.mesh.vertex_count());
        const IndexedRows rows =
            read_indexed_rows(sizing_, 1, static_cast<int>(input_.numbers.size()), 1, "a vertex and its factor");
        for (Eigen::Index i = 0; i < rows.indices.rows(); ++i) {
            if (!(rows.values(i, 0) > 0))
                throw Error(Cause::bad_option,
                            fmt::format("--sizing {}: the factor of vertex {} is {}, which is not positive", sizing_,
                                        rows.indices(i, 0), rows.values(i, 0)),
                            "1 leaves edges as long as they are, 2 makes them twice as long");
            sizes[input_.number_of(rows.indices(i, 0), "a vertex with a size")] = rows.values(i, 0);
        }
        return sizes;
    }

    /// Gruber and Aulisa's: borders and features stay.
    RemeshedSurface least_squares(const Surface& surface, const Positions& shapes) const {
        const Mesh& mesh = surface.mesh;
        std::vector<char> held(static_cast<std::size_t>(mesh.vertex_count()), 0);
        const FeatureCurves features = feature_curves(mesh, surface.topology, wanted_.feature_angle);
        for (const FeatureCurves::Curve& curve : features.curves)
            for (const int v : curve.vertices) held[v] = 1;
        for (const int v : features.corners) held[v] = 1;
        const CornerElements elements = corner_elements(mesh, shapes);
        LeastSquaresMap problem(mesh, elements, in_space(mesh), std::move(held),
                                preserve_ == "area" ? Preserve::area : Preserve::normals);
        UniformOptions options;
        if (!uniform_) options.max_iterations = 0;
        const UniformMap map = uniform_map(problem, mesh, options);
        RemeshedSurface result;
        result.positions = map.map;
        result.steps = map.solves;
        result.factorizations = problem.factorization_count();
        result.settled = !uniform_ || map.converged;
        const MeshTarget target(mesh);
        Mesh image = mesh;
        image.positions = map.map;
        result.unresolved = opposed_faces(image, target);
        result.opposed_before = opposed_faces(mesh, target);
        return result;
    }

    static Positions in_space(const Mesh& mesh) {
        Positions positions(mesh.vertex_count(), 3);
        for (int v = 0; v < mesh.vertex_count(); ++v) positions.row(v) = mesh.point(v);
        return positions;
    }

    /// k of the extremal map between the shapes of the reference and the surface, where theory gives it: tori.
    static std::optional<double> least_of_tori(const Surface& surface, const Positions& shapes) {
        if (surface.topology.genus != 1 || !surface.topology.boundary_loops.empty() ||
            surface.topology.components != 1 || has_polygons(surface.mesh))
            return {};
        try {
            const FlatTorus own = flat_torus(surface);
            const Surface wanted(surface.mesh, shapes);
            const FlatTorus flat = flat_torus(wanted);
            const std::array<std::vector<int>, 2> paths{own.homology.loops[0], own.homology.loops[1]};
            const TorusMarking marking = marking_of_paths(wanted, flat, paths, surface, own, paths);
            return std::tanh(hyperbolic_distance(flat.tau, tau_in_basis(own.tau, marking)) / 2);
        } catch (const Error&) {  // only a remark
            return {};
        }
    }

    RemeshRecord record_of(const Surface& surface, const Positions& shapes, const Mesh& image,
                           const RemeshedSurface& result) const {
        RemeshRecord record = remesh_record(surface.mesh, image, result);
        record.reference = reference_.name();
        record.method = !preserve_.empty() ? preserve_ : wanted_.fast ? "linear" : "barrier";
        if (record.method == "barrier") record.power = wanted_.power;
        record.valence_floor = mean_valence_floor(surface);
        record.teichmueller = least_of_tori(surface, shapes);
        return record;
    }

    /// Over the vertices inside that triangles alone surround.
    static double mean_valence_floor(const Surface& surface) {
        const Mesh& mesh = surface.mesh;
        std::vector<int> valence(static_cast<std::size_t>(mesh.vertex_count()), 0);
        for (int f = 0; f < mesh.face_count(); ++f)
            for (const int v : mesh.faces[f]) {
                if (mesh.faces.degree(f) != 3 || surface.topology.on_boundary[v]) valence[v] = -mesh.face_count();
                ++valence[v];
            }
        double sum = 0;
        int count = 0;
        for (const int m : valence) {
            if (m < 3) continue;
            sum += valence_floor(m);
            ++count;
        }
        return count > 0 ? sum / count : 0;
    }

    FileAttributes carried_attributes(const RemeshedSurface& result) const {
        FileAttributes attributes = input_.attributes;
        if (result.places.empty()) return attributes;
        for (FileColumn& column : attributes.vertex_columns) {
            if (column.length_type) continue;
            const Positions values =
                carried_values(Eigen::Map<const Eigen::VectorXd>(column.values.data(),
                                                                 static_cast<Eigen::Index>(column.values.size())),
                               result.places);
            const bool whole = column.type != NumberType::float32 && column.type != NumberType::float64;
            for (std::size_t v = 0; v < column.values.size(); ++v) {
                const double value = values(static_cast<Eigen::Index>(v), 0);
                column.values[v] = whole ? std::round(value) : value;
            }
        }
        return attributes;
    }

    void conclude(const Surface& surface, const Positions& shapes, const RemeshedSurface& result, double passed) {
        const Mesh& mesh = surface.mesh;
        Mesh image = mesh;
        image.positions = result.positions;
        const CornerElements elements = corner_elements(mesh, shapes);
        const Distortion before = distortion(elements.operators, in_space(mesh), vertex_normals(mesh)),
                         after = distortion(elements.operators, image.positions, vertex_normals(image));
        append(record_.warnings, result.warnings);
        record_.remesh = record_of(surface, shapes, image, result);
        record_.map = map_record(after);
        SolveRecord solve;
        solve.iterations = result.steps;
        solve.factorizations = result.factorizations;
        solve.termination = to_string(result.settled ? Termination::converged : Termination::iteration_limit);
        solve.seconds_total = passed;
        record_.solve = solve;
        record_.comparison.push_back({"before", map_record(before), {}});
        record_.comparison.back().solve.termination = to_string(Termination::converged);

        image.texture.reset();
        if (mesh.texture && wanted_.keep_seams)
            image.texture = result.places.empty() ? mesh.texture : carried_texture(mesh, result.places);
        write_with_texture(output_, image, input_.unit, after, carried_attributes(result));
        if (!places_.empty()) write_places(places_, mesh, result.places);
        write_page(common_, mesh,
                   {{"after", image.positions, after.face_abs_mu}, {"before", in_space(mesh), before.face_abs_mu}}, {},
                   record_, source_);
        finish(record_, common_, "after", {output_, places_, common_.json, common_.report});
    }

    std::string source_, output_, sizing_, preserve_, places_, border_ = "slide", seams_ = "keep";
    std::optional<double> features_;
    bool uniform_ = false;
    RemeshOptions wanted_;
    ReferenceOption reference_;
    MeshInputOptions options_;
    MeshInput input_;
};

}  // namespace

std::unique_ptr<Command> make_remesh(CLI::App& parent) {
    return std::make_unique<Remesh>(parent);
}

}  // namespace beltrami::cli
