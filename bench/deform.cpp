// Deformations: what is made small of the map, on targets that are known and on surfaces that are chosen first.
//
//     bench_deform [--out FOLDER] cylinder|bump|arrow|torus|spheres [--fine]
//     bench_deform [--out FOLDER] MESH DEGREES PULL      the boundary loops turned and pulled along their axes
//
// cylinder: the upper rim lowered by 80 and 95 % of the height at one side; bump: by a bump of 80 %; arrow: the corner
// of a square pushed in, triangles and quads; torus: its hole turned by 60 and 100 degrees; spheres: six holes turned
// by ±60 and ±90. One line a method: |μ| (mean / std / max), flipped faces, edges that fold, area ratio, linear
// systems, the bracket of K*, seconds. --out has data of pictures for gallery/draw.py.
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstring>
#include <numbers>
#include <string>
#include <vector>

#include <beltrami/applications/handled_surface.h>
#include <beltrami/beltrami.h>
#include <beltrami/mesh/submesh.h>
#include <beltrami/space/corner_elements.h>
#include <beltrami/space/uniform_map.h>
#include <beltrami/space/unrolled_map.h>

#include "picture_data.h"
#include "space_cases.h"

namespace {

using namespace beltrami;
using namespace bench;
using std::numbers::pi;

PictureData pictures;

double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

struct Case {
    std::string name;
    Surface surface;
    Handles handles;
    CornerElements elements;

    /// What stands in the picture, too.
    static bool pictured(const std::string& method) {
        return method.find(',') == std::string::npos && method.find("passes") == std::string::npos &&
               method != "minimize spread" && method != "powers on uniform";
    }
    ~Case() { pictures.end(); }
    Case(const Case&) = delete;

    struct View {
        double azimuth, elevation, most_mu;
    };

