#pragma once

#include <beltrami/base/public.h>
#include <beltrami/mesh/mesh.h>

namespace beltrami BELTRAMI_PUBLIC {

/// What the cells of a grid become.
enum class Cells { triangles, quads };

/// The rectangle [0, width] × [0, height] in nx × ny cells; vertex (i, j) has the index j·(nx+1) + i. The diagonals of
/// triangles alternate, and those of the corner cells go through the corner, so no triangle there has three boundary
/// vertices (if nx, ny ≥ 2). See jittered() for an irregular one.
/// @return #V×2 mesh, counter-clockwise
/// @throw Error bad_option for an impossible size
Mesh rectangle(double width, double height, int nx, int ny, Cells cells = Cells::triangles);

/// Torus of revolution about the z-axis: ((R + r cos v) cos u, (R + r cos v) sin u, r sin v), nu × nv cells; vertex (i,
/// j) at u = 2πi/nu, v = 2πj/nv has the index i·nv + j. Normals point outwards.
/// @param major R, above @p minor r
/// @throw Error bad_option for an impossible size
Mesh torus(double major, double minor, int nu, int nv, Cells cells = Cells::triangles);

/// Open cylinder about the z-axis, 0 ≤ z ≤ height, nu cells around and nz along; vertex (i, j) at u = 2πi/nu,
/// z = height·j/nz has the index i·(nz+1) + j. Normals point outwards.
/// @throw Error bad_option for an impossible size
Mesh cylinder(double radius, double height, int nu, int nz, Cells cells = Cells::triangles);

}  // namespace beltrami
