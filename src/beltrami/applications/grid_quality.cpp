#include <beltrami/applications/grid_quality.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace beltrami {

GridQuality grid_quality(const Mesh& grid, const Positions& normals) {
    GridQuality quality;
    if (grid.faces.empty()) return quality;
    quality.min_angle = std::numbers::pi;
    double smallest = std::numeric_limits<double>::infinity(), largest = 0;
    int quads = 0;
    for (int f = 0; f < grid.face_count(); ++f) {
        const auto corners = grid.faces[f];
        const int n = static_cast<int>(corners.size());
        const Eigen::Vector3d area = face_vector_area(grid, f);
        Eigen::Vector3d normal = Eigen::Vector3d::Zero();
        for (const int v : corners) normal += normals.row(v).transpose();
        bool folded = !(area.dot(normal) > 0);
        double shortest = std::numeric_limits<double>::infinity(), longest = 0;
        for (int k = 0; k < n; ++k) {
            const Eigen::Vector3d here = grid.point(corners[k]), ahead = grid.point(corners[(k + 1) % n]) - here,
                                  back = grid.point(corners[(k + n - 1) % n]) - here;
            const Eigen::Vector3d turn = ahead.cross(back);
            folded |= !(turn.dot(area) > 0);
            double angle = std::atan2(turn.norm(), ahead.dot(back));
            if (turn.dot(area) < 0) angle = 2 * std::numbers::pi - angle;
            quality.min_angle = std::min(quality.min_angle, angle);
            quality.max_angle = std::max(quality.max_angle, angle);
            if (n == 4) quality.mean_skew += std::abs(angle - std::numbers::pi / 2) / 4;
            shortest = std::min(shortest, ahead.norm());
            longest = std::max(longest, ahead.norm());
        }
        if (folded) quality.folded.push_back(f);
        quality.mean_aspect += longest / shortest;
        quality.max_aspect = std::max(quality.max_aspect, longest / shortest);
        if (n == 4) ++quads, smallest = std::min(smallest, area.norm()), largest = std::max(largest, area.norm());
    }
    quality.mean_aspect /= grid.face_count();
    if (quads > 0) quality.mean_skew /= quads;
    if (largest > 0) quality.area_ratio = largest / smallest;
    return quality;
}

}  // namespace beltrami
