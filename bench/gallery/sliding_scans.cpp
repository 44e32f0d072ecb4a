// Scans, if the folder BELTRAMI_MESHES has them: maps onto domains and surfaces, and grids.
#include <beltrami/io/read_mesh.h>
#include <beltrami/mesh/cut.h>
#include <beltrami/mesh/subdivide.h>
#include <beltrami/mesh/submesh.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "gallery/sliding.h"

namespace beltrami::gallery {

namespace {

/// From the front of the scanned face, whose up is y.
constexpr double kAzimuth = -90, kElevation = 84;

const std::vector<Hole> kRoundHoles{{0.1, 0.1, 0.15}, {-0.5, -0.5, 0.15}, {-0.55, 0.3, 0.15}};

std::string pairs(const Correspondence& wanted) {
    std::string text;
    for (const auto& [loop, curve] : wanted.loops)
        text += (text.empty() ? "" : ", ") + std::to_string(loop) + ":" + std::to_string(curve);
    return text;
}

/// The head and cells of tables about starts.
std::vector<std::string> start_head(const std::string& first) {
    std::vector<std::string> head = onto_head(first);
    head[2] = "flips of the harmonic start";
    head.push_back("gap of K");
    return head;
}

std::vector<std::string> start_row(const std::string& first, const Surface& source, const SolvedOnto& solved) {
    std::vector<std::string> row = onto_row(first, source, "", solved);
    if (!solved) return row;
    row[2] = std::to_string(solved.all->start_flips);
    row.push_back(number(100 * (solved.all->K_upper / solved.all->K_lower - 1), 2) + " %");
    return row;
}

/// A face whose features have moved: wider below, higher on one side, its relief deeper.
Mesh deformed(const Mesh& mesh) {
    Mesh result = mesh;
    const Eigen::RowVector3d low = mesh.positions.colwise().minCoeff(), high = mesh.positions.colwise().maxCoeff();
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        const Eigen::RowVector3d p = mesh.positions.row(v);
        const double x = (p[0] - low[0]) / (high[0] - low[0]) - 0.5, y = (p[1] - low[1]) / (high[1] - low[1]) - 0.5;
        result.positions.row(v) << p[0] + (high[0] - low[0]) * x * (0.25 - 0.35 * y),
            p[1] + (high[1] - low[1]) * 0.12 * std::sin(3 * x), 1.3 * p[2];
    }
    return result;
}

/// An ellipse of the plane z = 0, along the axes.
struct Ellipse {
    double x, y, a, b;
};

/// A scan that looks along z, cut open along ellipses: faces that cross one are split there, but for vertices that are
/// near it, which become vertices of the rim.
Mesh opened(Mesh mesh, const std::vector<Ellipse>& ellipses) {
    constexpr double near = 0.04;  // in half axes
    for (const Ellipse& e : ellipses) {
        // Where the ellipse is, the third coordinate is 0.
        Mesh lifted = mesh;
        for (int v = 0; v < mesh.vertex_count(); ++v) {
            const double level = std::hypot((mesh.positions(v, 0) - e.x) / e.a, (mesh.positions(v, 1) - e.y) / e.b) - 1;
            lifted.positions(v, 2) = std::abs(level) < near ? 0 : level;
        }
        CutMesh cut = cut_by_plane(lifted, {{0, 0, 1}, 0});
        for (int v = 0; v < cut.mesh.vertex_count(); ++v) {
            if (cut.vertices[v] >= 0) {
                cut.mesh.positions.row(v) = mesh.positions.row(cut.vertices[v]);
                continue;
            }
            const auto [i, j] = cut.edges[v];
            const double t = lifted.positions(i, 2) / (lifted.positions(i, 2) - lifted.positions(j, 2));
            cut.mesh.positions.row(v) = (1 - t) * mesh.positions.row(i) + t * mesh.positions.row(j);
        }
        mesh = largest_component(cut.mesh).mesh;
    }
    return mesh;
}

/// human_face with eyes and mouth cut out, as alex_3 has them.
std::optional<Mesh> second_face() {
    const auto path = scan_path("human_face.obj");
    if (!path) return {};
    return opened(read_mesh(*path).mesh,
                  {{-0.031, 0.2735, 0.0145, 0.0065}, {0.031, 0.2735, 0.0145, 0.0065}, {0, 0.2115, 0.026, 0.008}});
}

/// Writes a mesh in space with places of a plane as its map.
std::string write_in_plane(Output& output, const std::string& name, const Mesh& mesh, const Eigen::VectorXcd& plane,
                           const Eigen::VectorXd& values) {
    return output.write(name, mesh, plane, values);
}

void scan_onto_disk(Output& output, Figure& figure, const Surface& face) {
    Table table{
        "The scan alex_3 (27 306 triangles, three holes) onto the disk with holes of radius .15 around "
        "0.1+0.1i, −0.5−0.5i and −0.55+0.3i. Loops are paired in every way; the harmonic map with the "
        "boundary values of the start folds, and the holes are led to their places instead",
        start_head("loop:curve"),
        {}};
    const TargetDomain target = circles_target(kRoundHoles);
    std::optional<SolvedOnto> best, worst;
    std::string best_pairs, worst_pairs;
    std::vector<std::array<int, 2>> worst_loops;
    std::array<int, 3> curves{1, 2, 3};
    do {
        Correspondence wanted;
        wanted.loops = {{0, 0}, {1, curves[0]}, {2, curves[1]}, {3, curves[2]}};
        SolvedOnto solved = solve_onto(face, {target, wanted});
        table.rows.push_back(start_row(pairs(wanted), face, solved));
        if (!solved) continue;
        if (!best || solved.all->k < best->all->k) best = solved, best_pairs = pairs(wanted);
        if (!worst || solved.all->start_flips > worst->all->start_flips)
            worst = solved, worst_pairs = pairs(wanted), worst_loops = wanted.loops;
    } while (std::next_permutation(curves.begin(), curves.end()));
    // The bracket of a large K narrows on a finer mesh of the same surface.
    if (worst) {
        const Surface finer(midpoint_subdivide(face.mesh).mesh);
        Correspondence wanted;
        wanted.loops = worst_loops;
        table.rows.push_back(
            start_row(worst_pairs + ", every face in four", finer, solve_onto(finer, {target, wanted})));
    }
    // The scan's own mesh folds far more.
    const auto without_coarse = [&](std::vector<std::array<int, 2>> loops, std::vector<double> turns,
                                    const std::string& note) {
        Correspondence wanted;
        wanted.loops = std::move(loops);
        ExtremalOptions options;
        options.start_turns = std::move(turns);
        options.max_iterations = 200;
        options.coarse_start = false;
        table.rows.push_back(start_row(pairs(wanted) + ", start on the scan's own mesh" + note, face,
                                       solve_onto(face, {target, wanted}, options)));
    };
    without_coarse({{0, 0}, {1, 2}, {2, 1}, {3, 3}}, {}, "");
    without_coarse({{0, 0}, {1, 2}, {2, 3}, {3, 1}}, {0, 2, -2, 2}, ", holes turned by 2, −2, 2 rad");
    figure.tables.push_back(std::move(table));
    if (!best) return;
    for (const auto& [solved, name, label] : {std::tuple{*best, std::string("sliding_12_near"), best_pairs},
                                              std::tuple{*worst, std::string("sliding_12_far"), worst_pairs}}) {
        const double shown = std::clamp(1.6 * solved.all->k, 0.1, 1.0);
        const std::string data = write(output, name, face, solved);
        Picture picture{name,
                        "alex_3 with the pairs " + label + ": " + std::to_string(solved.all->start_flips) +
                            " flips of the harmonic start, " + std::to_string(solved.all->distortion.flipped.size()) +
                            " of the extremal map.",
                        {}};
        picture.panels.push_back(map_panel(data, "|μ|", shown));
        picture.panels.push_back(surface_panel(data, "squares of the plane", "checker", kAzimuth, kElevation, 30));
        picture.panels.push_back(histogram_panel({{"", data}}, "", solved.all->k, shown));
        figure.pictures.push_back(std::move(picture));
    }
}

/// The course of the iteration from starts of all kinds (their Fig. 21).
void course(Figure& figure, const Surface& face) {
    Correspondence far;
    ExtremalOptions turned;
    turned.start_turns = {0, 2, -2, 2};
    far.loops = {{0, 0}, {1, 1}, {2, 2}, {3, 3}};
    const TargetDomain target = circles_target(kRoundHoles);
    const std::vector<Energies> all{energies("matched", face, target),
                                    energies("holes turned by 2, −2, 2 rad", face, target, turned),
                                    energies("another pairing", face, {target, far})};
    Picture picture{"sliding_12_course",
                    "alex_3 onto the disk with three holes, from starts on its own mesh: the largest |μ| and its 99th "
                    "percentile after every iteration (1: faces are flipped).",
                    {}};
    std::vector<Curve> largest, p99;
    for (const Energies& one : all) largest.push_back(one.largest), p99.push_back(one.p99);
    picture.panels.push_back(curves_panel(largest, "largest |μ|", "iterations", "max |μ|", false));
    picture.panels.push_back(curves_panel(p99, "99th percentile of |μ|", "iterations", "p99", false));
    figure.pictures.push_back(std::move(picture));
    std::string counts;
    for (const Energies& one : all)
        counts += (counts.empty() ? "" : ", ") + one.largest.label + " " + std::to_string(one.settled);
    figure.remarks.push_back("Iterations until all has settled, φ to 1e-6: " + counts + ".");
}

void amoeba_onto_disk(Output& output, Figure& figure) {
    const auto path = scan_path("amoeba1.obj");
    if (!path) return;
    const Surface amoeba(read_mesh(*path).mesh);
    Table table{
        "amoeba1 (14 255 triangles, one hole) onto the disk with a hole of radius .3 around .2", onto_head("map"), {}};
    OntoExample{"sliding_12_amoeba", "amoeba1 onto a disk with a round hole"}.run(output, figure, table, amoeba,
                                                                                  circles_target({{0.2, 0, 0.3}}));
    figure.tables.push_back(std::move(table));
}

/// A map between two surfaces in space: small circles of the source's circle domain on both.
void between(Output& output, Figure& figure, Table& table, const std::string& name, const std::string& caption,
             const Surface& source, const Surface& target, const Correspondence& wanted = {}) {
    const SolvedOnto solved = solve_onto(source, {target, wanted});
    table.rows.push_back(start_row(caption, source, solved));
    if (!solved) return;
    const Mesh& mapped = solved.mesh(source);
    const Eigen::VectorXcd chart = circle_domain_chart(Surface(mapped)).chart.vertices;
    const Eigen::VectorXd& mu = solved.all->distortion.face_abs_mu;
    Mesh image;
    image.faces = mapped.faces;
    image.positions = solved.all->positions;
    const std::string from = write_in_plane(output, name + "_source", mapped, chart, mu),
                      to = write_in_plane(output, name + "_image", image, chart, mu);
    const double shown = std::clamp(1.6 * solved.all->k, 0.1, 1.0);
    const bool flat = target.in_plane();
    Picture picture{name, caption + ".", {}};
    picture.panels.push_back(surface_panel(from, "source", "circles", kAzimuth, kElevation, 34));
    picture.panels.push_back(surface_panel(to, "image", "circles", kAzimuth, flat ? 90 : kElevation, 34));
    picture.panels.push_back(surface_panel(from, "|μ|", "mu", kAzimuth, kElevation, 1, shown));
    picture.panels.push_back(histogram_panel({{"", from}}, "", solved.all->k, shown));
    figure.pictures.push_back(std::move(picture));
}

}  // namespace

