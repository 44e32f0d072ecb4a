#pragma once

#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/hyperbolic/hyperbolic_domain.h>

namespace beltrami BELTRAMI_PUBLIC {

/// A convex polygon of geodesics in the unit disk with the metric 2|dz|/(1 − |z|²).
struct HyperbolicPolygon {
    std::vector<DiskIsometry> sides;  ///< counter-clockwise, each the part of the bisector between 0 and where this
                                      ///< isometry takes 0
    std::vector<Complex> corners;     ///< corner i is where side i begins
    double area = 0;                  ///< (n − 2)π less the angles

    /// Points of a side from its corner on, the next corner included.
    std::vector<Complex> points_of_side(std::size_t side, int pieces) const;
};

/// The Dirichlet polygon about 0 of a group of isometries: the points that are nowhere nearer to another image of 0.
/// Its copies fill the disk without overlap.
/// @param generators of the group
/// @param area       of its quotient: what tells that no side is missing
/// @return without sides where they were not all found
HyperbolicPolygon dirichlet_polygon(const std::vector<DiskIsometry>& generators, double area);

}  // namespace beltrami
