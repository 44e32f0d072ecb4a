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
    std::vector<std::vector<int>> paths;   ///< 2g closed paths of vertices through one vertex: the generators
    std::vector<DiskIsometry> generators;  ///< seen from that vertex
    std::vector<double> lengths;           ///< of the closed geodesics in their classes
    double relation = 0;                   ///< how far the product around the cut surface is from the identity
};

/// @param metric of the surface
HyperbolicDomain hyperbolic_domain(const Surface& surface, const HyperbolicSurface& metric);

}  // namespace beltrami
