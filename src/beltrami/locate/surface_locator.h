#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include <beltrami/base/public.h>
#include <beltrami/mesh/mesh.h>

namespace beltrami BELTRAMI_PUBLIC {

/// Finds the point of a triangle mesh in space that is nearest to a given one: a tree of bounding boxes, halved at the
/// median of their longest side.
class SurfaceLocator {
  public:
    /// A triangle and weights of its corners, from 0 to 1 and 1 in all.
    struct Place {
        int triangle = -1;
        std::array<double, 3> barycentric{};
        double distance = 0;  ///< of the point that was looked for
    };

    /// @param positions #V×3 or #V×2, finite; copied
    /// @param triangles indices of positions; at least one triangle
    SurfaceLocator(const Positions& positions, std::vector<std::array<int, 3>> triangles);

    /// Of several nearest triangles the first.
    /// @param point finite
    Place nearest(const Eigen::Vector3d& point) const { return nearest(point, -1); }
    /// The same, found sooner.
    /// @param guess a triangle that may be near, or −1
    Place nearest(const Eigen::Vector3d& point, int guess) const;

  private:
    using Box = std::array<Eigen::Array3d, 2>;
    /// The left child of a node follows it.
    struct Node {
        Box box;
        int first, last;  ///< its triangles in order_
        int right = 0;    ///< the right child; 0: a leaf
    };

    Box box_of(int triangle) const;
    void build(int first, int last);
    Place on_triangle(int triangle, const Eigen::Vector3d& point) const;

    std::vector<Eigen::Vector3d> points_;
    std::vector<std::array<int, 3>> triangles_;
    std::vector<int> order_;
    std::vector<Node> nodes_;
};

/// Faces as triangles along the diagonals of quad_split.h, with the face of each.
/// @param points #V×3
std::vector<std::array<int, 3>> as_triangles(const FaceList& faces, const Positions& points,
                                             std::vector<int>& face_of_triangle);

}  // namespace beltrami
