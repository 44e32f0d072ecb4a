#pragma once

#include <span>
#include <vector>

#include <beltrami/curves/surface_curve.h>

namespace beltrami {

/// A mesh cut open along curves: its vertices have a copy on each side, ends of curves inside have one.
struct MeshCutOpen {
    Mesh mesh;                  ///< faces in their order
    std::vector<int> vertices;  ///< of the whole mesh, for each vertex
    /// Of every curve the copies of its vertices on its left, and on its right.
    std::vector<std::vector<int>> left, right;
    /// Of every curve a face to its left, and one to its right; −1 where there is none.
    std::vector<int> left_face, right_face;
};

/// @param curves chains of edges of the mesh that do not meet
MeshCutOpen cut_along(const Mesh& mesh, std::span<const MeshWithCurves::Chain> curves);

}  // namespace beltrami
