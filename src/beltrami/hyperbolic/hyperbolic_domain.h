#pragma once

#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/hyperbolic/hyperbolic_surface.h>
#include <beltrami/operators/distortion.h>

namespace beltrami BELTRAMI_PUBLIC {

/// A surface with a metric of curvature −1 cut open and laid out in the unit disk, and its fundamental group.
struct HyperbolicDomain {
    /// Where the faces lie: in one piece, each joined to the neighbour through which its middle is nearest to 0. A
    /// vertex has several points on the cut.
    TextureCoordinates layout;
    Distortion
        distortion;  ///< of the map to the layout, face by face; faces that lost an edge to a flip may be flipped
    /// Closed paths of vertices through one vertex, the generators: 2g of a closed surface, 1 − χ of one with a
    /// boundary, whose group is free.
    std::vector<std::vector<int>> paths;
    std::vector<DiskIsometry> generators;  ///< seen from that vertex
    std::vector<double> lengths;           ///< of the closed geodesics in their classes
    double relation = 0;  ///< how far the product around the cut surface is from the identity, where it is closed
    std::vector<double> boundary_lengths;  ///< of the boundary loops, which are closed geodesics
};

/// @param metric of the surface
HyperbolicDomain hyperbolic_domain(const Surface& surface, const HyperbolicSurface& metric);

}  // namespace beltrami
