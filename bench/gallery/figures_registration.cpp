// Registration of closed surfaces: extremal maps of the sphere with landmarks against closed forms, and scans of the
// folder BELTRAMI_MESHES with landmarks of the folder "cases" beside it, if they are there.
#include <algorithm>
#include <cmath>

#include <beltrami/io/number_lists.h>
#include <beltrami/mesh/submesh.h>
#include <beltrami/meshing/face_split.h>
#include <beltrami/registration/register_spheres.h>

#include "gallery/sliding.h"
#include "problems/noisy_copy.h"
#include "problems/sphere_landmarks.h"

namespace beltrami::gallery {

namespace {

/// Levels of the subdivided octahedron: 2048, 8192 and 32 768 faces.
constexpr int kLevels[] = {4, 5, 6};

Table oracles() {
    Table table{"Maps of the sphere that take four or eight points to others, against elliptic integrals and symmetry",
                {"landmarks", "faces", "exact k", "error of k", "std weighted by abs(φ)", "flips", "steps"},
                {}};
    const auto add = [&](const std::string& landmarks, const bench::SphereLandmarks& problem) {
        const Surface surface(problem.mesh);
        const ExtremalSphereMap map = extremal_sphere_map(surface, problem.mesh.positions, problem.landmarks);
        table.rows.push_back({landmarks, std::to_string(problem.mesh.face_count()), number(problem.exact_k, 5),
                              scientific(map.k - problem.exact_k), number(map.weighted_deviation),
                              std::to_string(map.distortion.flipped.size()), std::to_string(map.iterations)});
    };
    const std::vector<std::array<bench::TwoRings, 2>> eights{
        {{{.6, 1.5, .3}, {.7, 1.3, .55}}}, {{{.6, 1.5, .3}, {.8, 1.2, .9}}}, {{{.6, 1.5, .2}, {.9, 1.1, 1.0}}}};
    for (const double amplitude : {1.0, 2.0, 4.0})
        for (const int level : kLevels) add("4", bench::four_landmarks(level, amplitude));
    for (const auto& [from, to] : eights)
        for (const int level : kLevels) add("8", bench::eight_landmarks(level, from, to));
    return table;
}

struct Pair {
    const char *source, *target, *landmarks;  ///< files
    double azimuth, elevation;                ///< from which the source is seen …
    double target_azimuth, target_elevation;  ///< … and the target
};

Surface surface_of(const std::filesystem::path& path) {
    return Surface(split_unusable_faces(remove_unreferenced(read_mesh(path).mesh).mesh).mesh);
}

/// The edges at some vertices, which shows where these are.
std::vector<std::vector<int>> stars(const Mesh& mesh, const std::vector<SurfaceLandmark>& landmarks) {
    std::vector<std::vector<int>> result;
    for (const SurfaceLandmark& landmark : landmarks)
        for (int f = 0; f < mesh.face_count(); ++f) {
            const auto corners = mesh.faces[f];
            for (std::size_t c = 0; c < corners.size(); ++c)
                if (corners[c] == landmark.vertex)
                    result.push_back({landmark.vertex, corners[(c + 1) % corners.size()]});
        }
    return result;
}

void add_pair(Output& output, Figure& figure, Table& table, const Pair& files) {
    const auto from = scan_path(files.source), to = scan_path(files.target);
    if (!from || !to) return;
    const std::filesystem::path list = from->parent_path().parent_path() / "cases" / files.landmarks;
    if (!std::filesystem::exists(list)) return;
    const Surface source = surface_of(*from), target = surface_of(*to);
    std::vector<SurfaceLandmark> landmarks;
    for (const auto& row : read_rows(list.string(), 2, "a landmark"))
        landmarks.push_back({static_cast<int>(row[0]), place_of_vertex(target.mesh, static_cast<int>(row[1]))});
    const SphereRegistration found = register_spheres(source, target, landmarks);
    const Distortion& d = found.map.distortion;
    table.rows.push_back({from->stem().string(), to->stem().string(), std::to_string(landmarks.size()),
                          std::to_string(source.mesh.face_count()), number(found.map.k), number(*found.inverse_k),
                          number(found.map.K_lower), number(found.map.K), number(found.map.weighted_deviation),
                          number(d.max, 3), std::to_string(d.flipped.size()),
                          std::to_string(found.in_space.flipped.size()), std::to_string(found.unresolved.size()),
                          std::to_string(found.map.iterations)});
    const std::string name = "register_" + from->stem().string() + "_" + std::to_string(landmarks.size());
    const Eigen::VectorXcd nowhere = Eigen::VectorXcd::Zero(source.mesh.vertex_count());
    Mesh image = source.mesh;
    image.positions = found.positions;
    image.texture.reset();
    const std::string before = output.write(name, source.mesh, nowhere, d.face_abs_mu),
                      after = output.write(name + "_image", image, nowhere, d.face_abs_mu);
    const double shown = std::clamp(3 * found.map.k, 0.05, 1.0);
    const auto marked = stars(source.mesh, landmarks);
    Picture picture{name,
                    from->stem().string() + " carried onto " + to->stem().string() + " with " +
                        std::to_string(landmarks.size()) + " landmarks (the edges at them are drawn).",
                    {}};
    picture.panels.push_back(
        surface_panel(before, from->stem().string(), "mu", files.azimuth, files.elevation, 1, shown, marked));
    picture.panels.push_back(surface_panel(after, "its faces on " + to->stem().string(), "mu", files.target_azimuth,
                                           files.target_elevation, 1, shown, marked));
    picture.panels.push_back(histogram_panel({{"", before}}, "", {}, shown));
    figure.pictures.push_back(std::move(picture));
}

/// A scan with a boundary onto its own noisy copy, by landmarks that are met and by softer and softer ones.
void add_noisy_copy(Output& output, Figure& figure, const char* file, double azimuth, double elevation) {
    const auto path = scan_path(file);
    if (!path) return;
    const Surface source = surface_of(*path);
    const std::string name = path->stem().string();
    Table table{
        name + " (" + std::to_string(source.mesh.face_count()) + " faces, " +
            std::to_string(source.topology.boundary_loops.size()) +
            " boundary loops, which slide) onto a copy with noise of a tenth of an edge; six landmarks inside "
            "whose places are off by two edges, met and soft. Distances in mean edges",
        {"weight", "k", "k of the inverse", "K_lower (estimate)", "K", "largest distance", "flips", "flips in space"},
        {}};
    for (const double weight : {std::numeric_limits<double>::infinity(), 1e4, 1e2, 1.0}) {
        const bench::NoisyCopy copy = bench::noisy_copy(source, {.weight = weight});
        const Surface target(copy.mesh);
        const OpenRegistration found = register_open(source, target, copy.landmarks);
        const bool met = std::isinf(weight);
        table.rows.push_back(
            {met ? "met" : number(weight, 0), number(found.map.k), found.inverse_k ? number(*found.inverse_k) : "",
             number(found.map.K_lower), number(found.map.K), number(found.largest_distance.value_or(0) / copy.edge, 3),
             std::to_string(found.map.distortion.flipped.size()), std::to_string(found.in_space.flipped.size())});
        if (!met && weight != 1e2) continue;
        const std::string label = "register_" + name + (met ? "_met" : "_soft");
        Mesh image = source.mesh;
        image.positions = found.positions;
        image.texture.reset();
        const std::string after = output.write(label, image, Eigen::VectorXcd::Zero(source.mesh.vertex_count()),
                                               found.map.distortion.face_abs_mu);
        const double shown = std::clamp(6 * found.map.k, 0.05, 1.0);
        Picture picture{label,
                        name + " on its noisy copy, six landmarks inside " +
                            (met ? std::string("met") : "of weight " + number(weight, 0)) +
                            " (the edges at them are drawn).",
                        {}};
        picture.panels.push_back(
            surface_panel(after, "|μ|", "mu", azimuth, elevation, 1, shown, stars(source.mesh, copy.landmarks)));
        picture.panels.push_back(histogram_panel({{"", after}}, "", {}, shown));
        figure.pictures.push_back(std::move(picture));
    }
    figure.tables.push_back(std::move(table));
}

}  // namespace

Figure registrations(Output& output) {
    Figure figure{
        "Registration with landmarks",
        "Extremal maps between surfaces that take landmarks to their places, by way of the sphere or of a circle "
        "domain ([registration](register.md)). Fingers lie inside a few faces of the fish, which straight cut them "
        "off: the map "
        "itself covers them."};
    figure.tables.push_back(oracles());
    Table table{
        "Scans; k of the inverse is found with differentials of the other surface. Flips are counted on the "
        "sphere, and for straight faces in space",
        {"from", "onto", "landmarks", "faces", "k", "k of the inverse", "K_lower (estimate)", "K",
         "std weighted by abs(φ)", "max abs(μ)", "flips", "flips in space", "unresolved", "steps"},
        {}};
    for (const Pair& pair :
         {Pair{"hand_closed.obj", "hippocampus.obj", "landmarks_hand_closed_hippocampus_8.txt", -90, 70, 30, 20},
          Pair{"fish_quad.obj", "hand_closed.obj", "landmarks_fish_quad_hand_closed_8.txt", 60, 20, -90, 70},
          Pair{"fish_quad.obj", "hand_closed.obj", "landmarks_fish_quad_hand_closed_20.txt", 60, 20, -90, 70}})
        add_pair(output, figure, table, pair);
    figure.tables.push_back(std::move(table));
    add_noisy_copy(output, figure, "alex_3.obj", 90, 0);
    return figure;
}

}  // namespace beltrami::gallery
