// Registration of closed surfaces: extremal maps of the sphere with landmarks against closed forms, and scans of the
// folder BELTRAMI_MESHES with landmarks of the folder "cases" beside it, if they are there.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include <beltrami/io/number_lists.h>
#include <beltrami/io/write_mesh.h>
#include <beltrami/locate/point_at.h>
#include <beltrami/mesh/submesh.h>
#include <beltrami/mesh/texture_map.h>
#include <beltrami/meshing/face_split.h>
#include <beltrami/registration/overlay.h>
#include <beltrami/registration/register_spheres.h>
#include <beltrami/registration/transferred_polyline.h>

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

/// Two scans with their landmarks.
struct LoadedPair {
    std::string from, to;
    Surface source, target;
    std::vector<SurfaceLandmark> landmarks;
};

/// Nothing without the files.
std::optional<LoadedPair> load(const Pair& files) {
    const auto from = scan_path(files.source), to = scan_path(files.target);
    if (!from || !to) return {};
    const std::filesystem::path list = from->parent_path().parent_path() / "cases" / files.landmarks;
    if (!std::filesystem::exists(list)) return {};
    LoadedPair pair{from->stem().string(), to->stem().string(), surface_of(*from), surface_of(*to), {}};
    for (const auto& row : read_rows(list.string(), 2, "a landmark"))
        pair.landmarks.push_back(
            {static_cast<int>(row[0]), place_of_vertex(pair.target.mesh, static_cast<int>(row[1]))});
    return pair;
}

void add_pair(Output& output, Figure& figure, Table& table, const Pair& files) {
    const std::optional<LoadedPair> pair = load(files);
    if (!pair) return;
    const auto& [from, to, source, target, landmarks] = *pair;
    const SphereRegistration found = register_spheres(source, target, landmarks);
    const Distortion& d = found.map.distortion;
    table.rows.push_back({from, to, std::to_string(landmarks.size()), std::to_string(source.mesh.face_count()),
                          number(found.map.k), number(*found.inverse_k), number(found.map.K_lower), number(found.map.K),
                          number(found.map.weighted_deviation), number(d.max, 3), std::to_string(d.flipped.size()),
                          std::to_string(found.in_space.flipped.size()), std::to_string(found.unresolved.size()),
                          std::to_string(found.map.iterations)});
    const std::string name = "register_" + from + "_" + std::to_string(landmarks.size());
    const Eigen::VectorXcd nowhere = Eigen::VectorXcd::Zero(source.mesh.vertex_count());
    Mesh image = source.mesh;
    image.positions = found.positions;
    image.texture.reset();
    const std::string before = output.write(name, source.mesh, nowhere, d.face_abs_mu),
                      after = output.write(name + "_image", image, nowhere, d.face_abs_mu);
    const double shown = std::clamp(3 * found.map.k, 0.05, 1.0);
    const auto marked = stars(source.mesh, landmarks);
    Picture picture{name,
                    from + " carried onto " + to + " with " + std::to_string(landmarks.size()) +
                        " landmarks (the edges at them are drawn).",
                    {}};
    picture.panels.push_back(surface_panel(before, from, "mu", files.azimuth, files.elevation, 1, shown, marked));
    picture.panels.push_back(surface_panel(after, "its faces on " + to, "mu", files.target_azimuth,
                                           files.target_elevation, 1, shown, marked));
    picture.panels.push_back(histogram_panel({{"", before}}, "", {}, shown));
    figure.pictures.push_back(std::move(picture));
}

/// The way from point to point, and its ends beside.
double length_of(const Mesh& mesh, const std::vector<MeshPoint>& places) {
    double sum = 0;
    for (std::size_t i = 1; i < places.size(); ++i)
        sum += (point_at(mesh, places[i]) - point_at(mesh, places[i - 1])).norm();
    return sum;
}

/// The largest distance in space of places from others, one by one.
double farthest(const Mesh& mesh, const std::vector<MeshPoint>& a, const std::vector<MeshPoint>& b) {
    double largest = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        largest = std::max(largest, (point_at(mesh, a[i]) - point_at(mesh, b[i])).norm());
    return largest;
}

