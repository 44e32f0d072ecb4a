// Closed surfaces on the sphere: scans of the folder BELTRAMI_MESHES, if it is there, and shapes made here.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>

#include <beltrami/mesh/submesh.h>
#include <beltrami/meshing/face_split.h>
#include <beltrami/unfold/sphere_faces.h>

#include "gallery/sliding.h"

namespace beltrami::gallery {

namespace {

/// A turned part with sharp edges, flange, shaft, groove and cone, in quads.
Mesh turned_part(int sides) {
    const std::vector<std::array<double, 2>> outline{{0, 3},     {0.5, 3},   {0.5, 1.6}, {0.35, 1.5}, {0.35, 1.2},
                                                     {0.6, 1.2}, {0.6, 0.4}, {1.5, 0.4}, {1.5, 0},    {0, -0.8}};
    std::vector<std::array<double, 2>> rings;
    const double step = 2 * std::numbers::pi / sides;
    for (std::size_t i = 0; i + 1 < outline.size(); ++i) {
        const auto [r0, z0] = outline[i];
        const auto [r1, z1] = outline[i + 1];
        const int pieces = std::max(1, static_cast<int>(std::lround(std::hypot(r1 - r0, z1 - z0) / step)));
        for (int k = i == 0 ? 1 : 0; k < pieces; ++k) {
            const double t = static_cast<double>(k) / pieces;
            rings.push_back({std::lerp(r0, r1, t), std::lerp(z0, z1, t)});
        }
    }
    Mesh mesh;
    const int count = static_cast<int>(rings.size());
    mesh.positions.resize(count * sides + 2, 3);
    for (int r = 0; r < count; ++r)
        for (int s = 0; s < sides; ++s)
            mesh.positions.row(r * sides + s) << rings[r][0] * std::cos(s * step), rings[r][0] * std::sin(s * step),
                rings[r][1];
    const int top = count * sides, bottom = top + 1;
    mesh.positions.row(top) << 0, 0, outline.front()[1];
    mesh.positions.row(bottom) << 0, 0, outline.back()[1];
    for (int s = 0; s < sides; ++s) {
        const int next = (s + 1) % sides;
        mesh.faces.add({top, s, next});
        for (int r = 0; r + 1 < count; ++r)
            mesh.faces.add({r * sides + s, (r + 1) * sides + s, (r + 1) * sides + next, r * sides + next});
        mesh.faces.add({bottom, (count - 1) * sides + next, (count - 1) * sides + s});
    }
    return mesh;
}

struct View {
    const char* name;  ///< file or shape
    double azimuth, elevation;
};

double seconds_now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void add_sphere(Output& output, Figure& figure, Table& table, const std::string& name, Mesh whole, const View& view) {
    Mesh mesh = split_unusable_faces(remove_unreferenced(whole).mesh).mesh;
    const Surface surface(std::move(mesh));
    const double start = seconds_now();
    const SphereMap map = sphere_map(surface);
    const double seconds = seconds_now() - start;
    const Distortion& d = map.distortion;
    table.rows.push_back({name, std::to_string(surface.mesh.face_count()), std::to_string(map.iterations),
                          to_string(map.route), std::to_string(map.moved), number(d.mean), number(d.standard_deviation),
                          number(d.p99, 3), number(d.max),
                          std::to_string(SphereFaces(surface).flipped(map.positions).size()), number(seconds, 2)});
    const Eigen::VectorXcd nowhere = Eigen::VectorXcd::Zero(surface.mesh.vertex_count());
    Mesh image = surface.mesh;
    image.positions = map.positions;
    image.texture.reset();
    const std::string from = output.write("sphere_" + name, surface.mesh, nowhere, d.face_abs_mu);
    const std::string to = output.write("sphere_" + name + "_image", image, nowhere, d.face_abs_mu);
    const double shown = std::clamp(4 * d.mean, 0.05, 1.0);
    Picture picture{"sphere_" + name, name + " and its place on the sphere.", {}};
    picture.panels.push_back(surface_panel(from, "|μ|", "mu", view.azimuth, view.elevation, 1, shown));
    picture.panels.push_back(surface_panel(to, "on the sphere", "mu", view.azimuth, view.elevation, 1, shown));
    picture.panels.push_back(surface_panel(to, "faces", "faces", view.azimuth, view.elevation));
    picture.panels.push_back(histogram_panel({{"", from}}, "", {}, shown));
    figure.pictures.push_back(std::move(picture));
}

}  // namespace

Figure spheres(Output& output) {
    Figure figure{
        "Closed surfaces on the sphere",
        "Discrete uniformization with an ideal vertex ([maps to the sphere](sphere.md)): |μ| from the faces to "
        "the flat faces between their images."};
    Table table{"Flips are counted on the sphere, by the orientation of geodesic triangles",
                {"mesh", "faces", "Newton steps", "route", "moved vertices", "mean abs(μ)", "std", "p99", "max",
                 "flips", "seconds"},
                {}};
    for (const View& view : {View{"hippocampus.obj", 30, 20},
                             {"hand_closed.obj", -90, 70},
                             {"fish_quad.obj", 60, 20},
                             {"cow.off", -75, 70},
                             {"spot_control_mesh.obj", -60, 60}})
        if (const auto path = scan_path(view.name))
            add_sphere(output, figure, table, path->stem().string(), read_mesh(*path).mesh, view);
    if (const std::filesystem::path bunny = "out/bunny_closed.obj"; std::filesystem::exists(bunny))
        add_sphere(output, figure, table, "bunny_closed", read_mesh(bunny).mesh, {"", -80, 65});
    add_sphere(output, figure, table, "turned_part", turned_part(64), {"", 30, 25});
    figure.tables.push_back(std::move(table));
    return figure;
}

}  // namespace beltrami::gallery
