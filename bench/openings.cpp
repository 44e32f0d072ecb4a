#include "openings.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <queue>
#include <utility>
#include <vector>

#include <beltrami/mesh/cut.h>
#include <beltrami/mesh/submesh.h>
#include <beltrami/mesh/topology.h>

namespace beltrami::bench {

namespace {

Eigen::Vector3d longest_axis(const Positions& positions) {
    const Eigen::RowVector3d mean = positions.colwise().mean();
    const Eigen::MatrixXd from_mean = positions.rowwise() - mean;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(from_mean.transpose() * from_mean);
    return axes.eigenvectors().col(2);
}

double boundary_length(const Mesh& mesh) {
    double length = 0;
    for (const auto& loop : topology(mesh).boundary_loops)
        for (std::size_t i = 0; i < loop.size(); ++i)
            length += (mesh.positions.row(loop[(i + 1) % loop.size()]) - mesh.positions.row(loop[i])).norm();
    return length;
}

/// Distances along edges from a vertex, and the vertex before each on its way.
struct Distances {
    std::vector<double> distance;
    std::vector<int> before;
};
Distances distances_from(const Mesh& mesh, int start) {
    std::vector<std::vector<int>> neighbours(mesh.vertex_count());
    for (int f = 0; f < mesh.face_count(); ++f) {
        const auto v = mesh.faces[f];
        for (std::size_t i = 0; i < v.size(); ++i) neighbours[v[i]].push_back(v[(i + 1) % v.size()]);
    }
    Distances result{std::vector<double>(mesh.vertex_count(), std::numeric_limits<double>::infinity()),
                     std::vector<int>(mesh.vertex_count(), -1)};
    std::priority_queue<std::pair<double, int>, std::vector<std::pair<double, int>>, std::greater<>> waiting;
    result.distance[start] = 0;
    waiting.emplace(0, start);
    while (!waiting.empty()) {
        const auto [distance, v] = waiting.top();
        waiting.pop();
        if (distance > result.distance[v]) continue;
        for (const int w : neighbours[v]) {
            const double further = distance + (mesh.positions.row(w) - mesh.positions.row(v)).norm();
            if (further >= result.distance[w]) continue;
            result.distance[w] = further;
            result.before[w] = v;
            waiting.emplace(further, w);
        }
    }
    return result;
}

int farthest(const Distances& from) {
    int best = -1;
    for (std::size_t v = 0; v < from.distance.size(); ++v)
        if (std::isfinite(from.distance[v]) && (best < 0 || from.distance[v] > from.distance[best]))
            best = static_cast<int>(v);
    return best;
}

}  // namespace

Mesh opened_by_plane(const Mesh& closed, double part) {
    Mesh best;
    std::size_t fewest = std::numeric_limits<std::size_t>::max();
    for (const double factor : {1.0, 0.5, 0.25, 2.0, 3.0}) {
        double shortest = std::numeric_limits<double>::infinity();
        for (const double side : {1.0, -1.0}) {
            const Eigen::Vector3d axis = side * longest_axis(closed.positions);
            std::vector<double> heights;
            for (Eigen::Index v = 0; v < closed.positions.rows(); ++v)
                heights.push_back(closed.positions.row(v).dot(axis));
            std::sort(heights.begin(), heights.end());
            const double at = heights[static_cast<std::size_t>(factor * part * static_cast<double>(heights.size()))];
            Mesh open = remove_unreferenced(largest_component(cut_by_plane(closed, {axis, at}).mesh).mesh).mesh;
            const std::size_t loops = topology(open).boundary_loops.size();
            const double length = boundary_length(open);
            if (loops == 0 || loops > fewest || (loops == fewest && !(length < shortest))) continue;
            fewest = loops;
            shortest = length;
            best = std::move(open);
        }
        if (fewest == 1) break;
    }
    return best;
}

Mesh opened_by_seam(const Mesh& closed) {
    const int from = farthest(distances_from(closed, closed.faces[0][0]));
    const Distances ways = distances_from(closed, from);
    std::vector<int> path{farthest(ways)};
    while (path.back() != from) path.push_back(ways.before[path.back()]);

    std::map<std::pair<int, int>, int> face_at;  // left of a half-edge
    for (int f = 0; f < closed.face_count(); ++f)
        for (std::size_t i = 0; i < 3; ++i) face_at[{closed.faces[f][i], closed.faces[f][(i + 1) % 3]}] = f;
    std::vector<std::vector<int>> faces(closed.face_count());
    for (int f = 0; f < closed.face_count(); ++f) faces[f].assign(closed.faces[f].begin(), closed.faces[f].end());
    Mesh open;
    const Eigen::Index count = closed.positions.rows(), added = static_cast<Eigen::Index>(path.size()) - 2;
    open.positions.resize(count + added, closed.positions.cols());
    open.positions.topRows(count) = closed.positions;
    for (std::size_t i = 1; i + 1 < path.size(); ++i) {
        const int v = path[i], copy = static_cast<int>(count + static_cast<Eigen::Index>(i)) - 1;
        open.positions.row(copy) = closed.positions.row(v);
        // The faces on the left of the path, from the edge ahead around to the one behind.
        for (int w = path[i + 1]; w != path[i - 1];) {
            const int f = face_at.at({v, w});
            const auto corners = closed.faces[f];
            const auto at = std::find(corners.begin(), corners.end(), v) - corners.begin();
            faces[f][static_cast<std::size_t>(at)] = copy;
            w = corners[static_cast<std::size_t>(at + 2) % 3];
        }
    }
    for (const auto& face : faces) open.faces.add({face[0], face[1], face[2]});
    return open;
}

}  // namespace beltrami::bench