/// Writes a surface with a texture for its plane, and a line on it.
/// @return its panel
nlohmann::json textured_panel(Output& output, const std::string& name, const std::string& title, const Mesh& mesh,
                              const TextureCoordinates& texture, const std::vector<MeshPoint>& line, double azimuth,
                              double elevation) {
    Mesh cut = cut_along_seams(mesh, texture);
    const Eigen::Index n = cut.positions.rows(), more = static_cast<Eigen::Index>(line.size());
    cut.positions.conservativeResize(n + more, 3);
    cut.positions.bottomRows(more) = points_at(mesh, line);
    Eigen::VectorXcd plane(n + more);
    for (Eigen::Index v = 0; v < n; ++v) plane[v] = {texture.points(v, 0), texture.points(v, 1)};
    plane.tail(more).setConstant(plane[0]);
    std::vector<int> chain(line.size());
    std::iota(chain.begin(), chain.end(), static_cast<int>(n));
    return surface_panel(output.write(name, cut, plane, Eigen::VectorXd::Zero(mesh.face_count())), title, "checker",
                         azimuth, elevation, 30, 1, {chain});
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

Figure transfers(Output& output) {
    Figure figure{"Transfer",
                  "What belongs to one surface, on the other, along a registration ([transfer](register.md)): a "
                  "texture, a closed polyline of geodesics, points and values of faces."};
    const Pair files{"hand_closed.obj", "hippocampus.obj", "landmarks_hand_closed_hippocampus_8.txt", -90, 70, 30, 20};
    const std::optional<LoadedPair> pair = load(files);
    if (!pair) return {};
    Mesh source = pair->source.mesh;
    const Mesh& target = pair->target.mesh;
    source.texture = texture_of_map(source, source.positions.leftCols(2));
    const SphereRegistration found = register_spheres(pair->source, pair->target, pair->landmarks);
    const SurfaceCorrespondence map(source, target, found.target_sphere.positions, found.places);

    // Through five of the landmarks, and back to the first.
    std::vector<MeshPoint> corners;
    for (const int i : {0, 1, 2, 3, 4, 0})
        corners.push_back(place_of_vertex(source, pair->landmarks[static_cast<std::size_t>(i)].vertex));
    const TransferredPolyline line = transferred_polyline(map, corners);
    const std::vector<MeshPoint> on_source = map.back(line.places);
    const TransferredPolyline returned = transferred_polyline(map, line.places, TransferWay::to_source);

    Table table{pair->from + " and " + pair->to +
                    ", with the map of the table above. Distances as parts of the diagonal of the surface on which "
                    "they are",
                {"what", "there", "and back"},
                {}};
    const auto diagonal = [](const Mesh& mesh) {
        return (mesh.positions.colwise().maxCoeff() - mesh.positions.colwise().minCoeff()).norm();
    };
    std::vector<MeshPoint> middles;
    for (int f = 0; f < source.face_count(); ++f) {
        const auto face = source.faces[f];
        middles.push_back({f, {face[0], face[1], face[2]}, {1 / 3., 1 / 3., 1 / 3.}});
    }
    table.rows.push_back(
        {"middles of all faces", std::to_string(middles.size()) + " points",
         "off by at most " + scientific(farthest(source, map.back(map.forward(middles)), middles) / diagonal(source))});
    table.rows.push_back({"polyline of " + std::to_string(corners.size()) + " points, " +
                              number(length_of(source, on_source) / diagonal(source), 3) + " long",
                          std::to_string(line.places.size()) + " points, " +
                              number(length_of(target, line.places) / diagonal(target), 3) + " long",
                          std::to_string(returned.places.size()) + " points, " +
                              number(length_of(source, returned.places) / diagonal(source), 3) + " long"});
    // What a unit of area of the source becomes: its sum is the source's area.
    Positions density(target.face_count(), 1);
    const Overlay both = overlay(map);
    density.setZero();
    double area = 0;
    for (int f = 0; f < source.face_count(); ++f) area += face_vector_area(source, f).norm();
    for (const Overlay::Piece& piece : both.pieces)
        density(piece.target_face, 0) += piece.part_of_source * face_vector_area(source, piece.source_face).norm();
    const Positions back =
        transferred_face_values(map, Positions::Ones(target.face_count(), 1), TransferWay::to_source);
    table.rows.push_back({"areas of faces, by " + std::to_string(both.pieces.size()) + " pieces of the overlay",
                          "their sum is off by " + scientific(std::abs(density.sum() / area - 1)),
                          "of values 1 by " + scientific((back.array() - 1).abs().maxCoeff())});
    figure.tables.push_back(std::move(table));

    Picture picture{"transfer_hand_closed",
                    "A checkerboard on " + pair->from +
                        ", as seen from above, and a closed polyline through five of "
                        "the landmarks; both on " +
                        pair->to + ".",
                    {}};
    picture.panels.push_back(textured_panel(output, "transfer_from", pair->from, source, *source.texture, on_source,
                                            files.azimuth, files.elevation));
    picture.panels.push_back(textured_panel(output, "transfer_to", "on " + pair->to, target, transferred_texture(map),
                                            line.places, files.target_azimuth, files.target_elevation));
    figure.pictures.push_back(std::move(picture));
    return figure;
}

}  // namespace beltrami::gallery
