#include "space_cases.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include <Eigen/Geometry>

#include <beltrami/mesh/submesh.h>

namespace beltrami::bench {

namespace {

template <class Keep>
Mesh part_of(const Mesh& mesh, Keep&& keep) {
    std::vector<int> kept;
    for (int f = 0; f < mesh.face_count(); ++f) {
        Eigen::Vector3d middle = Eigen::Vector3d::Zero();
        for (const int v : mesh.faces[f]) middle += mesh.point(v) / mesh.faces.degree(f);
        if (keep(middle)) kept.push_back(f);
    }
    return remove_unreferenced(keep_faces(mesh, kept).mesh).mesh;
}

}  // namespace

Handles rims(const Mesh& mesh, const std::function<double(double)>& lowered) {
    Handles handles;
    std::vector<Eigen::Vector3d> places;
    const Topology combinatorics = topology(mesh);
    for (const auto& loop : combinatorics.boundary_loops)
        for (const int v : loop) {
            Eigen::Vector3d p = mesh.point(v);
            if (p.z() > 1) p.z() -= lowered(std::atan2(p.y(), p.x()));
            handles.vertices.push_back(v);
            places.push_back(p);
        }
    handles.places.resize(static_cast<Eigen::Index>(places.size()), 3);
    for (std::size_t i = 0; i < places.size(); ++i) handles.places.row(static_cast<Eigen::Index>(i)) = places[i];
    return handles;
}

Handles arrow_head(const Mesh& square, double push) {
    Handles handles;
    for (const auto& loop : topology(square).boundary_loops)
        handles.vertices.insert(handles.vertices.end(), loop.begin(), loop.end());
    handles.places.resize(static_cast<Eigen::Index>(handles.vertices.size()), 3);
    for (std::size_t i = 0; i < handles.vertices.size(); ++i) {
        const Eigen::Vector3d p = square.point(handles.vertices[i]);
        const bool moves = p.x() > 1 - 1e-9 || p.y() > 1 - 1e-9;
        const double by = moves ? push * p.x() * p.y() : 0;
        handles.places.row(static_cast<Eigen::Index>(i)) << p.x() - by, p.y() - by, 0;
    }
    return handles;
}

Handles turned(const Mesh& mesh, double angle, double pull, double scale, bool alternating) {
    Handles handles;
    std::vector<Eigen::Vector3d> places;
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (int v = 0; v < mesh.vertex_count(); ++v) middle += mesh.point(v) / mesh.vertex_count();
    int number = 0;
    for (const auto& loop : topology(mesh).boundary_loops) {
        Eigen::Vector3d centre = Eigen::Vector3d::Zero(), axis = Eigen::Vector3d::Zero();
        for (const int v : loop) centre += mesh.point(v) / static_cast<double>(loop.size());
        for (std::size_t i = 0; i < loop.size(); ++i)
            axis += (mesh.point(loop[i]) - centre).cross(mesh.point(loop[(i + 1) % loop.size()]) - centre);
        axis.normalize();
        if (axis.dot(centre - middle) < 0) axis = -axis;
        const bool other = alternating && number++ % 2 == 1;
        const double sign = other ? -1 : 1;
        const Eigen::AngleAxisd turn(sign * angle, axis);
        for (const int v : loop) {
            handles.vertices.push_back(v);
            places.emplace_back(centre + (other ? 1 / scale : scale) * (turn * (mesh.point(v) - centre)) +
                                sign * pull * axis);
        }
    }
    handles.places.resize(static_cast<Eigen::Index>(places.size()), 3);
    for (std::size_t i = 0; i < places.size(); ++i) handles.places.row(static_cast<Eigen::Index>(i)) = places[i];
    return handles;
}

Mesh alternating_triangles(const Mesh& quads, int rows) {
    Mesh mesh;
    mesh.positions = quads.positions;
    for (int f = 0; f < quads.face_count(); ++f) {
        const auto v = quads.faces[f];
        const bool even = (f / rows + f % rows) % 2 == 0;
        mesh.faces.add(even ? std::array{v[0], v[1], v[2]} : std::array{v[0], v[1], v[3]});
        mesh.faces.add(even ? std::array{v[0], v[2], v[3]} : std::array{v[1], v[2], v[3]});
    }
    return mesh;
}

Mesh cylinder_to_lower(int fineness, Cells cells) {
    const int rows = 16 * fineness;
    Mesh quads = cylinder(1, 2, 48 * fineness, rows, Cells::quads);
    return cells == Cells::quads ? quads : alternating_triangles(quads, rows);
}

Mesh torus_with_hole() {
    constexpr int kAlong = 32;
    return part_of(alternating_triangles(torus(2, 1, 64, kAlong, Cells::quads), kAlong),
                   [](const Eigen::Vector3d& p) { return (p - Eigen::Vector3d(-3, 0, 0)).norm() > 0.85; });
}

Mesh sphere_with_holes() {
    return part_of(octahedral_sphere(5), [](const Eigen::Vector3d& p) { return p.cwiseAbs().maxCoeff() < 0.93; });
}

Mesh with_holes(const Mesh& mesh, int holes, int rings) {
    std::vector<int> seeds{0};
    Eigen::VectorXd away(mesh.vertex_count());
    for (int v = 0; v < mesh.vertex_count(); ++v) away[v] = (mesh.point(v) - mesh.point(0)).norm();
    while (static_cast<int>(seeds.size()) < holes) {
        Eigen::Index farthest = 0;
        away.maxCoeff(&farthest);
        seeds.push_back(static_cast<int>(farthest));
        for (int v = 0; v < mesh.vertex_count(); ++v)
            away[v] = std::min(away[v], (mesh.point(v) - mesh.point(seeds.back())).norm());
    }
    std::vector<char> vertex(static_cast<std::size_t>(mesh.vertex_count()), 0),
        face(static_cast<std::size_t>(mesh.face_count()), 0);
    for (const int v : seeds) vertex[v] = 1;
    for (int ring = 0; ring < rings; ++ring) {
        for (int f = 0; f < mesh.face_count(); ++f)
            for (const int v : mesh.faces[f])
                if (vertex[v]) face[f] = 1;
        for (int f = 0; f < mesh.face_count(); ++f)
            if (face[f])
                for (const int v : mesh.faces[f]) vertex[v] = 1;
    }
    std::vector<int> kept;
    for (int f = 0; f < mesh.face_count(); ++f)
        if (!face[f]) kept.push_back(f);
    return keep_faces(mesh, kept).mesh;
}

std::vector<char> on_curves(const Mesh& mesh, const Topology& combinatorics, std::optional<double> angle) {
    std::vector<char> held(static_cast<std::size_t>(mesh.vertex_count()), 0);
    const FeatureCurves features = feature_curves(mesh, combinatorics, angle);
    for (const int v : features.corners) held[v] = 1;
    for (const FeatureCurves::Curve& curve : features.curves)
        for (const int v : curve.vertices) held[v] = 1;
    return held;
}

Mesh with_noise(const Mesh& mesh, double amount, std::optional<double> features) {
    const MeshTarget target(mesh);
    const Topology combinatorics = topology(mesh);
    Eigen::VectorXd shortest = Eigen::VectorXd::Constant(mesh.vertex_count(), 1e300);
    for (const auto& [a, b] : combinatorics.edges) {
        const double length = (mesh.point(a) - mesh.point(b)).norm();
        shortest[a] = std::min(shortest[a], length);
        shortest[b] = std::min(shortest[b], length);
    }
    const std::vector<char> held = on_curves(mesh, combinatorics, features);
    std::mt19937 random(1);
    const auto uniform = [&] { return 2.0 * (static_cast<double>(random()) / 4294967296.0) - 1; };
    const Positions normals = vertex_normals(mesh);
    Mesh result = mesh;
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        const double x = amount * shortest[v] * uniform(), y = amount * shortest[v] * uniform();
        if (held[v]) continue;
        const Eigen::Vector3d normal = normals.row(v), u = normal.unitOrthogonal(), w = normal.cross(u);
        result.positions.row(v) = target.nearest(mesh.point(v) + x * u + y * w).position;
    }
    return result;
}

}  // namespace beltrami::bench