Figure sliding_12(Output& output) {
    const auto path = scan_path("alex_3.obj");
    if (!path) return {};
    Figure figure{"Example 12: scans",
                  "*The paper:* the extremal map between two scanned faces with holes; |μ| accumulates at 0.21; 20 "
                  "iterations from an arbitrary start, fewer than 5 from a good one."};
    const Surface face(read_mesh(*path).mesh);
    scan_onto_disk(output, figure, face);
    course(figure, face);
    Table table{"Between two surfaces", start_head("map"), {}};
    const Surface other(deformed(face.mesh));
    const Distortion vertex_to_vertex = distortion_to(face.mesh, other.mesh);
    between(output, figure, table, "sliding_12_faces", "alex_3 onto a deformed copy", face, other, numbered(3));
    if (const auto planar = scan_path("mcqc3d_planar_src.obj"))
        between(output, figure, table, "sliding_12_planar", "alex_3 onto mcqc3d_planar_src", face,
                Surface(read_mesh(*planar).mesh), numbered(3));
    if (auto open_face = second_face()) {
        const Surface second(std::move(*open_face));
        between(output, figure, table, "sliding_12_scans", "alex_3 onto human_face, cut open at eyes and mouth", face,
                second);
        between(output, figure, table, "sliding_12_scans_back", "human_face, cut open, onto alex_3", second, face);
        figure.remarks.push_back(
            "Two different scans: alex_3 and human_face, from which eyes and mouth are cut out by ellipses (" +
            std::to_string(second.topology.boundary_loops.size()) + " loops, " +
            std::to_string(second.mesh.face_count()) + " triangles); loops are matched by position.");
    }
    figure.tables.push_back(std::move(table));
    figure.remarks.push_back(
        "By default the start is made on a coarse mesh, and the flips are those of that mesh; on the scan's own mesh "
        "there are thousands. To exchange two holes of the face against their order around the boundary costs K of 6 "
        "and more; on the scan's own mesh the bracket of such a K is up to 5 % wide, with every face in four below 2 "
        "%.");
    figure.remarks.push_back("The map onto the copy that sends every vertex to itself has mean |μ| " +
                             number(vertex_to_vertex.mean) + ", 99th percentile " + number(vertex_to_vertex.p99) +
                             " and largest " + number(vertex_to_vertex.max, 3) +
                             ". mcqc3d_planar_src is a conformal image of alex_3 up to the errors of the mesh, which "
                             "the small k finds out; what is left of |μ| there is those errors.");
    amoeba_onto_disk(output, figure);
    return figure;
}

