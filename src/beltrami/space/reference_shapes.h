#pragma once

#include <Eigen/Core>

#include <beltrami/base/public.h>
#include <beltrami/mesh/mesh.h>

namespace beltrami BELTRAMI_PUBLIC {

// Shapes that the faces of a mesh ought to have: one point of the plane per face corner (#corners×2), a metric for
// corner_elements() or Surface.

/// Regular polygons of side 1: equilateral triangles, squares.
Positions regular_shapes(const FaceList& faces);

/// Shapes by the valences of the vertices: at a vertex of m faces every angle ought to be 2π/m, π/m on the boundary.
/// Where one angle of a face is the largest, and not above 162 degrees, it is kept and the others are scaled, else all
/// are. Source: Gruber, Aulisa 2022, Algorithm 5; its four angles do not make a quad, which here is the one
/// around a circle.
/// @throw Error bad_mesh as topology()
Positions valence_shapes(const Mesh& mesh);

/// Shapes by angles: of a triangle its own, of a polygon with more corners the one around a circle that has them. All
/// have the area of a regular one with side 1.
/// @param angles #corners, radians, positive, below π; of every face they add up to (n−2)π
/// @throw Error bad_option naming the faces of which they do not
Positions shapes_from_angles(const FaceList& faces, const Eigen::VectorXd& angles);

}  // namespace beltrami
