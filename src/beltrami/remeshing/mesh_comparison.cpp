#include <beltrami/remeshing/mesh_comparison.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include <beltrami/base/parallel.h>

namespace beltrami {

namespace {

constexpr double kDegrees = 180 / std::numbers::pi;
constexpr int kGrain = 256;

/// The value that a part of the sorted values stays below, linear in between.
double quantile(const std::vector<double>& sorted, double part) {
    const double place = part * static_cast<double>(sorted.size() - 1);
    const auto below = static_cast<std::size_t>(place), above = std::min(below + 1, sorted.size() - 1);
    return sorted[below] + (place - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

Eigen::Vector3d middle_of(const Mesh& mesh, int face) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const int v : mesh.faces[face]) sum += mesh.point(v);
    return sum / mesh.faces.degree(face);
}

/// Vertices in faces, middles of edges (once for each triangle) and of triangles.
std::vector<Eigen::Vector3d> sampled(const Mesh& mesh) {
    Positions positions(mesh.vertex_count(), 3);
    for (int v = 0; v < mesh.vertex_count(); ++v) positions.row(v) = mesh.point(v);
    std::vector<int> faces;
    const std::vector<std::array<int, 3>> triangles = as_triangles(mesh.faces, positions, faces);
    std::vector<Eigen::Vector3d> points;
    points.reserve(4 * triangles.size() + static_cast<std::size_t>(mesh.vertex_count()));
    std::vector<char> seen(static_cast<std::size_t>(mesh.vertex_count()), 0);
    for (const auto& v : triangles) {
        points.emplace_back((mesh.point(v[0]) + mesh.point(v[1]) + mesh.point(v[2])) / 3);
        for (std::size_t j = 0; j < 3; ++j) {
            points.emplace_back(0.5 * (mesh.point(v[j]) + mesh.point(v[(j + 1) % 3])));
            if (!seen[v[j]]) points.emplace_back(mesh.point(v[j]));
            seen[v[j]] = 1;
        }
    }
    return points;
}

SurfaceDistance one_sided(const std::vector<Eigen::Vector3d>& points, const MeshTarget& to) {
    std::vector<double> distance(points.size());
    parallel_for(
        0, static_cast<int>(points.size()),
        [&](int first, int last) {
            for (int i = first; i < last; ++i) distance[i] = (to.nearest(points[i]).position - points[i]).norm();
        },
        kGrain);
    SurfaceDistance result;
    for (const double d : distance) {
        result.largest = std::max(result.largest, d);
        result.mean += d / static_cast<double>(points.size());
    }
    return result;
}

}  // namespace

AngleStatistics angle_statistics(const Mesh& mesh) {
    AngleStatistics result;
    std::vector<double> angles, deviations;
    for (int f = 0; f < mesh.face_count(); ++f) {
        const auto v = mesh.faces[f];
        const std::size_t n = v.size();
        const double regular = 180.0 * (static_cast<double>(n) - 2) / static_cast<double>(n);
        for (std::size_t j = 0; j < n; ++j) {
            const Eigen::Vector3d a = mesh.point(v[(j + 1) % n]) - mesh.point(v[j]),
                                  b = mesh.point(v[(j + n - 1) % n]) - mesh.point(v[j]);
            angles.push_back(kDegrees * std::atan2(a.cross(b).norm(), a.dot(b)));
            deviations.push_back(std::abs(angles.back() - regular));
            ++result.histogram[std::min<std::size_t>(static_cast<std::size_t>(angles.back() / 10), 17)];
            result.mean_deviation += deviations.back();
        }
    }
    if (angles.empty()) return result;
    result.mean_deviation /= static_cast<double>(angles.size());
    std::sort(angles.begin(), angles.end());
    std::sort(deviations.begin(), deviations.end());
    result.smallest = angles.front();
    result.one_percent = quantile(angles, 0.01);
    result.largest = angles.back();
    result.median_deviation = quantile(deviations, 0.5);
    return result;
}

SurfaceDistance surface_distance(const MeshTarget& a, const MeshTarget& b) {
    const SurfaceDistance there = one_sided(sampled(*a.mesh()), b), back = one_sided(sampled(*b.mesh()), a);
    return {std::max(there.largest, back.largest), 0.5 * (there.mean + back.mean)};
}

std::vector<int> opposed_faces(const Mesh& mesh, const MeshTarget& surface, const Target::Points& points) {
    std::vector<char> opposed(static_cast<std::size_t>(mesh.face_count()), 0);
    parallel_for(
        0, mesh.face_count(),
        [&](int first, int last) {
            for (int f = first; f < last; ++f) {
                const Eigen::Vector3d middle = middle_of(mesh, f);
                const Target::Point there =
                    points.empty() ? surface.nearest(middle) : surface.retract(middle, points[mesh.faces[f][0]]);
                opposed[f] = !(face_vector_area(mesh, f).dot(there.normal) > 0);
            }
        },
        kGrain);
    std::vector<int> result;
    for (int f = 0; f < mesh.face_count(); ++f)
        if (opposed[f]) result.push_back(f);
    return result;
}

double surface_area(const Mesh& mesh) {
    double sum = 0;
    for (int f = 0; f < mesh.face_count(); ++f) sum += face_vector_area(mesh, f).norm();
    return sum;
}

double valence_floor(int m) {
    const double angle = 2 * std::numbers::pi / m, base = 2 * std::sin(angle / 2),
                 height = std::cos(angle / 2) / (std::sqrt(3.0) / 2);
    return std::abs(base - height) / (base + height);
}

}  // namespace beltrami
