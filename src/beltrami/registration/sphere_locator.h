#pragma once

#include <array>
#include <span>
#include <vector>

#include <beltrami/locate/planar_locator.h>
#include <beltrami/locate/surface_locator.h>

namespace beltrami {

/// Finds the geodesic triangles of a mesh on the unit sphere that contain given points; quads are two triangles
/// (quad_split.h). Barycentric coordinates are gnomonic, so that a point lies on the ray through their mean of the
/// corners. Nothing depends on more than rays: points may be those of the plane z = 1 as well, where a boundary may be.
class SphereLocator {
  public:
    /// @param faces  triangles and quads that cover the sphere, or their part of the plane, once
    /// @param points #V×3 unit vectors, or with z = 1
    SphereLocator(const FaceList& faces, const Positions& points);

    /// Of a point that no triangle contains the nearest place.
    /// @param point unit vector, or with z = 1
    MeshPoint locate(const Eigen::Vector3d& point) const;
    /// Of many points (one row each), on all threads.
    std::vector<MeshPoint> locate(const Positions& points) const;

    int triangle_count() const { return static_cast<int>(triangles_.size()); }
    const std::array<int, 3>& triangle(int t) const { return triangles_[t]; }
    /// The triangles beyond the edges opposite to each corner, −1 beyond a boundary.
    const std::array<int, 3>& across(int t) const { return across_[t]; }
    /// The triangle that contains a point.
    int triangle_at(const Eigen::Vector3d& point) const { return walk(nearest_.nearest(point).triangle, point); }
    /// The place of a point of a triangle.
    MeshPoint place_in(int triangle, const Eigen::Vector3d& point) const;

  private:
    std::array<double, 3> weights(int triangle, const Eigen::Vector3d& point) const;
    int walk(int triangle, const Eigen::Vector3d& point) const;

    Positions points_;
    std::vector<int> face_of_triangle_;
    std::vector<std::array<int, 3>> triangles_;
    std::vector<std::array<int, 3>> across_;  ///< the triangle beyond the edge opposite to each corner
    bool closed_;
    SurfaceLocator nearest_;
};

/// The point of the sphere at a place of a mesh there: the mean of the corners, back on the sphere.
Eigen::Vector3d sphere_place(const Positions& points, const MeshPoint& place);

}  // namespace beltrami
