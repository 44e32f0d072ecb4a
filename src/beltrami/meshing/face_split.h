#pragma once

#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/mesh/mesh.h>

namespace beltrami BELTRAMI_PUBLIC {

/// A mesh some faces of which were cut into triangles. Order is kept, texture coordinates come along.
struct SplitMesh {
    Mesh mesh;
    std::vector<int> faces;  ///< the face of the old mesh, for each face
    std::vector<int> cut;    ///< those of the old mesh that were cut, ascending
};

/// Cuts faces with more than four corners (split_polygon).
/// @pre indices of the faces are in range; texture coordinates, if any, have one index per corner
SplitMesh split_large_faces(const Mesh& mesh);

/// Cuts the faces of a list: quads by split_quad(), those with more corners by split_polygon().
/// @param faces ascending
/// @pre as above
SplitMesh split_faces(const Mesh& mesh, const std::vector<int>& faces);

/// Cuts what the operators do not take: faces with more than four corners, and quads that fold (faces_without_area),
/// these by split_quad().
/// @pre as above
SplitMesh split_unusable_faces(const Mesh& mesh);

/// Cuts all faces with more than three corners, quads by split_quad().
/// @pre as above
SplitMesh split_into_triangles(const Mesh& mesh);

}  // namespace beltrami