    Case(std::string n, const Mesh& mesh, Handles h, const View& view)
        : name(std::move(n)), surface(mesh), handles(std::move(h)), elements(corner_elements(surface.mesh)) {
        pictures.begin("space " + name, view.azimuth, view.elevation, view.most_mu);
        fmt::print("| **{}, {} faces** | | | | | | | |\n", name, mesh.face_count());
    }
};

void line(const Case& c, const std::string& method, const Positions& positions, const Distortion& d, int systems,
          const std::string& bracket, double seconds) {
    Mesh image = c.surface.mesh;
    image.positions = positions;
    fmt::print("| {} | {:.4f} / {:.4f} / {:.3f} | {} | {} | {:.3f} | {} | {} | {:.2f} |\n", method, d.mean,
               d.standard_deviation, d.max, d.flipped.size(), fold_edges(c.surface, positions).size(),
               surface_area(image) / surface_area(c.surface.mesh), systems, bracket, seconds);
    std::fflush(stdout);
    if (c.pictured(method)) pictures.add(method, image, d.face_abs_mu);
}

/// Gruber and Aulisa's: the least-squares conformal map and the QC iteration, oriented as the target is. On the
/// cylinder they are solved for where it is unrolled; with the normals preserved vertices would leave it.
void least_squares(const Case& c, const Target* target, int steps) {
    const auto n = static_cast<std::size_t>(c.surface.mesh.vertex_count());
    std::vector<char> fixed(n, 0);
    Positions places = Positions::Zero(c.surface.mesh.vertex_count(), 3);
    for (int v = 0; v < c.surface.mesh.vertex_count(); ++v) places.row(v) = c.surface.mesh.point(v);
    for (std::size_t i = 0; i < c.handles.vertices.size(); ++i) {
        fixed[c.handles.vertices[i]] = 1;
        places.row(c.handles.vertices[i]) = c.handles.places.row(static_cast<Eigen::Index>(i));
    }
    const auto measured = [&](const Positions& positions) {
        Mesh image = c.surface.mesh;
        image.positions = positions;
        const Positions normals = target ? normals_of(nearest_points(*target, positions)) : vertex_normals(image);
        return distortion(c.elements.operators, positions, normals);
    };
    const auto* const rolled = dynamic_cast<const ParametricTarget*>(target);
    const auto iterate = [&](const std::string& name, bool line_search, int passes, int most) {
        const double start = now();
        UniformOptions options;
        options.max_iterations = most;
        options.tolerance = 1e-4;
        options.line_search = line_search;
        options.smoothing_passes = passes;
        UniformMap map;
        if (rolled) {
            const UnrolledPlaces unrolled =
                unrolled_places(*rolled, c.surface.mesh.faces, nearest_points(*target, places)).value();
            const UnrolledMap found = uniform_unrolled_map(c.surface.mesh, c.elements, unrolled, fixed, options);
            map.first = positions_of(rolled_up(*rolled, found.first));
            map.map = positions_of(rolled_up(*rolled, found.vertices));
            map.solves = found.solves;
        } else {
            LeastSquaresMap problem(c.surface.mesh, c.elements, places, fixed, Preserve::nothing);
            map = uniform_map(problem, c.surface.mesh, options);
        }
        const double seconds = now() - start;
        if (name == "QC iteration")
            line(c, "least squares", map.first, measured(map.first), 1, "", seconds / map.solves);
        line(c, name, map.map, measured(map.map), map.solves, "", seconds);
    };
    iterate("QC iteration", false, 1, steps);
    if (!target) return;
    if (rolled) iterate("QC iteration, 20 steps", false, 1, 20);
    iterate("QC iteration, line search", true, 1, steps);
    for (const int passes : {2, 3, 5}) iterate(fmt::format("QC iteration, {} passes", passes), false, passes, steps);
}

void goals(const Case& c, const Target* target, const std::vector<DeformedSurface>& surfaces) {
    for (const DeformedSurface surface : surfaces)
        for (const DeformGoal goal : {DeformGoal::dilatation, DeformGoal::largest, DeformGoal::spread}) {
            if (!target && goal != DeformGoal::largest) continue;
            DeformOptions options;
            options.goal = goal;
            options.surface = surface;
            const std::string method =
                target ? std::string("minimize ") + to_string(goal) : std::string("powers on ") + to_string(surface);
            const double start = now();
            try {
                DeformSolver solver(c.surface, c.handles.vertices, options);
                const Deformation result =
                    target ? solver.solve_onto(*target, c.handles.places) : solver.solve(c.handles.places);
                const double seconds = now() - start;
                std::string bracket;
                if (result.extremal)
                    bracket = fmt::format("k {:.4f}, {:.3f} <= K* ~ {:.3f}", result.extremal->k,
                                          result.extremal->K_lower, result.extremal->K);
                if (!target)
                    fmt::print("| {} as it is | {:.4f} / {:.4f} / {:.3f} | | | | | | |\n", to_string(result.kind),
                               result.of_surface.mean, result.of_surface.standard_deviation, result.of_surface.max);
                line(c, method, result.positions, result.distortion, result.factorizations, bracket, seconds);
            } catch (const Error& error) {
                fmt::print("| {} | {} | | | | | | |\n", method, error.what());
            }
        }
}

const std::vector<DeformedSurface> kAll{DeformedSurface::thin_plate, DeformedSurface::rigid, DeformedSurface::uniform};

void cylinders(bool bump, bool fine) {
    const int n = fine ? 2 : 1;
    for (const Cells cells : {Cells::triangles, Cells::quads})
        for (const double part : bump ? std::vector<double>{0.8} : std::vector<double>{0.8, 0.95}) {
            const Mesh mesh = cylinder_to_lower(n, cells);
            const ParametricTarget target = cylinder_target(1, 2);
            const Case c(fmt::format("{} {:.0f} %, {}", bump ? "bump" : "cylinder", 100 * part,
                                     cells == Cells::quads ? "quads" : "triangles"),
                         mesh,
                         rims(mesh,
                              [&](double t) {
                                  return bump ? 2 * part * std::exp(-std::pow(t / 0.6, 2)) : part * (1 - std::cos(t));
                              }),
                         {40, 20, 1});
            least_squares(c, &target, 80);
            goals(c, &target, {DeformedSurface::automatic});
        }
}

void arrows(bool fine) {
    const int n = fine ? 56 : 28;
    for (const Cells cells : {Cells::triangles, Cells::quads})
        for (const double push : {0.65, 0.8}) {
            Mesh mesh = rectangle(1, 1, n, n, cells);
            mesh.positions.conservativeResize(Eigen::NoChange, 3);
            mesh.positions.col(2).setZero();
            Handles handles = arrow_head(mesh, push);
            const Case c(fmt::format("arrow head {:.2f}, {}", push, cells == Cells::quads ? "quads" : "triangles"),
                         mesh, std::move(handles), {-90, 90, 1});
            const PlaneTarget plane;
            least_squares(c, &plane, 99);
            goals(c, &plane, {DeformedSurface::automatic});
        }
}

void in_space(const std::string& name, const Mesh& mesh, Handles handles) {
    const Case c(name, mesh, std::move(handles), {200, 25, 0.8});
    least_squares(c, nullptr, 60);
    goals(c, nullptr, kAll);
}

void tori() {
    const Mesh mesh = torus_with_hole();
    in_space("torus, 60 degrees, pulled by .8", mesh, turned(mesh, pi / 3, 0.8, 1, false));
    in_space("torus, 100 degrees, times 1.3", mesh, turned(mesh, 100 * pi / 180, 0.3, 1.3, false));
}

void spheres() {
    const Mesh mesh = sphere_with_holes();
    in_space("six holes, 60 degrees, moved, scaled", mesh, turned(mesh, pi / 3, 0.3, 1.25, true));
    in_space("six holes, 90 degrees", mesh, turned(mesh, pi / 2, 0, 1, true));
}

}  // namespace

int main(int argc, char** argv) {
    fmt::print(
        "| | mean / std / max \\|mu\\| | flipped | folds | area | systems | bracket | s |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- |\n");
    bool fine = false;
    for (int i = 1; i < argc; ++i) fine = fine || !std::strcmp(argv[i], "--fine");
    try {
        for (int i = 1; i < argc; ++i) {
            const std::string word = argv[i];
            if (word == "--fine") continue;
            if (word == "--out" && i + 1 < argc) {
                pictures.set_folder(argv[++i]);
            } else if (word == "cylinder" || word == "bump") {
                cylinders(word == "bump", fine);
            } else if (word == "arrow") {
                arrows(fine);
            } else if (word == "torus") {
                tori();
            } else if (word == "spheres") {
                spheres();
            } else if (i + 2 < argc) {
                Mesh mesh = remove_unreferenced(read_mesh(word).mesh).mesh;
                mesh.texture.reset();
                const double degrees = std::stod(argv[i + 1]), pull = std::stod(argv[i + 2]);
                in_space(fmt::format("{}, {} degrees, pulled by {}", word, degrees, pull), mesh,
                         turned(mesh, degrees * pi / 180, pull, 1, false));
                i += 2;
            }
        }
    } catch (const std::exception& error) {
        fmt::print(stderr, "{}\n", error.what());
        return 1;
    }
    return 0;
}
