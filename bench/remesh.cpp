// Remeshing with the connectivity kept: what the faces' shapes become, against tangential relaxation and the
// least-squares maps of Gruber and Aulisa.
//
//     bench_remesh [--features DEGREES] [--holes N [--rings N]] [--noise A] [--fixed-border] [--out FOLDER] MESH...
//     [--part EDGE]
//                  [--double-torus EDGE]
//     bench_remesh --speed MESH...
//
// As in docs/remesh.md: the noisy torus is torus.obj with --noise .28 --holes 19 --rings 1,
// its border fixed --fixed-border, the part --features 40 --noise .3 --part .08, the double torus --double-torus .14.
// --speed measures least-squares maps and steps alone, of meshes of any size: --speed --double-torus .0205 has 100 000
// faces.
//
// --holes cuts N disks of two rings (--rings) at farthest points, --noise moves vertices by A of their shortest edge
// along the surface first, not those of features; --out has data of pictures for gallery/draw.py; --part is the plate
// of cad_part.h, --double-torus that of generate/. Where CGAL is (libcgal-dev), its isotropic remeshing stands beside,
// at .98 of the mean edge, ten iterations: it changes the connectivity. Then what a harmonic map of the mesh takes and
// the others are in units of it, in seconds of the processor. One line a method: angles (smallest / 1 % / median and
// mean deviation from 60 or 90 degrees), |μ| (mean / std / max), faces that oppose the surface, largest distance from
// it and its mean of the diagonal, area ratio, linear systems, seconds.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <beltrami/beltrami.h>
#include <beltrami/mesh/submesh.h>
#include <beltrami/space/corner_elements.h>
#include <beltrami/space/tangential_map.h>
#include <beltrami/space/uniform_map.h>

#include "cad_part.h"
#include "closed_harmonic.h"
#include "picture_data.h"
#include "space_cases.h"
#ifdef BELTRAMI_ISOTROPIC
#include "others/isotropic.h"
#endif

namespace {

using namespace beltrami;
using namespace bench;

PictureData pictures;

double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

struct Case {
    Surface surface;
    MeshTarget target;
    CornerElements elements;
    double diagonal, area;

