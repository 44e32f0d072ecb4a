// Shapes of faces: beside Gruber and Aulisa's Figs 1, 5, 10 and 17 to 20, with meshes of the folder BELTRAMI_MESHES or
// made here in place of theirs.
#include <numbers>

#include <beltrami/mesh/submesh.h>
#include <beltrami/space/uniform_map.h>

#include "cad_part.h"
#include "gallery/space.h"
#include "space_cases.h"

namespace beltrami::gallery {

namespace {

constexpr int kSteps = 15;

std::optional<Mesh> scan(const std::string& name) {
    const char* const folder = std::getenv("BELTRAMI_MESHES");
    const std::filesystem::path path = std::filesystem::path(folder ? folder : "") / name;
    if (!folder || !std::filesystem::exists(path)) return {};
    Mesh mesh = remove_unreferenced(read_mesh(path).mesh).mesh;
    mesh.texture.reset();
    return mesh;
}

struct Reshaped {
    std::string name, words;
    double azimuth, elevation;
    bool valence = false;  ///< reference by the paper's Algorithm 5, else regular faces
    bool area = true, normals = true;
    std::optional<double> features = {};
    bool slide_border = true;
    bool components = false;
    bool ours = true;
};

/// The source, the paper's maps with normals and areas preserved, and remeshing.
void add_maps(Output& output, Figure& figure, const Mesh& mesh, const Reshaped& wanted) {
    const Surface surface(mesh);
    const MeshTarget target(mesh);
    const Positions shapes = wanted.valence ? valence_shapes(mesh) : regular_shapes(mesh.faces);
    const CornerElements elements = corner_elements(mesh, shapes);
    SpaceFigure shown(output, figure, wanted.name, surface.mesh, elements, {wanted.azimuth, wanted.elevation, 0.6});
    const auto add = [&](const std::string& method, const Positions& positions, bool drawn) {
        shown.add(method, positions, normals_of(nearest_points(target, positions)), drawn);
    };
    add("start", mesh.positions, true);
    const std::vector<char> held = bench::on_curves(mesh, surface.topology, wanted.features);
    UniformOptions steps;
    steps.max_iterations = kSteps;
    for (const Preserve preserve : {Preserve::normals, Preserve::area}) {
        const bool normals = preserve == Preserve::normals;
        if (normals ? !wanted.normals : !wanted.area) continue;
        LeastSquaresMap problem(mesh, elements, mesh.positions, held, preserve);
        const UniformMap map = uniform_map(problem, mesh, steps);
        const std::string kept = normals ? ", normals" : ", area";
        add("least squares" + kept, map.first, !wanted.ours);
        add("QC iteration" + kept, map.map, true);
    }
    RemeshOptions options;
    options.feature_angle = wanted.features;
    options.slide_border = wanted.slide_border;
    for (const bool open : {false, true}) {
        options.open_angles = open;
        const RemeshedSurface result = remesh(surface, shapes, options);
        add(open ? "remesh, angles opened" : "remesh", result.positions, !open && wanted.ours);
    }
    shown.end_table(wanted.words);
    shown.end_picture(wanted.words + ": abs(μ) against the reference, its histogram and that of the angles.");
    if (wanted.components) shown.end_components(wanted.words + ": μ₁, the real axis horizontal.", false);
}

}  // namespace

Figure space_01(Output& output) {
    const std::optional<Mesh> mesh = scan("skull_g2.obj");
    if (!mesh) return {};
    Figure figure{"Figure 1: genus 2 in place of 4",
                  "The paper's maps with normals and with the area preserved, against equilateral triangles."};
    add_maps(output, figure, *mesh, {"space_01", "skull_g2, 10 312 triangles", 60, 10});
    return figure;
}

Figure space_05(Output& output) {
    const std::optional<Mesh> mesh = scan("hand_disk.obj");
    if (!mesh) return {};
    Figure figure{"Figure 5: an ideal structure of a simply connected surface embedded",
                  "The structure in which every face is equilateral, onto the surface itself with its own border: with "
                  "the normals preserved, as in the paper, and along the surface."};
    add_maps(
        output, figure, *mesh,
        {.name = "space_05", .words = "hand_disk, 1 602 triangles", .azimuth = 60, .elevation = 10, .area = false});
    return figure;
}

Figure space_10(Output& output) {
    const std::optional<Mesh> mesh = scan("torus.obj");
    if (!mesh) return {};
    Figure figure{
        "Figures 10 and 19: genus 1 with 19 holes",
        "A torus, its vertices moved at random by .3 of their shortest edge, with 19 holes. Its grid of right "
        "triangles is .268 away from equilateral ones, whatever vertices do."};
    add_maps(
        output, figure, bench::with_holes(bench::with_noise(*mesh, 0.3, {}), 19),
        {.name = "space_10", .words = "A torus with 19 holes", .azimuth = 30, .elevation = 35, .slide_border = false});
    return figure;
}

Figure space_17(Output& output) {
    const std::optional<Mesh> mesh = scan("hippocampus.obj");
    if (!mesh) return {};
    Figure figure{"Figure 17: equal angles, and those of Algorithm 5",
                  "The same mesh against equilateral triangles, and against angles by the valences of its vertices."};
    for (const bool valence : {false, true})
        add_maps(output, figure, *mesh,
                 {.name = valence ? "space_17_valence" : "space_17",
                  .words = valence ? "hippocampus, angles by valences" : "hippocampus, equal angles",
                  .azimuth = 60,
                  .elevation = 20,
                  .valence = valence});
    return figure;
}

Figure space_18(Output& output) {
    Figure figure{"Figure 18: sharp edges",
                  "A plate with two holes in place of the paper's statue, its vertices moved at random by .3 of their "
                  "shortest edge, against the angles of Algorithm 5. Its edges and corners are kept."};
    const double features = 40 * std::numbers::pi / 180;
    add_maps(output, figure, bench::with_noise(cad_part(0.08), 0.3, features),
             {.name = "space_18",
              .words = "A part with its edges kept",
              .azimuth = 40,
              .elevation = 35,
              .valence = true,
              .features = features});
    return figure;
}

Figure space_20(Output& output) {
    Figure figure{"Figure 20: a double torus with its area preserved",
                  "Least squares and the QC iteration against the angles of Algorithm 5."};
    add_maps(output, figure, double_torus(0.1),
             {.name = "space_20",
              .words = "A double torus",
              .azimuth = 30,
              .elevation = 60,
              .valence = true,
              .normals = false,
              .components = true,
              .ours = false});
    return figure;
}

}  // namespace beltrami::gallery
