#pragma once

#include <vector>

#include <Eigen/Core>

#include <beltrami/base/public.h>
#include <beltrami/mesh/mesh.h>

namespace beltrami BELTRAMI_PUBLIC {

/// The map to the plane that a mesh has as its texture coordinates, one point a vertex: what is written with a map as
/// vt. 0 at vertices without faces.
/// @return #V
/// @throw Error bad_mesh if there are none, a corner lacks one, one is not finite, or a vertex has several (a seam),
///        naming vertices
Eigen::VectorXcd texture_map(const Mesh& mesh);

/// The charts that texture coordinates divide a mesh into: faces that meet at a vertex with one texture point there are
/// in one chart.
/// @return the faces of every chart, ascending; charts by their first faces
/// @pre every corner has texture coordinates
std::vector<std::vector<int>> texture_charts(const Mesh& mesh);

/// The mesh cut open along the seams of texture coordinates: a vertex for every point of the texture, at the place of
/// the vertices that name it, and the faces between these in their order.
/// @pre every corner has a point, and a point belongs to one vertex
Mesh cut_along_seams(const Mesh& mesh, const TextureCoordinates& texture);

}  // namespace beltrami
