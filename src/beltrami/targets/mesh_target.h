#pragma once

#include <array>
#include <vector>

#include <beltrami/locate/surface_locator.h>
#include <beltrami/targets/target.h>

namespace beltrami BELTRAMI_PUBLIC {

/// A mesh of triangles and quads as a surface: every point of it is a face and barycentric coordinates. Its normals are
/// those of the vertices, interpolated, by which faces of an image are told upright from flipped also across an edge.
class MeshTarget final : public Target {
  public:
    /// @param mesh that passes the diagnosis; in the plane or in space, copied
    /// @throw Error bad_mesh if there is no face
    explicit MeshTarget(Mesh mesh);

    /// Of several nearest places that in the triangle that comes first.
    Point nearest(const Eigen::Vector3d& point) const override;
    /// The nearest, looked for around the face where the point was.
    Point retract(const Eigen::Vector3d& moved, const Point& from) const override;
    Eigen::Vector3d across(const Point& point) const override;
    /// Its boundary loops as polylines.
    SlideCurves boundary() const override;
    const Mesh* mesh() const override { return &mesh_; }

    /// The point at a place of the mesh.
    Point at(const MeshPoint& place) const;
    Point at_vertex(int vertex) const;

  private:
    Eigen::Vector3d normal(const MeshPoint& place) const;
    Point in_triangle(const SurfaceLocator::Place& found) const;

    Mesh mesh_;
    Positions normals_;
    std::vector<int> face_of_triangle_, triangle_of_vertex_, triangle_of_face_;
    std::vector<std::array<int, 3>> triangles_;
    SurfaceLocator locator_;
};

/// The places of points on a mesh.
std::vector<MeshPoint> places_of(const Target::Points& points);

}  // namespace beltrami