    explicit Case(const Mesh& mesh)
        : surface(mesh),
          target(mesh),
          elements(corner_elements(mesh, regular_shapes(mesh.faces))),
          diagonal((mesh.positions.colwise().maxCoeff() - mesh.positions.colwise().minCoeff()).norm()),
          area(surface_area(mesh)) {}
};

double mesh_corners(const Case& c) {
    return c.surface.mesh.faces.corner_count();
}

void line(const Case& c, const std::string& name, const Positions& positions, int systems, double seconds) {
    Mesh image = c.surface.mesh;
    image.positions = positions;
    const AngleStatistics angles = angle_statistics(image);
    // Oriented by the surface, not by the image.
    const Positions normals = normals_of(nearest_points(c.target, positions));
    const Distortion d = distortion(c.elements.operators, positions, normals);
    const SurfaceDistance distance = surface_distance(c.target, MeshTarget(image));
    fmt::print(
        "| {} | {:.1f} / {:.1f} / {:.2f} / {:.2f} | {:.4f} / {:.4f} / {:.3f} | {} | {:.4f} / {:.5f} | {:.4f} | {} | "
        "{:.2f} |\n",
        name, angles.smallest, angles.one_percent, angles.median_deviation, angles.mean_deviation, d.mean,
        d.standard_deviation, d.max, opposed_faces(image, c.target).size(), distance.largest / c.diagonal,
        distance.mean / c.diagonal, surface_area(image) / c.area, systems, seconds);
    std::fflush(stdout);
    if (name != "start" && name != "normals preserved, QC iteration" && name != "remesh, p = 4") return;
    pictures.add(name, image, d.face_abs_mu);
    std::vector<double> degrees, parts;
    for (std::size_t i = 0; i < angles.histogram.size(); ++i) {
        degrees.push_back(10 * static_cast<double>(i) + 5);
        parts.push_back(100.0 * angles.histogram[i] / mesh_corners(c));
    }
    pictures.add_curve(name, degrees, parts);
}

/// What remeshing tools do with the connectivity kept: to the mean of the neighbours weighted by areas, half of the
/// way, along the tangent plane, and back to the surface.
Positions tangential_relaxation(const Case& c, const std::vector<char>& held, int rounds) {
    Mesh image = c.surface.mesh;
    const int n = image.vertex_count();
    for (int round = 0; round < rounds; ++round) {
        Eigen::VectorXd area = Eigen::VectorXd::Zero(n), weight = Eigen::VectorXd::Zero(n);
        for (int f = 0; f < image.face_count(); ++f)
            for (const int v : image.faces[f]) area[v] += face_vector_area(image, f).norm();
        Positions sum = Positions::Zero(n, 3);
        for (const auto& [a, b] : c.surface.topology.edges) {
            sum.row(a) += area[b] * image.positions.row(b);
            sum.row(b) += area[a] * image.positions.row(a);
            weight[a] += area[b];
            weight[b] += area[a];
        }
        const Positions normals = vertex_normals(image);
        for (int v = 0; v < n; ++v) {
            if (held[v]) continue;
            Eigen::RowVector3d move = sum.row(v) / weight[v] - image.positions.row(v);
            move -= move.dot(normals.row(v)) * normals.row(v);
            image.positions.row(v) = c.target.nearest((image.positions.row(v) + 0.5 * move).transpose()).position;
        }
    }
    return image.positions;
}

void least_squares(const Case& c, const char* name, Preserve preserve, const std::vector<char>& held) {
    const double start = now();
    LeastSquaresMap problem(c.surface.mesh, c.elements, c.surface.mesh.positions, held, preserve);
    UniformOptions options;
    options.max_iterations = 15;
    const UniformMap map = uniform_map(problem, c.surface.mesh, options);
    const double seconds = now() - start;
    line(c, fmt::format("{} preserved, least squares", name), map.first, 1, seconds / map.solves);
    line(c, fmt::format("{} preserved, QC iteration", name), map.map, map.solves, seconds);
}

/// One harmonic map to the plane, of a closed mesh less a face, in seconds of the processor.
double seconds_of_harmonic(const Case& c) {
    const auto& loops = c.surface.topology.boundary_loops;
    if (loops.empty()) return bench::closed_harmonic_processor_seconds(c.surface.mesh);
    BoundaryCondition boundary;
    for (std::size_t l = 0; l < loops.size(); ++l)
        for (std::size_t i = 0; i < loops[l].size(); ++i)
            boundary.pin(loops[l][i],
                         std::polar(1.0 + static_cast<double>(l), 2 * std::numbers::pi * static_cast<double>(i) /
                                                                      static_cast<double>(loops[l].size())));
    const double begun = processor_seconds();
    (void)harmonic_seconds(c.surface, boundary);  // solves three times
    return (processor_seconds() - begun) / 3;
}

/// The least of three runs.
template <class Work>
double least_processor_seconds(Work&& work) {
    double least = std::numeric_limits<double>::infinity();
    for (int run = 0; run < 3; ++run) {
        const double begun = processor_seconds();
        work();
        least = std::min(least, processor_seconds() - begun);
    }
    return least;
}

/// What least-squares maps and steps take of meshes that are too large for the rest.
void measure_speed(const std::string& name, const Mesh& mesh) {
    const Case c(mesh);
    double harmonic = std::numeric_limits<double>::infinity();
    for (int run = 0; run < 3; ++run) harmonic = std::min(harmonic, seconds_of_harmonic(c));
    // Prescribed: the border, or, of closed meshes, a face.
    std::vector<char> none(static_cast<std::size_t>(mesh.vertex_count()), 0), held = none;
    for (const auto& loop : c.surface.topology.boundary_loops)
        for (const int v : loop) held[v] = 1;
    if (c.surface.topology.boundary_loops.empty())
        for (const int v : mesh.faces[0]) held[v] = 1;
    const auto least_squares_map = [&](Preserve preserve, const std::vector<char>& fixed) {
        return least_processor_seconds([&] {
            const CornerElements elements = corner_elements(mesh, regular_shapes(mesh.faces));
            (void)LeastSquaresMap(mesh, elements, mesh.positions, fixed, preserve)
                .solve(Eigen::VectorXcd::Zero(elements.operators.sample_count()));
        });
    };
    const double places = least_squares_map(Preserve::nothing, held),
                 normals = least_squares_map(Preserve::normals, none), area = least_squares_map(Preserve::area, none);
    const auto a_step = [&](double power) {
        constexpr int kSteps = 4;
        TangentialMap map(c.surface, c.elements.operators, c.target, {}, RemeshOptions().even_size);
        map.relax(2, 1, 0);  // with what is set up once
        const double begun = processor_seconds();
        const int steps = map.relax(power, kSteps, 0);
        return (processor_seconds() - begun) / steps;
    };
    fmt::print(
        "| {}, {} faces | in harmonic maps of {:.3f} s: least squares {:.1f} (places prescribed), {:.1f} (normals), "
        "{:.1f} (area); a step {:.1f} (p = 2), {:.1f} (p = 4) | | | | | | |\n",
        name, mesh.face_count(), harmonic, places / harmonic, normals / harmonic, area / harmonic, a_step(2) / harmonic,
        a_step(4) / harmonic);
}

#ifdef BELTRAMI_ISOTROPIC
void isotropic(const Case& c, std::optional<double> features) {
    const Mesh& mesh = c.surface.mesh;
    double length = 0;
    for (const auto& [a, b] : c.surface.topology.edges) length += (mesh.point(a) - mesh.point(b)).norm();
    length /= c.surface.topology.edge_count();
    const double start = now();
    const Mesh image = isotropic_remeshing(mesh, 0.98 * length, 10, features);
    const double seconds = now() - start;
    const AngleStatistics angles = angle_statistics(image);
    const CornerElements elements = corner_elements(image, regular_shapes(image.faces));
    const Distortion d = distortion(elements.operators, image.positions, vertex_normals(image));
    const SurfaceDistance distance = surface_distance(c.target, MeshTarget(image));
    fmt::print(
        "| CGAL, isotropic, {} faces | {:.1f} / {:.1f} / {:.2f} / {:.2f} | {:.4f} / {:.4f} / {:.3f} | {} | {:.4f} / "
        "{:.5f} | {:.4f} | 0 | {:.2f} |\n",
        image.face_count(), angles.smallest, angles.one_percent, angles.median_deviation, angles.mean_deviation, d.mean,
        d.standard_deviation, d.max, opposed_faces(image, c.target).size(), distance.largest / c.diagonal,
        distance.mean / c.diagonal, surface_area(image) / c.area, seconds);
}
#endif

void measure(const std::string& name, const Mesh& mesh, const RemeshOptions& given) {
    const Case c(mesh);
    fmt::print("| **{}, {} faces** | | | | | | | |\n", name, mesh.face_count());
    pictures.begin("remesh " + std::filesystem::path(name).stem().string(), 40, 25, 0.6);
    line(c, "start", mesh.positions, 0, 0);
    const std::vector<char> held = on_curves(mesh, c.surface.topology, given.feature_angle);
#ifdef BELTRAMI_ISOTROPIC
    isotropic(c, given.feature_angle);
#endif
    double start = now();
    const Positions relaxed = tangential_relaxation(c, held, 50);
    line(c, "tangential relaxation, 50 rounds", relaxed, 0, now() - start);
    least_squares(c, "normals", Preserve::normals, held);
    least_squares(c, "area", Preserve::area, held);
    const double harmonic = seconds_of_harmonic(c);
    start = processor_seconds();
    LeastSquaresMap(mesh, c.elements, c.surface.mesh.positions, held, Preserve::normals)
        .solve(Eigen::VectorXcd::Zero(c.elements.operators.sample_count()));
    std::string in_harmonic = fmt::format("least squares {:.1f}", (processor_seconds() - start) / harmonic);
    const auto of_kind = [&](const std::string& kind, const RemeshOptions& options) {
        start = now();
        const double processor = processor_seconds();
        try {
            const RemeshedSurface result = remesh(c.surface, regular_shapes(mesh.faces), options);
            const double seconds = processor_seconds() - processor;
            line(c, kind, result.positions, result.factorizations, now() - start);
            in_harmonic += fmt::format("; {} {:.1f}, a step {:.1f}", kind, seconds / harmonic,
                                       seconds / harmonic / std::max(result.steps, 1));
        } catch (const Error& error) {
            fmt::print("| {} | {} | | | | | | |\n", kind, error.what());
        }
    };
    RemeshOptions options = given;
    options.fast = true;
    of_kind("one linear solve", options);
    options.fast = false;
    for (const double power : {2.0, 4.0, 8.0}) {
        options.power = power;
        of_kind(fmt::format("remesh, p = {:g}", power), options);
    }
    options.power = 4;
    options.open_angles = true;
    of_kind("remesh, p = 4, angles opened", options);
    options.power = 8;
    of_kind("remesh, p = 8, angles opened", options);
    pictures.end("angle, degrees", "% of the angles");
    fmt::print("| in harmonic maps of {:.3f} s: {} | | | | | | | |\n", harmonic, in_harmonic);
}

}  // namespace

