#include <beltrami/meshing/polygon_split.h>

#include <Eigen/Geometry>

#include <beltrami/base/error.h>
#include <beltrami/meshing/delaunay.h>

namespace beltrami {

namespace {

/// The corners in the plane across their vector area, in units of their extent; nothing if they have none.
std::vector<Eigen::Vector2d> projected(const Positions& corners) {
    if (!corners.allFinite()) return {};
    Eigen::MatrixX3d p = Eigen::MatrixX3d::Zero(corners.rows(), 3);
    p.leftCols(corners.cols()) = corners;
    const double scale = p.cwiseAbs().maxCoeff();
    if (!(scale > 0)) return {};
    p /= scale;
    p.rowwise() -= p.row(0).eval();
    const double extent = p.cwiseAbs().maxCoeff();
    if (!(extent > 0)) return {};
    p /= extent;
    Eigen::Vector3d area = Eigen::Vector3d::Zero();
    for (Eigen::Index i = 1; i + 1 < p.rows(); ++i) area += p.row(i).cross(p.row(i + 1)).transpose();
    const double size = area.norm();
    if (!(size > 1e-14)) return {};
    const Eigen::Vector3d normal = area / size, u = normal.unitOrthogonal(), v = normal.cross(u);
    std::vector<Eigen::Vector2d> points;
    for (Eigen::Index i = 0; i < p.rows(); ++i) points.emplace_back(p.row(i).dot(u), p.row(i).dot(v));
    return points;
}

}  // namespace

std::vector<std::array<int, 3>> split_polygon(const Positions& corners) {
    const int n = static_cast<int>(corners.rows());
    std::vector<std::array<int, 3>> triangles;
    PlanarDomain domain;
    domain.points = projected(corners);
    if (!domain.points.empty()) {
        for (int i = 0; i < n; ++i) domain.segments.push_back({i, (i + 1) % n});
        domain.curves.assign(domain.segments.size(), 0);
        TriangulateOptions options;
        options.min_angle = 0;
        options.smoothing_passes = 0;
        options.split_ears = false;
        try {
            const Mesh mesh = triangulate(domain, options);
            for (int f = 0; f < mesh.face_count(); ++f)
                triangles.push_back({mesh.faces[f][0], mesh.faces[f][1], mesh.faces[f][2]});
            if (mesh.vertex_count() == n && mesh.face_count() == n - 2) return triangles;
        } catch (const Error&) {  // the projection meets itself
        }
        triangles.clear();
    }
    for (int i = 1; i + 1 < n; ++i) triangles.push_back({0, i, i + 1});
    return triangles;
}

}  // namespace beltrami
