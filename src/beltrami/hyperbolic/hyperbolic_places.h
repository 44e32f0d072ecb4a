#pragma once

#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/hyperbolic/equivariant_map.h>
#include <beltrami/locate/planar_locator.h>

namespace beltrami BELTRAMI_PUBLIC {

/// Where a map takes the vertices, on the faces of the target: a walk in its hyperbolic Delaunay triangulation, whose
/// triangles are never inverted, then back through Ptolemy's flips, by barycentric weights of light-cone vectors, and
/// through the flips of the surface itself (before_flips). Between its corners a triangle of the target stands for the
/// hyperbolic one by the circumcircle preserving projective map. Of a target with a boundary what lies beyond is seen
/// in the mirror.
/// @return #V
/// @throw Error not_solved naming vertices for which the walk does not end
std::vector<MeshPoint> places_of(const HyperbolicSurface& target, const EquivariantMap& map);

}  // namespace beltrami
