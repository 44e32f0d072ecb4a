#include <beltrami/unfold/sphere_tutte.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <vector>

#include <Eigen/Geometry>

#include <beltrami/base/error.h>
#include <beltrami/mesh/submesh.h>
#include <beltrami/sphere/centring.h>
#include <beltrami/sphere/unit_sphere.h>
#include <beltrami/unfold/convex_combination_map.h>

namespace beltrami {

std::optional<Positions> sphere_tutte(const Surface& source, int root, const Eigen::VectorXd& weights) {
    std::vector<int> others;
    for (int f = 0; f < source.mesh.face_count(); ++f)
        if (f != root) others.push_back(f);
    const Submesh part = keep_faces(source.mesh, others);
    std::vector<int> number(static_cast<std::size_t>(source.mesh.vertex_count()), -1);
    for (std::size_t v = 0; v < part.vertices.size(); ++v) number[part.vertices[v]] = static_cast<int>(v);

    // The root's corners run around clockwise in the plane, so that the faces lie on the left of the rim.
    const auto corners = source.mesh.faces[root];
    const int degree = static_cast<int>(corners.size());
    std::vector<Complex> polygon;
    if (degree == 3) {
        const Eigen::Vector3d a = source.mesh.point(corners[0]);
        const Eigen::Vector3d e = source.mesh.point(corners[1]) - a, f = source.mesh.point(corners[2]) - a;
        const double length = e.norm();
        polygon = {0.0, length, Complex(e.dot(f), -e.cross(f).norm()) / length};
    } else {
        for (int i = 0; i < degree; ++i) polygon.push_back(std::polar(1.0, -2 * std::numbers::pi * i / degree));
    }
    BoundaryCondition rim;
    for (int i = 0; i < degree; ++i) rim.pin(number[corners[i]], polygon[i]);
    try {
        const Surface open(part.mesh);
        const Eigen::VectorXcd plane = convex_combination_map(open, rim, ConvexWeights::uniform);
        Eigen::VectorXcd z = Eigen::VectorXcd::Zero(source.mesh.vertex_count());
        for (std::size_t v = 0; v < part.vertices.size(); ++v) z[part.vertices[v]] = plane[v];
        if (!z.allFinite()) return {};
        return centred(sphere_points(around_median(std::move(z), weights)), weights).points;
    } catch (const Error& error) {
        if (error.cause() != Cause::not_solved) throw;
        return {};
    }
}

std::vector<int> tutte_roots(const Surface& source, int count) {
    const FaceList& faces = source.mesh.faces;
    Eigen::Vector3d centroid = Eigen::Vector3d::Zero();
    for (const int v : faces.vertices()) centroid += source.mesh.point(v);
    centroid /= faces.corner_count();
    std::vector<double> distances, ratios;
    for (int f = 0; f < faces.size(); ++f) {
        const auto v = faces[f];
        Eigen::Vector3d middle = Eigen::Vector3d::Zero();
        double shortest = std::numeric_limits<double>::infinity(), longest = 0;
        for (std::size_t i = 0; i < v.size(); ++i) {
            middle += source.mesh.point(v[i]) / static_cast<double>(v.size());
            const double length = (source.mesh.point(v[(i + 1) % v.size()]) - source.mesh.point(v[i])).norm();
            shortest = std::min(shortest, length);
            longest = std::max(longest, length);
        }
        distances.push_back((middle - centroid).norm());
        ratios.push_back(longest / shortest);
    }
    const double farthest = *std::max_element(distances.begin(), distances.end());
    const auto cost = [&](int f) { return 3 * distances[f] / farthest + ratios[f]; };
    std::vector<int> order(static_cast<std::size_t>(faces.size()));
    std::iota(order.begin(), order.end(), 0);
    const auto chosen = std::min<std::size_t>(order.size(), static_cast<std::size_t>(count));
    std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(chosen), order.end(),
                      [&](int a, int b) { return cost(a) != cost(b) ? cost(a) < cost(b) : a < b; });
    order.resize(chosen);
    return order;
}

}  // namespace beltrami
