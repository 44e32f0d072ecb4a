// Problems with corners, and a scan with pins.
#include <cstdlib>

#include <beltrami/generate/round_domains.h>
#include <beltrami/io/number_lists.h>

#include "gallery/gallery.h"

namespace beltrami::gallery {

using namespace beltrami::bench;

namespace {

/// K of the disk's boundary values e^{i(t + ε sin t)}.
double disk_K(double epsilon) {
    const Mesh mesh = disk(60);
    const Topology shape = topology(mesh);
    BoundaryCondition boundary;
    for (const int v : shape.boundary_loops[0]) {
        const double t = std::arg(Complex(mesh.positions(v, 0), mesh.positions(v, 1)));
        boundary.pin(v, std::polar(1.0, t + epsilon * std::sin(t)));
    }
    return extremal_map(mesh, boundary).K;
}

}  // namespace

Figure corners(Output& output) {
    Figure figure{
        "Corners",
        "*Beyond the paper*, which reports flips \"near highly concave parts of the boundary\". Where the "
        "source, the image or the speed of the boundary values has a corner, φ has a pole or a root there, and "
        "the boundary values alone force a dilatation (the corner bound)."};
    Table table{"",
                {"problem", "triangles", "k", "K_lower", "K", "K of the disk", "corner bound", "mean abs(μ)", "std",
                 "p99", "max", "flips", "at the start", "iterations", "seconds"},
                {}};
    for (const std::string name :
         {"arrow_head_45", "arrow_head_65", "l_to_square", "notched_disk", "gear_to_disk", "disk_to_gear"}) {
        const Problem problem = named_problem(name);
        const Surface surface(problem.mesh);
        const Solved solved = solve(surface, problem.boundary, "extremal");
        const std::string triangles = std::to_string(problem.mesh.face_count());
        if (!solved) {
            table.rows.push_back({name, triangles, "refused: " + solved.refusal});
            continue;
        }
        const Distortion& d = solved.distortion;
        const Solved start = solve(surface, problem.boundary, "harmonic");
        // Conformal maps do not change K: with conformal angles t the problem is one of the round disk.
        std::optional<double> exact;
        if (name == "notched_disk") exact = disk_K(0.5);
        if (name == "gear_to_disk") exact = disk_K(0.6);
        table.rows.push_back(
            {name, triangles, number(*solved.k), number(*solved.K_lower), number(*solved.K),
             exact ? number(*exact) : "", solved.all->sharpest ? number(solved.all->sharpest->safe_bound) : "",
             number(d.mean), number(d.standard_deviation), number(d.p99), number(d.max, 3),
             std::to_string(d.flipped.size()), std::to_string(start.distortion.flipped.size()),
             std::to_string(solved.iterations) + (solved.end == "converged" ? "" : " (" + solved.end + ")"),
             number(solved.seconds, 2)});
        Picture picture{"corners_" + name, problem.statement + ".", {}};
        const std::string data = output.write("corners_" + name, surface, solved);
        const double shown = std::min(1.0, std::max(0.3, 1.6 * *solved.k));
        picture.panels.push_back(map_panel(data, "source", shown, "source"));
        picture.panels.push_back(map_panel(data, "image", shown));
        picture.panels.push_back(grid_panel(data, "checkerboard of the source", "square", 16));
        picture.panels.push_back(histogram_panel({{"extremal", data}}, "|μ|", solved.k, shown));
        figure.pictures.push_back(std::move(picture));
    }
    figure.tables.push_back(std::move(table));
    figure.remarks.push_back(
        "The conformal speed of the notched disk and of the gear is that of a discrete conformal map, which is not "
        "exact "
        "at corners: the corner bound of these data is larger than the K of the smooth problem, that of the disk.");
    return figure;
}

Figure scan(Output& output) {
    const char* folder = std::getenv("BELTRAMI_MESHES");
    const std::filesystem::path meshes = folder ? folder : "";
    if (!std::filesystem::exists(meshes / "mcqc3d_planar_src.obj")) return {};
    Figure figure{
        "A domain with holes and pins",
        "*Not in the paper.* A published test problem of multiply connected quasiconformal maps, "
        "`mcqc3d_planar_src.obj` with `mcqc3d_pins.txt` (not in this repository; the section is made where the "
        "folder BELTRAMI_MESHES has them)."};
    Problem problem;
    problem.mesh = read_mesh(meshes / "mcqc3d_planar_src.obj").mesh;
    const IndexedRows pins = read_indexed_rows(meshes / "mcqc3d_pins.txt", 1, problem.mesh.vertex_count(), 2, "a pin");
    for (Eigen::Index i = 0; i < pins.indices.rows(); ++i)
        problem.boundary.pin(pins.indices(i, 0), {pins.values(i, 0), pins.values(i, 1)});
    const Surface surface(problem.mesh);
    problem.statement = std::to_string(surface.topology.boundary_loops.size() - 1) + " holes, " +
                        std::to_string(pins.indices.rows()) + " prescribed vertices, " +
                        std::to_string(problem.mesh.face_count()) + " triangles";
    Comparison comparison{output, figure, "scan", problem, problem.boundary};
    comparison.pattern = "square";
    comparison.squares = 32;
    const std::vector<Solved> found = comparison.run({"harmonic", "extremal"});
    if (found[1]) {
        const double linear = harmonic_seconds(surface, problem.boundary);
        // Without the bounds of quadratic maps.
        ExtremalOptions options;
        options.sharpen = -1;
        const Solved plain = solve(surface, problem.boundary, "extremal", options);
        figure.remarks.push_back(
            "A harmonic map takes " + number(linear, 3) + " s, the extremal map " +
            number(found[1].seconds / linear, 0) + " times as long, without the bound of quadratic maps " +
            number(plain.seconds / linear, 0) + " times. K_lower ≤ K* ≤ K_max: " + number(*found[1].K_lower) + " … " +
            number(found[1].distortion.max_dilatation()) + ".");
    }
    return figure;
}

}  // namespace beltrami::gallery
