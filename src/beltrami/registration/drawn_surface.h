#pragma once

#include <array>
#include <span>
#include <vector>

#include <beltrami/registration/sphere_locator.h>

namespace beltrami {

/// A point of a boundary edge, beside its ends.
struct BoundaryPoint {
    std::array<int, 2> edge;  ///< its vertices, in the order of the face
    double fraction;          ///< of the edge, from the first
    Eigen::Vector3d point;    ///< where it is drawn
};

/// A surface as it is laid over another one: a closed one on the unit sphere, one with a boundary in the plane z = 1.
/// Central projection makes one geometry of both: straight lines are those whose points' rays lie in a plane, and three
/// points run around as their determinant says. Faces at a boundary that is bent are divided, so that both surfaces
/// have the same.
class DrawnSurface {
  public:
    enum class On { sphere, plane };

    /// @param points #V×3
    /// @param bends  points of boundary edges, which get the numbers from #V on; where a face cannot be divided so that
    ///               none of its parts is flipped, its edges stay straight
    DrawnSurface(const FaceList& faces, Positions points, On on, std::span<const BoundaryPoint> bends = {});

    /// Faces that are flipped or collapsed.
    std::vector<int> flipped() const;
    /// The point for a mean of points nearby.
    Eigen::Vector3d project(const Eigen::Vector3d& mean) const;
    Eigen::Vector3d point_of(const MeshPoint& place) const;
    /// Of a point outside the surface the nearest place.
    MeshPoint locate(const Eigen::Vector3d& point) const;

    /// Triangles of the drawing: faces or parts of them.
    int triangle_count() const { return locator_->triangle_count(); }
    const std::array<int, 3>& triangle(int t) const { return locator_->triangle(t); }
    /// The triangles beyond the edges opposite to each corner, −1 beyond a boundary.
    const std::array<int, 3>& across(int t) const { return locator_->across(t); }
    Eigen::Vector3d point(int vertex) const { return points_.row(vertex); }
    Eigen::Vector3d middle(int t) const;
    int triangle_at(const Eigen::Vector3d& point) const { return locator_->triangle_at(point); }
    /// The place of a point of a triangle, in terms of the face's own triangle (face_triangle()).
    MeshPoint place_in(int triangle, const Eigen::Vector3d& point) const;

  private:
    /// A triangle of the drawing in barycentric coordinates of the one of the face that it is a part of.
    struct Part {
        int whole;
        std::array<std::array<double, 3>, 3> corners;
    };
    /// A vertex of the drawing and where it is in the triangle that is divided.
    struct Corner {
        int vertex;
        std::array<double, 3> weights;
    };
    using Polygon = std::vector<Corner>;

    bool add_fan(int whole, const Corner& apex, const Polygon& around, bool closed);
    void add_centre(int whole, const Polygon& around);
    MeshPoint of_face(int triangle, const std::array<double, 3>& weights) const;

    Positions points_;
    On on_;
    std::vector<std::array<int, 3>> wholes_;  ///< faces as triangles
    std::vector<int> face_of_whole_, first_of_face_;
    std::vector<Part> parts_;
    std::vector<int> first_part_;  ///< of every whole
    FaceList triangles_;
    std::optional<SphereLocator> locator_;
};

}  // namespace beltrami
