#pragma once

#include <span>

#include <Eigen/Core>

#include <beltrami/locate/planar_locator.h>
#include <beltrami/mesh/mesh.h>

namespace beltrami {

/// The mean of rows that belong to the vertices, by the weights of a place.
/// @param rows #V×3
inline Eigen::Vector3d point_at(const Positions& rows, const MeshPoint& place) {
    Eigen::Vector3d point = Eigen::Vector3d::Zero();
    for (int i = 0; i < 3; ++i) point += place.barycentric[i] * rows.row(place.vertices[i]).transpose();
    return point;
}

/// Where a place of a mesh lies in space.
inline Eigen::Vector3d point_at(const Mesh& mesh, const MeshPoint& place) {
    Eigen::Vector3d point = Eigen::Vector3d::Zero();
    for (int i = 0; i < 3; ++i) point += place.barycentric[i] * mesh.point(place.vertices[i]);
    return point;
}

/// The same of many places, #P×3.
inline Positions points_at(const Mesh& mesh, std::span<const MeshPoint> places) {
    Positions points(static_cast<Eigen::Index>(places.size()), 3);
    for (std::size_t i = 0; i < places.size(); ++i)
        points.row(static_cast<Eigen::Index>(i)) = point_at(mesh, places[i]).transpose();
    return points;
}

}  // namespace beltrami
