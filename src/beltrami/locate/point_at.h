#pragma once

#include <Eigen/Core>

#include <beltrami/locate/planar_locator.h>
#include <beltrami/mesh/mesh.h>

namespace beltrami {

/// Where a place of a mesh lies in space.
inline Eigen::Vector3d point_at(const Mesh& mesh, const MeshPoint& place) {
    Eigen::Vector3d point = Eigen::Vector3d::Zero();
    for (int i = 0; i < 3; ++i) point += place.barycentric[i] * mesh.point(place.vertices[i]);
    return point;
}

}  // namespace beltrami
