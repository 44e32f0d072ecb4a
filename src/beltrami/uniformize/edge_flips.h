#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include <beltrami/uniformize/intrinsic_triangulation.h>

// What is carried from a triangulation through flips of its edges, and back.

namespace beltrami {

/// Closed 1-forms through flips: a flipped edge has the value of the way around it.
/// @param flips in their order
/// @param forms #halfedges×n, values of every half-edge from its tail to its head; opposite on the twin, and adding up
///              to 0 around every triangle
void carry_forms(const std::vector<EdgeFlip>& flips, Eigen::MatrixXd& forms);

/// A point of an intrinsic triangulation: the weights, 1 in all, of the tails of a triangle's half-edges.
struct IntrinsicPoint {
    int triangle = -1;
    std::array<double, 3> weights{};
};

/// Points of a triangulation in the one that it was before its flips: the two triangles of every flipped edge are laid
/// out in the plane, and the points between them are found in the other two. Weights stay between 0 and 1.
/// @param flipped after the flips
/// @param flips   in their order, new lengths measured by unfolding (IntrinsicTriangulation::delaunay_flips)
std::vector<IntrinsicPoint> before_flips(IntrinsicTriangulation flipped, const std::vector<EdgeFlip>& flips,
                                         std::vector<IntrinsicPoint> points);

}  // namespace beltrami
