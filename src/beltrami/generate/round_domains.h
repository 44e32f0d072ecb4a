#pragma once

#include <beltrami/base/public.h>
#include <beltrami/mesh/mesh.h>
#include <beltrami/meshing/jitter.h>

namespace beltrami BELTRAMI_PUBLIC {

/// The disk |z| ≤ radius in concentric rings: ring k has 6k vertices, so all edges have nearly the length radius/rings
/// and no angle is below 43 degrees. Vertex 0 is the centre; rings follow from the inside, counter-clockwise from the
/// positive x-axis; the last 6·rings vertices are the boundary.
/// @param rings  at least 1; the mesh has 6·rings² triangles
/// @param radius positive
/// @return #V×2 mesh, counter-clockwise
/// @throw Error bad_option for an impossible size, or more than 300 million triangles
Mesh disk(int rings, double radius = 1.0, const JitterOptions& jitter = {});

/// Rings of a disk whose edges are about @p edge_length long.
int disk_rings_for_edge_length(double edge_length, double radius = 1.0);
/// Rings of a disk that has about so many triangles.
int disk_rings_for_triangles(double triangles);

/// The annulus inner ≤ |z| ≤ outer, with radii in geometric progression and every other ring turned by half a step, so
/// that the triangles are nearly equilateral in log z. Rings follow from the inside. For edges of one length everywhere
/// take circle_domain instead.
/// @param around vertices of each ring, at least 3
/// @param layers layers of triangles; 0: as many as make them equilateral, at least 2
/// @return #V×2 mesh, counter-clockwise, with 2·around·layers triangles
/// @throw Error bad_option unless 0 < inner < outer
Mesh annulus(double inner, double outer, int around, int layers = 0, const JitterOptions& jitter = {});

}  // namespace beltrami
