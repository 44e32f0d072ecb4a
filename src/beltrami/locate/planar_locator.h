#pragma once

#include <array>
#include <optional>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/mesh/mesh.h>

namespace beltrami BELTRAMI_PUBLIC {

/// A point of a mesh: a face, three of its vertices, and barycentric coordinates with respect to them.
struct MeshPoint {
    int face = -1;
    std::array<int, 3> vertices{};
    std::array<double, 3> barycentric{};

    /// The value there of a function that is linear between the vertices.
    template <class Values>
    auto interpolate(const Values& values) const {
        return barycentric[0] * values[vertices[0]] + barycentric[1] * values[vertices[1]] +
               barycentric[2] * values[vertices[2]];
    }
};

/// Finds the faces of a planar mesh that contain given points, with a grid of buckets. Quads are read as two triangles.
class PlanarLocator {
  public:
    /// @param mesh planar; copied as far as needed
    /// @throw Error bad_mesh if the mesh does not lie in the plane or has no faces
    explicit PlanarLocator(const Mesh& mesh);

    /// A face that contains the point; of several (on an edge, or where the mesh overlaps) the first. Nothing outside.
    std::optional<MeshPoint> locate(Complex point) const;

    /// The point of the mesh nearest to @p point: the point itself inside, else a point of the boundary.
    MeshPoint nearest(Complex point) const;

    /// Diagonal of the bounding box.
    double diameter() const { return diameter_; }

  private:
    struct Triangle {
        int face;
        std::array<int, 3> vertices;
    };

    std::array<double, 3> barycentric(const Triangle& triangle, Complex point) const;
    int column(double x) const;
    int row(double y) const;

    std::vector<Complex> points_;
    std::vector<Triangle> triangles_;
    std::vector<std::array<int, 2>> border_;  ///< (triangle, its edge) on the boundary
    double x0_ = 0, y0_ = 0, cell_ = 1, diameter_ = 0;
    int columns_ = 1, rows_ = 1;
    std::vector<int> offsets_, contents_;  ///< triangles of every bucket
};

}  // namespace beltrami
