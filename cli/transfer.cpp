#include <fmt/format.h>

#include <beltrami/base/counted.h>
#include <beltrami/base/error.h>
#include <beltrami/io/atomic_file.h>
#include <beltrami/io/write_mesh.h>
#include <beltrami/locate/point_at.h>
#include <beltrami/registration/nearest_places.h>
#include <beltrami/registration/overlay.h>
#include <beltrami/registration/transfer.h>
#include <beltrami/registration/transferred_polyline.h>
#include <beltrami/uniformize/sphere_map.h>

#include "command.h"
#include "mesh_input.h"
#include "output.h"
#include "place_file.h"

namespace beltrami::cli {

namespace {

constexpr int kMostColumns = 1000;

class Transfer final : public Command {
  public:
    explicit Transfer(CLI::App& parent) {
        CLI::App* app = parent.add_subcommand(
            "transfer", "what belongs to a surface onto another one, along a registration of both");
        app->add_option("SOURCE", source_, "the mesh that was carried")->required();
        app->add_option("TARGET", target_, "the mesh onto which it was carried")->required();
        app->add_option("--places", places_, "the places that `register SOURCE TARGET --places` wrote")
            ->required()
            ->type_name("FILE");
        app->add_option("-o,--output", output_, "what is transferred: a text file, or a mesh")
            ->required()
            ->type_name("OUT");
        CLI::Option_group* what = app->add_option_group("what", "one of these");
        what->add_option("--values", values_, "numbers of every vertex, a line each")->type_name("FILE");
        what->add_option("--face-values", face_values_,
                         "numbers of every face, a line each; the other's faces get their means")
            ->type_name("FILE");
        what->add_flag("--texture", texture_, "the texture coordinates; OUT is the other mesh with them");
        what->add_flag(
            "--overlay", overlay_,
            "the faces of both meshes laid over each other; OUT is the other surface, divided into triangles "
            "that lie in one face of both (in PLY source_face, target_face), with exact texture coordinates");
        what->add_option("--points", points_,
                         "points: `face b0 b1 b2` or `x y z`, of which the nearest point of the surface is taken; OUT "
                         "has `x y z` a line")
            ->type_name("FILE");
        what->add_option(
                "--polyline", polyline_,
                "likewise the points of a polyline in their order, the first again at the end of a closed one; "
                "geodesics join them, and OUT has a line for every point at which the image bends")
            ->type_name("FILE");
        what->add_option("--mesh", mesh_,
                         "a mesh that lies on the surface; OUT is the same mesh with its vertices on the other one")
            ->type_name("FILE");
        what->require_option(1);
        app->add_flag("--back", back_, "from TARGET to SOURCE");
        app->add_option("--target-outer", target_outer_,
                        "of surfaces with a boundary: the loop of TARGET that `register` was told")
            ->check(CLI::NonNegativeNumber)
            ->capture_default_str()
            ->type_name("h");
        app->add_flag("--as-places", as_places_,
                      "with --points and --polyline write `face b0 b1 b2` of the other surface");
        app->add_flag("--quiet", quiet_, "print nothing but errors");
        app->footer(kExitCodes);
    }

    int run() override {
        if (as_places_ && points_.empty() && polyline_.empty())
            throw Error(Cause::bad_option, "--as-places belongs to --points and --polyline",
                        "leave it out, or give one of these");
        if (texture_ || overlay_ || !mesh_.empty()) require_mesh_format(output_);
        check_files({{"SOURCE", source_},
                     {"TARGET", target_},
                     {"--places", places_},
                     {"--values", values_},
                     {"--face-values", face_values_},
                     {"--points", points_},
                     {"--polyline", polyline_},
                     {"--mesh", mesh_}},
                    {{"-o", output_}});
        const MeshInput source = load(source_), target = load(target_);
        const SurfaceCorrespondence forward = correspondence(source.mesh, target.mesh);
        const Direction way{forward, back_, source.unit, target.unit};
        if (!values_.empty())
            write_rows(way.vertex_values(read(values_, way.from().vertex_count(), "vertices")));
        else if (!face_values_.empty())
            write_rows(way.face_values(read(face_values_, way.from().face_count(), "faces")));
        else if (texture_)
            write_texture(way, back_ ? source : target);
        else if (overlay_)
            write_overlay(way, back_ ? source : target);
        else if (!points_.empty())
            write_places_of(way, way(read_places_of(way, points_)));
        else if (!polyline_.empty())
            write_places_of(way, way.polyline(read_places_of(way, polyline_)));
        else
            write_carried_mesh(way);
        if (!quiet_) {
            if (farthest_ > 0) fmt::print("the farthest point is {:.3g} away from the surface\n", farthest_);
            fmt::print("wrote {}\n", output_);
            for (const Warning& warning : record_.warnings) complain("warning: " + warning.sentence);
        }
        return 0;
    }

  private:
    /// The correspondence or its inverse.
    struct Direction {
        const SurfaceCorrespondence& forward;
        bool back;
        double source_unit, target_unit;

        const Mesh& from() const { return back ? forward.target() : forward.source(); }
        const Mesh& to() const { return back ? forward.source() : forward.target(); }
        double from_unit() const { return back ? target_unit : source_unit; }
        double to_unit() const { return back ? source_unit : target_unit; }
        std::vector<MeshPoint> operator()(std::span<const MeshPoint> places) const {
            return back ? forward.back(places) : forward.forward(places);
        }
        Positions vertex_values(const Positions& values) const {
            return transferred_vertex_values(forward, values, transfer());
        }
        Positions face_values(const Positions& values) const {
            return transferred_face_values(forward, values, transfer());
        }
        std::vector<MeshPoint> polyline(std::span<const MeshPoint> places) const {
            return transferred_polyline(forward, places, transfer()).places;
        }
        TransferWay transfer() const { return back ? TransferWay::to_source : TransferWay::to_target; }
    };