int main(int argc, char** argv) {
    RemeshOptions options;
    int holes = 0, rings = 2;
    double noise = 0;
    bool speed_alone = false;
    fmt::print(
        "| | min / 1 % / median / mean deviation | mean / std / max \\|mu\\| | opposed | distance largest / mean | "
        "area | "
        "systems | s |\n| --- | --- | --- | --- | --- | --- | --- | --- |\n");
    const auto prepared = [&](const std::string& name, Mesh mesh) {
        if (noise > 0) mesh = with_noise(mesh, noise, options.feature_angle);
        if (holes > 0) mesh = with_holes(mesh, holes, rings);
        speed_alone ? measure_speed(name, mesh) : measure(name, mesh, options);
    };
    try {
        for (int i = 1; i < argc; ++i) {
            const bool more = i + 1 < argc;
            if (!std::strcmp(argv[i], "--features") && more)
                options.feature_angle = std::stod(argv[++i]) * std::numbers::pi / 180;
            else if (!std::strcmp(argv[i], "--holes") && more)
                holes = std::stoi(argv[++i]);
            else if (!std::strcmp(argv[i], "--rings") && more)
                rings = std::stoi(argv[++i]);
            else if (!std::strcmp(argv[i], "--noise") && more)
                noise = std::stod(argv[++i]);
            else if (!std::strcmp(argv[i], "--out") && more)
                pictures.set_folder(argv[++i]);
            else if (!std::strcmp(argv[i], "--part") && more)
                prepared("part", cad_part(std::stod(argv[++i])));
            else if (!std::strcmp(argv[i], "--double-torus") && more)
                prepared("double torus", double_torus(std::stod(argv[++i])));
            else if (!std::strcmp(argv[i], "--speed"))
                speed_alone = true;
            else if (!std::strcmp(argv[i], "--fixed-border"))
                options.slide_border = false;
            else {
                Mesh mesh = remove_unreferenced(read_mesh(argv[i]).mesh).mesh;
                mesh.texture.reset();
                prepared(argv[i], std::move(mesh));
            }
        }
    } catch (const std::exception& error) {
        fmt::print(stderr, "{}\n", error.what());
        return 1;
    }
    return 0;
}
