#include <beltrami/unfold/sphere_faces.h>

#include <algorithm>

#include <Eigen/Geometry>

#include <beltrami/mesh/quad_split.h>
#include <beltrami/sphere/unit_sphere.h>

namespace beltrami {

namespace {

/// Which corners of a quad are reflex, seen along its vector area.
std::array<char, 4> reflex_corners(const std::array<Eigen::Vector3d, 4>& p) {
    const Eigen::Vector3d normal = (p[2] - p[0]).cross(p[3] - p[1]);
    std::array<char, 4> reflex;
    for (int i = 0; i < 4; ++i) reflex[i] = (p[(i + 1) % 4] - p[i]).cross(p[(i + 3) % 4] - p[i]).dot(normal) <= 0;
    return reflex;
}

Eigen::Vector3d source_point(const Surface& source, int corner) {
    if (!source.metric) return source.mesh.point(source.mesh.faces.vertices()[corner]);
    const Positions& metric = *source.metric;
    return {metric(corner, 0), metric(corner, 1), metric.cols() > 2 ? metric(corner, 2) : 0.0};
}

}  // namespace

SphereFaces::SphereFaces(const Surface& source) : source_(source) {
    const FaceList& faces = source.mesh.faces;
    if (faces.corner_count() == 3 * faces.size()) return;
    quads_.resize(static_cast<std::size_t>(faces.size()));
    for (int f = 0; f < faces.size(); ++f) {
        if (faces.degree(f) != 4) continue;
        std::array<Eigen::Vector3d, 4> p;
        for (int i = 0; i < 4; ++i) p[i] = source_point(source, faces.first_corner(f) + i);
        quads_[f] = {reflex_corners(p), split_quad(p)};
    }
}

bool SphereFaces::upright(int face, const Positions& points) const {
    const auto v = source_.mesh.faces[face];
    const auto at = [&](std::size_t i) { return Eigen::Vector3d(points.row(v[i % v.size()])); };
    if (v.size() == 3) return oriented_volume(at(0), at(1), at(2)) > 0;
    for (std::size_t i = 0; i < 4; ++i)
        if (!quads_[face].reflex[i] && !(oriented_volume(at(i), at(i + 1), at(i + 3)) > 0)) return false;
    return true;
}

bool SphereFaces::upright_as_triangles(const Positions& points) const {
    for (int f = 0; f < source_.mesh.face_count(); ++f) {
        const auto v = source_.mesh.faces[f];
        const auto is_up = [&](const std::array<int, 3>& c) {
            return oriented_volume(points.row(v[c[0]]), points.row(v[c[1]]), points.row(v[c[2]])) > 0;
        };
        if (v.size() == 3 ? !is_up({0, 1, 2}) : !std::ranges::all_of(quads_[f].triangles, is_up)) return false;
    }
    return true;
}

std::vector<int> SphereFaces::flipped(const Positions& points) const {
    std::vector<int> result;
    for (int f = 0; f < source_.mesh.face_count(); ++f)
        if (!upright(f, points)) result.push_back(f);
    return result;
}

}  // namespace beltrami
