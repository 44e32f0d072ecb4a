#pragma once

#include <optional>

#include <beltrami/operators/surface.h>

namespace beltrami {

/// The conformal map of a disk-like surface to the unit disk, 0 at the vertex deepest inside, by the discrete Green
/// function G with its source at that vertex: exp(−G − iG*), with the rim turned by the flux of G.
///
/// The Laplacian is that of the intrinsic Delaunay triangulation (Bobenko & Springborn 2007), none of whose weights is
/// negative. So G and its flux are positive and known to relative precision however small they are, where other
/// constructions take differences of numbers of order one: the rim runs forward even where crowding leaves it parts of
/// 1e-12. Inside, the map is the harmonic extension. The source smears over one edge, so that the map is less accurate
/// near it than that of greens_function.h.
/// @param factorizations counts those made
/// @return #V, |g| = 1 on the rim; nothing where there is no inner vertex or where some part of the rim has no flux
/// @pre one component, one boundary loop, genus 0; quads are taken as their triangles
std::optional<Eigen::VectorXcd> disk_map_by_vertex_source(const Surface& source, int* factorizations);

}  // namespace beltrami
