#pragma once

#include <beltrami/base/public.h>
#include <beltrami/mesh/mesh.h>

namespace beltrami BELTRAMI_PUBLIC {

/// The composition g∘f at the vertices of f's source: f goes to the plane, g is given at the vertices of a planar mesh
/// and linear between them. Images of f outside that mesh are taken to its nearest boundary point, if it is near.
/// @param f         images of f, any number
/// @param middle    planar mesh that f maps into
/// @param g         #V values at middle's vertices
/// @param tolerance how far outside a point may lie, as part of middle's diameter (a polygon misses its circle by a
/// little)
/// @throw Error bad_mesh if middle is not planar; bad_boundary naming the points that lie too far outside
Eigen::VectorXcd compose_maps(const Eigen::VectorXcd& f, const Mesh& middle, const Eigen::VectorXcd& g,
                              double tolerance = 1e-3);

}  // namespace beltrami