Figure sliding_distance_scans(Output& output) {
    const auto first = scan_path("alex_3.obj"), planar = scan_path("mcqc3d_planar_src.obj");
    const auto second = second_face();
    if (!first || !planar || !second) return {};
    Figure figure{"Distances of scans",
                  "½ log K* between two scanned faces with eyes and mouth open, a copy of each that is deformed in the "
                  "same way, and a conformal image of the first one in the plane; holes matched by position, every "
                  "distance from the maps both ways."};
    const Mesh face = read_mesh(*first).mesh;
    const std::vector<std::string> names{"alex_3", "alex_3 in the plane", "alex_3, deformed", "human_face",
                                         "human_face, deformed"};
    std::vector<Surface> surfaces;
    for (const Mesh& mesh : {face, read_mesh(*planar).mesh, deformed(face), *second, deformed(*second)})
        surfaces.emplace_back(mesh);
    const DistanceMatrix matrix = distance_matrix(surfaces, {}, {}, {}, names);
    add_distances(output, figure, "sliding_distance_scans", names, matrix);
    figure.remarks.push_back("Pairs that have not settled: " + std::to_string(matrix.unsettled.size()) + ".");
    return figure;
}

Figure sliding_13(Output& output) {
    const auto path = scan_path("alex_3.obj");
    if (!path) return {};
    Figure figure{"Example 13: grids",
                  "*The paper:* a face with three holes is mapped to a simple parameter domain; a structured grid and "
                  "a checkerboard there are carried back to the face (Fig. 22)."};
    const Surface face(read_mesh(*path).mesh);
    Correspondence wanted;
    wanted.loops = {{0, 0}, {1, 2}, {2, 3}, {3, 1}};
    const SolvedOnto solved = solve_onto(face, {circles_target(kRoundHoles), wanted});
    Table table{"The parameter map of alex_3", start_head("loop:curve"), {start_row(pairs(wanted), face, solved)}};
    figure.tables.push_back(std::move(table));
    if (!solved) return figure;
    const Surface source(solved.mesh(face));
    Table quality{"Grids carried to the face; angles in degrees, of quads and of the triangles at the border",
                  {"grid", "border", "faces", "whole cells", "trimmed", "left out", "least angle", "largest angle",
                   "mean aspect", "largest aspect", "area ratio", "folded faces"},
                  {}};
    Picture texture{"sliding_13_texture", "The checkerboard of the parameter domain on the face, and |μ|.", {}};
    struct Kind {
        std::string name, file;
        PlaneGrid grid;
        GridOptions::Border border;
        bool shown;
    };
    const RectangularGrid square{.spacing = 0.05};
    // Its circles are those around the first hole, which is one of them.
    const LogPolarGrid polar{.centre = {0.1, 0.1}, .inner_radius = 0.15, .sectors = 64};
    for (const Kind& kind : {Kind{"square, .05", "square", square, GridOptions::Border::trimmed, true},
                             Kind{"square, .05", "square_stepped", square, GridOptions::Border::stepped, false},
                             Kind{"log-polar, 64 rays", "polar", polar, GridOptions::Border::trimmed, true},
                             Kind{"log-polar, 64 rays", "polar_stepped", polar, GridOptions::Border::stepped, false}}) {
        GridOptions how;
        how.border = kind.border;
        const SurfaceGrid grid = grid_on_surface(source, solved.all->map, kind.grid, how);
        const double degrees = 180 / std::numbers::pi;
        const GridQuality& q = grid.quality;
        quality.rows.push_back({kind.name, kind.border == GridOptions::Border::trimmed ? "trimmed" : "stepped",
                                std::to_string(grid.mesh.face_count()), std::to_string(grid.whole_cells),
                                std::to_string(grid.trimmed_cells), std::to_string(grid.omitted_cells),
                                number(degrees * q.min_angle, 1), number(degrees * q.max_angle, 1),
                                number(q.mean_aspect, 2), number(q.max_aspect, 1), number(q.area_ratio, 0),
                                std::to_string(q.folded.size())});
        if (!kind.shown) continue;
        const std::string data = output.write("sliding_13_" + kind.file, grid.mesh, grid.parameter,
                                              Eigen::VectorXd::Zero(grid.mesh.face_count()));
        figure.pictures.push_back(
            {"sliding_13_" + kind.file,
             "The grid (" + kind.name + ", " + std::to_string(q.folded.size()) +
                 " folded faces) in the parameter domain and on the face.",
             {faces_panel(data, "parameter domain"), surface_panel(data, "face", "faces", kAzimuth, kElevation),
              surface_panel(data, "from the side", "faces", kAzimuth + 40, 40)}});
    }
    const std::string data = write(output, "sliding_13_map", face, solved);
    const double shown = 1.6 * solved.all->k;
    texture.panels.push_back(surface_panel(data, "checkerboard", "checker", kAzimuth, kElevation, 30));
    texture.panels.push_back(surface_panel(data, "from the side", "checker", kAzimuth + 40, 40, 30));
    texture.panels.push_back(map_panel(data, "|μ|", shown));
    texture.panels.push_back(histogram_panel({{"", data}}, "", solved.all->k, shown));
    figure.tables.push_back(std::move(quality));
    figure.pictures.push_back(std::move(texture));
    return figure;
}

}  // namespace beltrami::gallery
