#include <beltrami/certificate/edge_corner_bound.h>

#include <cmath>
#include <numbers>

#include <beltrami/constraints/boundary_corners.h>

namespace beltrami {

namespace {

/// Angles of the image nearer than this to 0 or 2π are not told from each other.
constexpr double kLeastAngle = 1e-9;

/// #V sums of the angles of faces' corners at vertices of the boundary, in the metric: at a corner of a quad that of
/// its two edges; 0 inside.
std::vector<double> angle_sums(const Surface& source) {
    const FaceList& faces = source.mesh.faces;
    std::vector<double> sums(static_cast<std::size_t>(source.mesh.vertex_count()), 0.0);
    const auto point = [&](int c) -> Eigen::Vector3d {
        if (!source.metric) return source.mesh.point(faces.vertices()[c]);
        return {(*source.metric)(c, 0), (*source.metric)(c, 1),
                source.metric->cols() > 2 ? (*source.metric)(c, 2) : 0.0};
    };
    for (int f = 0; f < faces.size(); ++f) {
        const int first = faces.first_corner(f), n = faces.degree(f);
        for (int j = 0; j < n; ++j) {
            if (!source.topology.on_boundary[faces.vertices()[first + j]]) continue;
            const Eigen::Vector3d here = point(first + j), a = point(first + (j + 1) % n) - here,
                                  b = point(first + (j + n - 1) % n) - here;
            // Kahan: accurate for all angles.
            const double la = a.norm(), lb = b.norm();
            sums[faces.vertices()[first + j]] += 2 * std::atan2((a * lb - b * la).norm(), (a * lb + b * la).norm());
        }
    }
    return sums;
}

}  // namespace

std::vector<double> edge_corner_bounds(const Surface& source, const Eigen::VectorXcd& map) {
    const std::vector<double> angles = angle_sums(source);
    std::vector<double> bounds(angles.size(), 1.0);
    for (std::size_t l = 0; l < source.topology.boundary_loops.size(); ++l) {
        const auto& loop = source.topology.boundary_loops[l];
        const auto& lengths = source.boundary_edge_lengths[l];
        const std::size_t n = loop.size();
        for (std::size_t i = 0; i < n; ++i) {
            const std::size_t last = (i + n - 1) % n;
            const Complex out = map[loop[(i + 1) % n]] - map[loop[i]], in = map[loop[last]] - map[loop[i]];
            double angle = std::arg(in * std::conj(out));
            if (angle < 0) angle += 2 * std::numbers::pi;
            if (angle < kLeastAngle || angle > 2 * std::numbers::pi - kLeastAngle) continue;
            const double K =
                corner_bound(angles[loop[i]], angle, std::abs(out) / lengths[i], std::abs(in) / lengths[last], 1);
            if (std::isfinite(K)) bounds[loop[i]] = K;
        }
    }
    return bounds;
}

EdgeCornerBound edge_corner_bound(const Surface& source, const Eigen::VectorXcd& map) {
    const std::vector<double> bounds = edge_corner_bounds(source, map);
    EdgeCornerBound best;
    for (std::size_t v = 0; v < bounds.size(); ++v)
        if (bounds[v] > best.K) best = {bounds[v], static_cast<int>(v)};
    return best;
}

}  // namespace beltrami
