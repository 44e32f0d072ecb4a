#pragma once

#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/meshing/face_split.h>
#include <beltrami/operators/surface.h>

namespace beltrami BELTRAMI_PUBLIC {

/// Whether a mesh has faces with more than four corners.
bool has_polygons(const Mesh& mesh);

/// A surface whose faces may have any number of corners, for what takes its elements from corner_elements.h: remesh(),
/// DeformSolver, LeastSquaresMap. Where a face has more than four, operators are those of its corner triangles; solvers
/// of maps to the plane expect triangles and quads. Without such faces it is Surface(mesh).
/// @throw Error bad_mesh as Surface, by its triangles; naming polygons that are not convex at a corner
Surface polygon_surface(Mesh mesh);

/// Faces with four corners or more of which a corner triangle has no area or is turned over against the face: reflex,
/// folded or self-crossing ones, ascending.
std::vector<int> folded_corner_faces(const Mesh& mesh);

/// Cuts these faces, and no others, into triangles.
SplitMesh split_folded_polygons(const Mesh& mesh);

}  // namespace beltrami
