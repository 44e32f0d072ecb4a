#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include <beltrami/locate/planar_locator.h>
#include <beltrami/mesh/mesh.h>

namespace beltrami {

/// The triangles of a mesh, to which points are added as vertices.
class CurveMesh {
  public:
    /// Quads are two triangles (quad_split.h).
    explicit CurveMesh(const Mesh& mesh);

    /// The vertex at a place of the mesh; where there is none yet the triangles around it are divided.
    int vertex_at(const MeshPoint& place);

    int vertex_count() const { return static_cast<int>(points_.size()); }
    const std::vector<std::array<int, 3>>& triangles() const { return triangles_; }
    const Eigen::Vector3d& point(int vertex) const { return points_[vertex]; }
    double length(int a, int b) const { return (points_[a] - points_[b]).norm(); }
    /// The vertex opposite to the edge in the triangle to its left, which runs from a to b; −1 beyond the boundary.
    int opposite(int a, int b) const;
    /// That triangle, or −1.
    int left_of(int a, int b) const;
    /// The face of the mesh in which a triangle lies.
    int face_of(int triangle) const { return face_of_[base_[triangle]]; }
    /// The place on the mesh of a point of a triangle.
    MeshPoint place(int triangle, const Eigen::Vector3d& point) const;

  private:
    static std::int64_t key(int a, int b) {
        return (static_cast<std::int64_t>(a) << 32) | static_cast<std::uint32_t>(b);
    }
    void replace(int triangle, const std::array<int, 3>& corners);
    void add(const std::array<int, 3>& corners, int base);
    void register_sides(int triangle);
    void split_edge(int triangle, int side, int vertex);
    std::array<double, 3> weights(const std::array<int, 3>& corners, const Eigen::Vector3d& point) const;

    std::vector<Eigen::Vector3d> points_;
    std::vector<std::array<int, 3>> first_;  ///< triangles as they were, and …
    std::vector<int> face_of_;               ///< … their faces
    std::vector<std::array<int, 3>> triangles_;
    std::vector<int> base_;  ///< which of the first ones each lies in
    std::unordered_map<std::int64_t, int> side_;
};

}  // namespace beltrami
