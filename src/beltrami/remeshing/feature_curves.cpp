#include <beltrami/remeshing/feature_curves.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include <Eigen/Geometry>

namespace beltrami {

namespace {

constexpr double kCornerTurn = 50 * std::numbers::pi / 180;

using Neighbours = std::vector<std::vector<int>>;

/// Once.
void join(Neighbours& neighbours, int u, int v) {
    if (std::find(neighbours[u].begin(), neighbours[u].end(), v) != neighbours[u].end()) return;
    neighbours[u].push_back(v);
    neighbours[v].push_back(u);
}

/// Vertices joined by the edges that count.
Neighbours feature_edges(const Mesh& mesh, const Topology& topology, std::optional<double> angle,
                         std::span<const std::array<int, 2>> given) {
    Neighbours neighbours(static_cast<std::size_t>(mesh.vertex_count()));
    for (int e = 0; e < topology.edge_count(); ++e) {
        const auto [left, right] = topology.edge_faces[e];
        if (left >= 0 && right >= 0) {
            if (!angle) continue;
            const Eigen::Vector3d a = face_vector_area(mesh, left), b = face_vector_area(mesh, right);
            if (std::atan2(a.cross(b).norm(), a.dot(b)) <= *angle) continue;
        }
        const auto [u, v] = topology.edges[e];
        join(neighbours, u, v);
    }
    for (const auto& [u, v] : given) join(neighbours, u, v);
    return neighbours;
}

bool is_corner(const Mesh& mesh, const Neighbours& neighbours, int vertex) {
    const std::vector<int>& ends = neighbours[vertex];
    if (ends.empty()) return false;
    if (ends.size() != 2) return true;
    const Eigen::Vector3d u = mesh.point(vertex) - mesh.point(ends[0]), v = mesh.point(ends[1]) - mesh.point(vertex);
    return std::atan2(u.cross(v).norm(), u.dot(v)) > kCornerTurn;
}

/// The other neighbour of a vertex with two.
int next_of(const Neighbours& neighbours, int vertex, int from) {
    const std::vector<int>& ends = neighbours[vertex];
    return ends[0] == from ? ends[1] : ends[0];
}

}  // namespace

FeatureCurves feature_curves(const Mesh& mesh, const Topology& topology, std::optional<double> angle,
                             std::span<const std::array<int, 2>> given) {
    const Neighbours neighbours = feature_edges(mesh, topology, angle, given);
    FeatureCurves result;
    std::vector<char> corner(neighbours.size(), 0), seen(neighbours.size(), 0);
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        corner[v] = is_corner(mesh, neighbours, v);
        if (corner[v]) result.corners.push_back(v);
    }
    std::set<std::array<int, 2>> walked;  // directed edges at corners
    for (const int from : result.corners)
        for (const int first : neighbours[from]) {
            if (!walked.insert({from, first}).second) continue;
            std::vector<int> curve{from, first};
            while (!corner[curve.back()]) {
                seen[curve.back()] = 1;
                curve.push_back(next_of(neighbours, curve.back(), curve[curve.size() - 2]));
            }
            walked.insert({curve.back(), curve[curve.size() - 2]});
            result.curves.push_back({std::move(curve), false});
        }
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        if (corner[v] || seen[v] || neighbours[v].empty()) continue;
        std::vector<int> curve{v};
        seen[v] = 1;
        for (int last = v, at = neighbours[v][0]; at != v;) {
            curve.push_back(at);
            seen[at] = 1;
            const int next = next_of(neighbours, at, last);
            last = at;
            at = next;
        }
        result.curves.push_back({std::move(curve), true});
    }
    return result;
}

}  // namespace beltrami
