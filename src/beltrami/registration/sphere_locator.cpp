#include <beltrami/registration/sphere_locator.h>

#include <algorithm>
#include <unordered_map>

#include <Eigen/Geometry>

#include <beltrami/base/parallel.h>
#include <beltrami/locate/point_at.h>

namespace beltrami {

namespace {

constexpr int kMostLocatorSteps = 500;
constexpr double kOutside = -1e-12;

std::vector<std::array<int, 3>> neighbours(const std::vector<std::array<int, 3>>& triangles) {
    std::unordered_map<std::int64_t, int> side;  // directed edge -> triangle
    const auto key = [](int a, int b) { return (static_cast<std::int64_t>(a) << 32) | static_cast<std::uint32_t>(b); };
    for (std::size_t t = 0; t < triangles.size(); ++t)
        for (int i = 0; i < 3; ++i) side[key(triangles[t][i], triangles[t][(i + 1) % 3])] = static_cast<int>(t);
    std::vector<std::array<int, 3>> across(triangles.size(), {-1, -1, -1});
    for (std::size_t t = 0; t < triangles.size(); ++t)
        for (int i = 0; i < 3; ++i)
            if (const auto it = side.find(key(triangles[t][(i + 2) % 3], triangles[t][(i + 1) % 3])); it != side.end())
                across[t][i] = it->second;
    return across;
}

}  // namespace

SphereLocator::SphereLocator(const FaceList& faces, const Positions& points)
    : points_(points),
      triangles_(as_triangles(faces, points, face_of_triangle_)),
      across_(neighbours(triangles_)),
      closed_(std::none_of(across_.begin(), across_.end(),
                           [](const auto& beyond) { return std::count(beyond.begin(), beyond.end(), -1) > 0; })),
      nearest_(points, triangles_) {}

std::array<double, 3> SphereLocator::weights(int triangle, const Eigen::Vector3d& point) const {
    std::array<Eigen::Vector3d, 3> from;  // differences keep the digits of what is near
    for (int i = 0; i < 3; ++i) from[i] = points_.row(triangles_[triangle][i]).transpose() - point;
    std::array<double, 3> result;
    double sum = 0;
    for (int i = 0; i < 3; ++i) sum += std::abs(result[i] = from[(i + 1) % 3].cross(from[(i + 2) % 3]).dot(point));
    for (double& weight : result) weight = sum > 0 ? weight / sum : 1.0 / 3;
    return result;
}

/// Across the edge beyond which the point lies farthest, until it is inside.
int SphereLocator::walk(int triangle, const Eigen::Vector3d& point) const {
    int best = triangle;
    double most = -2;
    for (int step = 0; step < kMostLocatorSteps && triangle >= 0; ++step) {
        const std::array<double, 3> w = weights(triangle, point);
        const int lowest = static_cast<int>(std::min_element(w.begin(), w.end()) - w.begin());
        if (w[lowest] > most) most = w[lowest], best = triangle;
        if (w[lowest] >= kOutside) return triangle;
        triangle = across_[triangle][lowest];
    }
    return best;
}

MeshPoint SphereLocator::locate(const Eigen::Vector3d& point) const {
    if (closed_) return place_in(triangle_at(point), point);
    // In the plane the nearest triangle of those in space is the one that contains the point, if there is one.
    const SurfaceLocator::Place near = nearest_.nearest(point);
    return {face_of_triangle_[near.triangle], triangles_[near.triangle], near.barycentric};
}

MeshPoint SphereLocator::place_in(int triangle, const Eigen::Vector3d& point) const {
    std::array<double, 3> w = weights(triangle, point);
    double sum = 0;
    for (double& weight : w) sum += weight = std::max(weight, 0.0);
    for (double& weight : w) weight /= sum;
    return {face_of_triangle_[triangle], triangles_[triangle], w};
}

std::vector<MeshPoint> SphereLocator::locate(const Positions& points) const {
    std::vector<MeshPoint> places(static_cast<std::size_t>(points.rows()));
    parallel_for(0, static_cast<int>(points.rows()), [&](int first, int last) {
        for (int i = first; i < last; ++i) places[i] = locate(Eigen::Vector3d(points.row(i)));
    });
    return places;
}

Eigen::Vector3d sphere_place(const Positions& points, const MeshPoint& place) {
    return point_at(points, place).normalized();
}

}  // namespace beltrami
