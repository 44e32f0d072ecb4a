#pragma once

#include <array>
#include <span>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/locate/planar_locator.h>
#include <beltrami/mesh/mesh.h>

namespace beltrami BELTRAMI_PUBLIC {

/// The texture coordinates of a mesh whose vertices have moved along it, so that the picture on the surface stays where
/// it is. On both sides of a seam along which a vertex has slid they come from faces of that side; where a vertex has
/// left its seam, from the face that is nearest in the texture.
/// @param mesh   before the motion, with texture coordinates at every corner
/// @param places #V where the vertices are now
/// @throw Error bad_option if there are not #V places
TextureCoordinates carried_texture(const Mesh& mesh, std::span<const MeshPoint> places);

/// Values of the vertices (#V×any) at their places: linear on the triangles.
Positions carried_values(const Positions& values, std::span<const MeshPoint> places);

/// Edges along which texture coordinates have a seam, as pairs of vertices, the smaller first; none without texture.
std::vector<std::array<int, 2>> seam_edges(const Mesh& mesh);

}  // namespace beltrami
