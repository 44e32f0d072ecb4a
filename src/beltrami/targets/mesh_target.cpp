#include <beltrami/targets/mesh_target.h>

#include <utility>

#include <Eigen/Geometry>

#include <beltrami/base/error.h>
#include <beltrami/locate/point_at.h>
#include <beltrami/mesh/topology.h>

namespace beltrami {

namespace {

constexpr double kOnEdge = 1e-9;  // barycentric weight up to which a point counts as on an edge

Positions in_space(const Mesh& mesh) {
    if (mesh.face_count() == 0) throw Error(Cause::bad_mesh, "the target mesh has no faces");
    Positions points(mesh.vertex_count(), 3);
    for (int v = 0; v < mesh.vertex_count(); ++v) points.row(v) = mesh.point(v);
    return points;
}

std::vector<int> first_triangles(const std::vector<std::array<int, 3>>& triangles, int vertex_count) {
    std::vector<int> result(static_cast<std::size_t>(vertex_count), -1);
    for (std::size_t t = triangles.size(); t-- > 0;)
        for (const int v : triangles[t]) result[v] = static_cast<int>(t);
    return result;
}

}  // namespace

MeshTarget::MeshTarget(Mesh mesh)
    : mesh_(std::move(mesh)),
      normals_(vertex_normals(mesh_)),
      triangles_(as_triangles(mesh_.faces, in_space(mesh_), face_of_triangle_)),
      locator_(mesh_.positions, triangles_) {
    triangle_of_vertex_ = first_triangles(triangles_, mesh_.vertex_count());
    triangle_of_face_.assign(static_cast<std::size_t>(mesh_.face_count()), -1);
    for (std::size_t t = face_of_triangle_.size(); t-- > 0;)
        triangle_of_face_[face_of_triangle_[t]] = static_cast<int>(t);
}

Eigen::Vector3d MeshTarget::normal(const MeshPoint& place) const {
    const Eigen::Vector3d sum = point_at(normals_, place);
    if (const double length = sum.norm(); length > 0) return sum / length;
    return face_vector_area(mesh_, place.face).normalized();
}

Target::Point MeshTarget::at(const MeshPoint& place) const {
    Point result;
    result.position = point_at(mesh_, place);
    result.normal = normal(place);
    result.place = place;
    return result;
}

Target::Point MeshTarget::at_vertex(int vertex) const {
    const int triangle = triangle_of_vertex_[vertex];
    MeshPoint place{face_of_triangle_[triangle], triangles_[triangle], {}};
    for (int i = 0; i < 3; ++i) place.barycentric[i] = place.vertices[i] == vertex ? 1 : 0;
    return at(place);
}

Target::Point MeshTarget::in_triangle(const SurfaceLocator::Place& found) const {
    return at({face_of_triangle_[found.triangle], triangles_[found.triangle], found.barycentric});
}

Target::Point MeshTarget::nearest(const Eigen::Vector3d& point) const {
    return in_triangle(locator_.nearest(point));
}

Target::Point MeshTarget::retract(const Eigen::Vector3d& moved, const Point& from) const {
    return in_triangle(locator_.nearest(moved, from.place.face < 0 ? -1 : triangle_of_face_[from.place.face]));
}

Eigen::Vector3d MeshTarget::across(const Point& point) const {
    const MeshPoint& place = point.place;
    for (const double weight : place.barycentric)
        if (!(weight > kOnEdge)) return point.normal;
    const std::array<Eigen::Vector3d, 3> corners{mesh_.point(place.vertices[0]), mesh_.point(place.vertices[1]),
                                                 mesh_.point(place.vertices[2])};
    const Eigen::Vector3d up = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    return up.dot(point.normal) > 0 ? Eigen::Vector3d(up.normalized()) : point.normal;
}

SlideCurves MeshTarget::boundary() const {
    SlideCurves curves;
    for (const std::vector<int>& loop : topology(mesh_).boundary_loops) {
        Positions points(static_cast<Eigen::Index>(loop.size()), 3);
        for (std::size_t i = 0; i < loop.size(); ++i) points.row(static_cast<Eigen::Index>(i)) = mesh_.point(loop[i]);
        curves.push_back(std::make_shared<PolylineCurve>(points, true));
    }
    return curves;
}

std::vector<MeshPoint> places_of(const Target::Points& points) {
    std::vector<MeshPoint> result;
    result.reserve(points.size());
    for (const Target::Point& point : points) result.push_back(point.place);
    return result;
}

}  // namespace beltrami
