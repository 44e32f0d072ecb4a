#include <beltrami/remeshing/carried_data.h>

#include <algorithm>
#include <limits>
#include <map>
#include <string>

#include <beltrami/base/error.h>
#include <beltrami/mesh/edge_table.h>

namespace beltrami {

namespace {

constexpr double kOnEdge = 1e-9;  // a weight below it is none

/// Faces around every vertex.
std::vector<std::vector<int>> faces_around(const Mesh& mesh) {
    std::vector<std::vector<int>> around(static_cast<std::size_t>(mesh.vertex_count()));
    for (int f = 0; f < mesh.face_count(); ++f)
        for (const int v : mesh.faces[f]) around[v].push_back(f);
    return around;
}

/// The texture point of a vertex in a face.
Eigen::RowVector2d point_in_face(const Mesh& mesh, int face, int vertex) {
    const auto v = mesh.faces[face];
    const auto j = std::find(v.begin(), v.end(), vertex) - v.begin();
    return mesh.texture->points.row(mesh.texture->corners[mesh.faces.first_corner(face) + static_cast<int>(j)])
        .head<2>();
}

bool has(const Mesh& mesh, int face, int vertex) {
    const auto v = mesh.faces[face];
    return std::find(v.begin(), v.end(), vertex) != v.end();
}

/// The texture at a place as the faces see it that have the place: of those what is nearest to a point.
Eigen::RowVector2d texture_at(const Mesh& mesh, const std::vector<std::vector<int>>& around, const MeshPoint& place,
                              const Eigen::RowVector2d& near) {
    int anchor = 0;
    for (int i = 1; i < 3; ++i)
        if (place.barycentric[i] > place.barycentric[anchor]) anchor = i;
    Eigen::RowVector2d best = near;
    double least = std::numeric_limits<double>::infinity();
    for (const int face : around[place.vertices[anchor]]) {
        Eigen::RowVector2d at = Eigen::RowVector2d::Zero();
        bool inside = true;
        for (int i = 0; i < 3; ++i) {
            if (place.barycentric[i] < kOnEdge) continue;
            if (!has(mesh, face, place.vertices[i])) {
                inside = false;
                break;
            }
            at += place.barycentric[i] * point_in_face(mesh, face, place.vertices[i]);
        }
        if (!inside || !((at - near).norm() < least)) continue;
        least = (at - near).norm();
        best = at;
    }
    return best;
}

}  // namespace

TextureCoordinates carried_texture(const Mesh& mesh, std::span<const MeshPoint> places) {
    if (static_cast<int>(places.size()) != mesh.vertex_count())
        throw Error(Cause::bad_option, "there are " + std::to_string(places.size()) + " places for " +
                                           std::to_string(mesh.vertex_count()) + " vertices");
    const std::vector<std::vector<int>> around = faces_around(mesh);
    std::map<std::array<int, 2>, int> numbers;  // of (vertex, old texture point)
    TextureCoordinates result;
    std::vector<Eigen::RowVector2d> points;
    for (int c = 0; c < mesh.faces.corner_count(); ++c) {
        const int v = mesh.faces.vertices()[c], t = mesh.texture->corners[c];
        const auto [at, is_new] = numbers.insert({{v, t}, static_cast<int>(points.size())});
        if (is_new) points.push_back(texture_at(mesh, around, places[v], mesh.texture->points.row(t).head<2>()));
        result.corners.push_back(at->second);
    }
    result.points.resize(static_cast<Eigen::Index>(points.size()), 2);
    for (std::size_t i = 0; i < points.size(); ++i) result.points.row(static_cast<Eigen::Index>(i)) = points[i];
    return result;
}

Positions carried_values(const Positions& values, std::span<const MeshPoint> places) {
    Positions result = Positions::Zero(values.rows(), values.cols());
    for (std::size_t v = 0; v < places.size(); ++v)
        for (int i = 0; i < 3; ++i)
            result.row(static_cast<Eigen::Index>(v)) += places[v].barycentric[i] * values.row(places[v].vertices[i]);
    return result;
}

std::vector<std::array<int, 2>> seam_edges(const Mesh& mesh) {
    std::vector<std::array<int, 2>> result;
    if (!mesh.texture) return result;
    const EdgeTable table = edge_table(mesh.faces, mesh.vertex_count());
    for (int e = 0; e < table.edge_count(); ++e) {
        const auto corners = table.corners_of(e);
        if (corners.size() != 2) continue;
        const auto point = [&](int corner, int vertex) {
            return mesh.texture
                ->corners[mesh.faces.vertices()[corner] == vertex ? corner : next_corner(mesh.faces, table, corner)];
        };
        const auto [u, v] = table.edges[e];
        if (point(corners[0], u) != point(corners[1], u) || point(corners[0], v) != point(corners[1], v))
            result.push_back(table.edges[e]);
    }
    return result;
}

}  // namespace beltrami
