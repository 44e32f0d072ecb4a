#pragma once

#include <array>
#include <cmath>
#include <span>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <beltrami/mesh/mesh.h>

namespace beltrami {

/// The angle of a triangle in space at one of its corners, 0 … π, and its derivative by the places of the corners.
struct CornerAngle {
    double angle = 0;
    std::array<Eigen::Vector3d, 3> by;  ///< 0 where the triangle has no area
};

/// @param stencil three vertices
/// @param points  #V×3
inline CornerAngle corner_angle(std::span<const int> stencil, int corner, const Positions& points) {
    const std::size_t at = static_cast<std::size_t>(corner), next = (at + 1) % 3, last = (at + 2) % 3;
    const Eigen::Vector3d here = points.row(stencil[at]), a = points.row(stencil[next]).transpose() - here,
                          b = points.row(stencil[last]).transpose() - here, up = a.cross(b);
    const double twice = up.norm();
    CornerAngle result;
    result.angle = std::atan2(twice, a.dot(b));
    result.by.fill(Eigen::Vector3d::Zero());
    if (!(twice > 0)) return result;
    const Eigen::Vector3d normal = up / twice;
    result.by[next] = -normal.cross(a) / a.squaredNorm();
    result.by[last] = normal.cross(b) / b.squaredNorm();
    result.by[at] = -(result.by[next] + result.by[last]);
    return result;
}

}  // namespace beltrami
