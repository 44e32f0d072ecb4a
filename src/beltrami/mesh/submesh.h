#pragma once

#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/mesh/mesh.h>

namespace beltrami BELTRAMI_PUBLIC {

/// A part of a mesh, and where its vertices and faces come from. Order is that of the whole mesh.
struct Submesh {
    Mesh mesh;
    std::vector<int> vertices;  ///< vertex of the whole mesh, for each vertex of the part
    std::vector<int> faces;     ///< face of the whole mesh, for each face of the part
};

/// The given faces and the vertices they name. Texture coordinates come along.
/// @param faces ascending faces of @p mesh
/// @pre indices of the faces are in range; texture coordinates, if any, have one index per corner
Submesh keep_faces(const Mesh& mesh, const std::vector<int>& faces);

/// The faces of every component, ascending, components by their first faces. Faces are connected across edges, so parts
/// that touch in a vertex alone come apart.
/// @pre indices of the faces are in range
std::vector<std::vector<int>> component_faces(const Mesh& mesh);

/// The component with the most faces (of equals, the one with the first face). Faces are connected across edges, so
/// parts that touch in a vertex alone come apart.
/// @pre indices of the faces are in range
Submesh largest_component(const Mesh& mesh);

/// The mesh without the vertices that no face names.
/// @pre indices of the faces are in range
Submesh remove_unreferenced(const Mesh& mesh);

}  // namespace beltrami
