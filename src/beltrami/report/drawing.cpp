#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>
#include <unordered_map>

#include <beltrami/mesh/quad_split.h>
#include <beltrami/report/drawing.h>

namespace beltrami {
namespace {

Drawing split_quads(const Mesh& mesh) {
    Drawing drawing;
    drawing.vertex_count = mesh.vertex_count();
    for (int face = 0; face < mesh.face_count(); ++face) {
        const auto v = mesh.faces[face];
        if (v.size() == 3) {
            drawing.triangles.push_back({v[0], v[1], v[2]});
            drawing.faces.push_back(face);
            continue;
        }
        if (v.size() > 4) {
            for (std::size_t i = 1; i + 1 < v.size(); ++i) {
                drawing.triangles.push_back({v[0], v[i], v[i + 1]});
                drawing.faces.push_back(face);
            }
            continue;
        }
        for (const auto& [a, b, c] :
             split_quad({mesh.point(v[0]), mesh.point(v[1]), mesh.point(v[2]), mesh.point(v[3])})) {
            drawing.triangles.push_back({v[a], v[b], v[c]});
            drawing.faces.push_back(face);
        }
    }
    return drawing;
}

/// Merges the vertices of each cell of a grid; a triangle that keeps three different vertices stays, once.
Drawing merge_cells(const Mesh& mesh, const Drawing& fine, const Eigen::Vector3d& origin, double cell) {
    constexpr std::uint64_t side = std::uint64_t{1} << 21;
    Drawing coarse;
    coarse.drawn_vertex.resize(static_cast<std::size_t>(mesh.vertex_count()));
    std::unordered_map<std::uint64_t, int> cells;
    for (int vertex = 0; vertex < mesh.vertex_count(); ++vertex) {
        const Eigen::Vector3d at = ((mesh.point(vertex) - origin) / cell).cwiseMax(0.0).cwiseMin(double(side - 1));
        const auto key = (static_cast<std::uint64_t>(at.z()) * side + static_cast<std::uint64_t>(at.y())) * side +
                         static_cast<std::uint64_t>(at.x());
        const auto [entry, added] = cells.try_emplace(key, coarse.vertex_count);
        coarse.vertex_count += added;
        coarse.drawn_vertex[static_cast<std::size_t>(vertex)] = entry->second;
    }
    std::set<std::array<int, 3>> seen;
    for (std::size_t t = 0; t < fine.triangles.size(); ++t) {
        std::array<int, 3> triangle;
        for (std::size_t i = 0; i < 3; ++i) {
            triangle[i] = coarse.drawn_vertex[static_cast<std::size_t>(fine.triangles[t][i])];
        }
        std::array<int, 3> sorted = triangle;
        std::sort(sorted.begin(), sorted.end());
        if (sorted[0] == sorted[1] || sorted[1] == sorted[2] || !seen.insert(sorted).second) continue;
        coarse.triangles.push_back(triangle);
        coarse.faces.push_back(fine.faces[t]);
    }
    return coarse;
}

}  // namespace

Positions Drawing::reduce(const Positions& values) const {
    if (!coarsened()) return values;
    Positions mean = Positions::Zero(vertex_count, values.cols());
    Eigen::VectorXd count = Eigen::VectorXd::Zero(vertex_count);
    for (int vertex = 0; vertex < values.rows(); ++vertex) {
        if (!values.row(vertex).allFinite()) continue;
        const int drawn = drawn_vertex[static_cast<std::size_t>(vertex)];
        mean.row(drawn) += values.row(vertex);
        count[drawn] += 1.0;
    }
    for (int drawn = 0; drawn < vertex_count; ++drawn) mean.row(drawn) /= count[drawn];  // 0/0: NaN, as it should be
    return mean;
}

Drawing make_drawing(const Mesh& mesh, int triangle_limit) {
    Drawing fine = split_quads(mesh);
    if (fine.triangles.size() <= static_cast<std::size_t>(triangle_limit)) return fine;

    double area = 0.0;
    for (int face = 0; face < mesh.face_count(); ++face) area += face_vector_area(mesh, face).norm();
    Eigen::Vector3d origin = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
    for (int vertex = 0; vertex < mesh.vertex_count(); ++vertex) origin = origin.cwiseMin(mesh.point(vertex));
    // About two triangles a cell that the surface meets; half the limit is aimed at, since it may meet more.
    double cell = std::sqrt(4.0 * area / std::max(triangle_limit, 1));
    if (!(cell > 0.0)) cell = 1.0;
    while (true) {
        Drawing coarse = merge_cells(mesh, fine, origin, cell);
        if (coarse.triangles.size() <= static_cast<std::size_t>(std::max(triangle_limit, 0))) return coarse;
        cell *= 1.25;
    }
}

}  // namespace beltrami