    MeshInput load(const std::string& path) {
        MeshInput input = MeshInputOptions().load(path, record_.warnings);
        cut_folded_quads(input, record_.warnings);
        return input;
    }

    SurfaceCorrespondence correspondence(const Mesh& source, const Mesh& target) const {
        const std::vector<MeshPoint> places = read_places(places_, target, source.vertex_count());
        const Surface onto(target);
        if (onto.topology.boundary_loops.empty()) return {source, target, sphere_map(onto).positions, places};
        return {Surface(source), onto, circle_domain_chart(onto, target_outer_), places};
    }

    Positions read(const std::string& path, int count, const char* of) const {
        const std::vector<NumberRow> rows = read_number_rows(path, 1, kMostColumns, "the numbers of one");
        if (static_cast<int>(rows.size()) != count)
            throw Error(Cause::unreadable,
                        fmt::format("{} has {} for {} {}", path, counted(rows.size(), "row", "rows"), count, of),
                        "give a row for each");
        Positions values(count, static_cast<Eigen::Index>(rows.empty() ? 0 : rows[0].numbers.size()));
        for (int i = 0; i < count; ++i) {
            if (static_cast<Eigen::Index>(rows[i].numbers.size()) != values.cols())
                fail_at_row(path, rows[i], "the row has another length than the first");
            values.row(i) = Eigen::Map<const Eigen::RowVectorXd>(rows[i].numbers.data(), values.cols());
        }
        return values;
    }

    void write_rows(const Positions& values) const {
        std::string text;
        for (Eigen::Index i = 0; i < values.rows(); ++i) {
            for (Eigen::Index j = 0; j < values.cols(); ++j)
                text += fmt::format("{}{}", j > 0 ? " " : "", values(i, j));
            text += "\n";
        }
        write_atomically(output_, text);
    }

    void write_texture(const Direction& way, const MeshInput& to) const {
        Mesh whole = to.mesh;
        whole.positions *= to.unit;
        whole.texture.reset();
        write_mesh(output_, {whole, {}, {}, {}, to.attributes, transferred_texture(way.forward, way.transfer())});
    }

    void write_overlay(const Direction& way, const MeshInput& to) const {
        OverlayMesh both = overlay_mesh(way.forward, way.transfer());
        both.mesh.positions *= to.unit;
        const auto column = [](const char* name, const std::vector<int>& faces) {
            return Column{name, Eigen::Map<const Eigen::VectorXi>(faces.data(), static_cast<Eigen::Index>(faces.size()))
                                    .cast<double>()};
        };
        std::optional<TextureCoordinates> texture = std::move(both.mesh.texture);
        both.mesh.texture.reset();
        write_mesh(output_, {both.mesh,
                             {},
                             {column("source_face", both.source_faces), column("target_face", both.target_faces)},
                             {},
                             {},
                             std::move(texture)});
    }

    std::vector<MeshPoint> read_places_of(const Direction& way, const std::string& path) {
        const std::vector<NumberRow> rows = read_number_rows(path, 3, 5, "a point x y z, or face and weights");
        std::vector<MeshPoint> places;
        places.reserve(rows.size());
        for (const NumberRow& row : rows)
            places.push_back(row.numbers.size() == 3
                                 ? nearest(way, Eigen::Map<const Eigen::RowVector3d>(row.numbers.data()))[0]
                                 : place_of_row(path, row, way.from()));
        return places;
    }

    void write_places_of(const Direction& way, std::span<const MeshPoint> places) const {
        std::string text;
        for (const MeshPoint& place : places) {
            if (as_places_) {
                text += line_of_place(way.to(), place);
                continue;
            }
            const Eigen::Vector3d point = point_on(way, place);
            text += fmt::format("{} {} {}\n", point.x(), point.y(), point.z());
        }
        write_atomically(output_, text);
    }

    void write_carried_mesh(const Direction& way) {
        MeshInput input = MeshInputOptions().load_polygons(mesh_, record_.warnings);
        Mesh& mesh = input.mesh;
        Positions points(mesh.vertex_count(), 3);
        for (int v = 0; v < mesh.vertex_count(); ++v) points.row(v) = input.unit * mesh.point(v);
        const std::vector<MeshPoint> places = way(nearest(way, points));
        for (int v = 0; v < mesh.vertex_count(); ++v) points.row(v) = point_on(way, places[v]);
        mesh.positions = points;
        write_mesh(output_, {mesh, {}, {}, {}, input.attributes, {}});
    }

    std::vector<MeshPoint> nearest(const Direction& way, const Positions& points) {
        std::vector<MeshPoint> places;
        for (const NearestPlace& found : nearest_places(way.from(), points / way.from_unit())) {
            places.push_back(found.place);
            farthest_ = std::max(farthest_, way.from_unit() * found.distance);
        }
        return places;
    }

    static Eigen::Vector3d point_on(const Direction& way, const MeshPoint& place) {
        return way.to_unit() * point_at(way.to(), place);
    }

    std::string source_, target_, places_, output_, values_, face_values_, points_, polyline_, mesh_;
    int target_outer_ = 0;
    bool texture_ = false, overlay_ = false, back_ = false, as_places_ = false, quiet_ = false;
    double farthest_ = 0;
};

}  // namespace

std::unique_ptr<Command> make_transfer(CLI::App& parent) {
    return std::make_unique<Transfer>(parent);
}

}  // namespace beltrami::cli
