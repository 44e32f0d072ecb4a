#pragma once

#include <beltrami/base/public.h>
#include <beltrami/mesh/mesh.h>

namespace beltrami BELTRAMI_PUBLIC {

/// Sphere from an icosahedron, its triangles split into four @p levels times: 20·4^levels triangles, 12 vertices of
/// degree 5, the rest of degree 6. Vertices of every level keep their index on the next.
/// @throw Error bad_option unless 0 ≤ levels ≤ 11 and radius > 0
Mesh icosahedral_sphere(int levels, double radius = 1.0);

/// Sphere from an octahedron: 8·4^levels triangles; the coordinate planes are made of edges. The vertices 0 … 5 are +x,
/// −x, +y, −y, +z, −z.
/// @throw Error bad_option unless 0 ≤ levels ≤ 11 and radius > 0
Mesh octahedral_sphere(int levels, double radius = 1.0);

}  // namespace beltrami
