#include <beltrami/meshing/quality.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <beltrami/mesh/topology.h>

namespace beltrami {

MeshQuality quality(const Mesh& mesh) {
    const Topology topo = topology(mesh);
    MeshQuality result;
    result.face_count = mesh.face_count();
    if (mesh.face_count() == 0) return result;
    result.min_angle = std::numbers::pi;
    result.min_edge = std::numeric_limits<double>::infinity();
    for (const auto& [a, b] : topo.edges) {
        const double length = (mesh.point(a) - mesh.point(b)).norm();
        result.min_edge = std::min(result.min_edge, length);
        result.max_edge = std::max(result.max_edge, length);
        result.mean_edge += length / topo.edge_count();
    }
    for (int face = 0; face < mesh.face_count(); ++face) {
        const std::span<const int> corners = mesh.faces[face];
        const std::size_t n = corners.size();
        double smallest = std::numbers::pi, shortest = std::numeric_limits<double>::infinity(), longest = 0.0;
        bool ear = true;
        for (std::size_t i = 0; i < n; ++i) {
            const Eigen::Vector3d p = mesh.point(corners[i]);
            const Eigen::Vector3d a = mesh.point(corners[(i + 1) % n]) - p,
                                  b = mesh.point(corners[(i + n - 1) % n]) - p;
            const double angle = std::atan2(a.cross(b).norm(), a.dot(b));
            smallest = std::min(smallest, angle);
            result.max_angle = std::max(result.max_angle, angle);
            shortest = std::min(shortest, a.norm());
            longest = std::max(longest, a.norm());
            ear = ear && topo.on_boundary[corners[i]];
        }
        result.min_angle = std::min(result.min_angle, smallest);
        result.mean_min_angle += smallest / mesh.face_count();
        result.max_aspect = std::max(result.max_aspect, longest / shortest);
        result.ears += ear ? 1 : 0;
    }
    return result;
}

}  // namespace beltrami
