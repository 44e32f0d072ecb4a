#pragma once

#include <vector>

#include <Eigen/Core>

#include <beltrami/base/public.h>
#include <beltrami/hyperbolic/hyperbolic_surface.h>

namespace beltrami BELTRAMI_PUBLIC {

/// A map from the vertices of a surface to a closed surface with a metric of curvature −1, with its homotopy class:
/// lifted to the hyperbolic plane it is equivariant. All is local: along every edge i → j of the source it says where
/// the image of j, with a frame, is seen from the frame at the image of i.
struct EquivariantMap {
    std::vector<DiskIsometry> steps;  ///< #E along the edges of the topology, from the smaller vertex to the larger
    /// #E×2g: what the target's closed forms (HomologyBasis::cochains) add up to along the image of an edge; once the
    /// map has moved still the class, but for a coboundary.
    Eigen::MatrixXi classes;
    std::vector<int> bases;            ///< #V vertices of the target
    std::vector<DiskIsometry> frames;  ///< #V the image and its frame, seen from the frame of the target at its base
};

/// The edge between two vertices, −1 if there is none.
int edge_between(const Topology& topology, int a, int b);

/// The step along a face's corner: from its vertex to the next one.
DiskIsometry step_at_corner(const Surface& source, const EquivariantMap& map, int corner);

/// How far the product of the steps around every face is from the identity (#F): 0 but for rounding where there is a
/// map.
Eigen::VectorXd flatness(const Surface& source, const EquivariantMap& map);

/// What the map does to homology: column j of the result has the periods of the target's form j around the images of
/// the source's loops.
/// @param loops of the source
Eigen::MatrixXi periods_of_images(const Topology& source, const EquivariantMap& map,
                                  const std::vector<std::vector<int>>& loops);

}  // namespace beltrami
