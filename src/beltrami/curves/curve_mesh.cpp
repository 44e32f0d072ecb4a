#include <beltrami/curves/curve_mesh.h>

#include <algorithm>

#include <Eigen/Geometry>

#include <beltrami/locate/surface_locator.h>

namespace beltrami {

namespace {

constexpr double kOnVertex = 1e-6;  // weights below which a place counts as on an edge or a vertex

}  // namespace

CurveMesh::CurveMesh(const Mesh& mesh) {
    Positions in_space(mesh.vertex_count(), 3);
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        points_.push_back(mesh.point(v));
        in_space.row(v) = points_.back();
    }
    first_ = as_triangles(mesh.faces, in_space, face_of_);
    triangles_ = first_;
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
        base_.push_back(static_cast<int>(t));
        register_sides(static_cast<int>(t));
    }
}

void CurveMesh::register_sides(int triangle) {
    for (int i = 0; i < 3; ++i) side_[key(triangles_[triangle][i], triangles_[triangle][(i + 1) % 3])] = triangle;
}

int CurveMesh::left_of(int a, int b) const {
    const auto it = side_.find(key(a, b));
    return it == side_.end() ? -1 : it->second;
}

int CurveMesh::opposite(int a, int b) const {
    const int triangle = left_of(a, b);
    if (triangle < 0) return -1;
    for (const int v : triangles_[triangle])
        if (v != a && v != b) return v;
    return -1;
}

std::array<double, 3> CurveMesh::weights(const std::array<int, 3>& corners, const Eigen::Vector3d& point) const {
    const Eigen::Vector3d &a = points_[corners[0]], &b = points_[corners[1]], &c = points_[corners[2]];
    const Eigen::Vector3d normal = (b - a).cross(c - a);
    const double area = normal.squaredNorm();
    if (!(area > 0)) return {1, 0, 0};
    const double of_b = (point - a).cross(c - a).dot(normal) / area, of_c = (b - a).cross(point - a).dot(normal) / area;
    return {1 - of_b - of_c, of_b, of_c};
}

MeshPoint CurveMesh::place(int triangle, const Eigen::Vector3d& point) const {
    const int base = base_[triangle];
    std::array<double, 3> w = weights(first_[base], point);
    double sum = 0;
    for (double& weight : w) sum += weight = std::max(weight, 0.0);
    for (double& weight : w) weight /= sum;
    return {face_of_[base], first_[base], w};
}

void CurveMesh::replace(int triangle, const std::array<int, 3>& corners) {
    triangles_[triangle] = corners;
    register_sides(triangle);
}

void CurveMesh::add(const std::array<int, 3>& corners, int base) {
    triangles_.push_back(corners);
    base_.push_back(base);
    register_sides(static_cast<int>(triangles_.size()) - 1);
}

/// Divides a triangle and the one beyond its side from a vertex on that side.
void CurveMesh::split_edge(int triangle, int side, int vertex) {
    const int a = triangles_[triangle][side], b = triangles_[triangle][(side + 1) % 3];
    const int beyond = left_of(b, a);
    side_.erase(key(a, b));
    side_.erase(key(b, a));
    const auto divide = [&](int t, int from, int to) {
        int c = -1;
        for (const int v : triangles_[t])
            if (v != from && v != to) c = v;
        replace(t, {from, vertex, c});
        add({vertex, to, c}, base_[t]);
    };
    divide(triangle, a, b);
    if (beyond >= 0) divide(beyond, b, a);
}

int CurveMesh::vertex_at(const MeshPoint& given) {
    const auto largest = std::max_element(given.barycentric.begin(), given.barycentric.end());
    if (*largest > 1 - kOnVertex) return given.vertices[largest - given.barycentric.begin()];
    Eigen::Vector3d point = Eigen::Vector3d::Zero();
    for (int i = 0; i < 3; ++i) point += given.barycentric[i] * points_[given.vertices[i]];
    int best = -1;
    double most = -1e300;
    std::array<double, 3> there{};
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
        if (face_of_[base_[t]] != given.face) continue;
        const std::array<double, 3> w = weights(triangles_[t], point);
        const double least = *std::min_element(w.begin(), w.end());
        if (least > most) most = least, best = static_cast<int>(t), there = w;
    }
    const std::array<int, 3> corners = triangles_[best];
    for (int i = 0; i < 3; ++i)
        if (there[i] > 1 - kOnVertex) return corners[i];
    const int vertex = vertex_count();
    points_.push_back(point);
    for (int i = 0; i < 3; ++i)
        if (there[i] < kOnVertex) {
            split_edge(best, (i + 1) % 3, vertex);
            return vertex;
        }
    replace(best, {corners[0], corners[1], vertex});
    add({corners[1], corners[2], vertex}, base_[best]);
    add({corners[2], corners[0], vertex}, base_[best]);
    return vertex;
}

}  // namespace beltrami
