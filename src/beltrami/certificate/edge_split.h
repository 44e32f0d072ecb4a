#pragma once

#include <array>
#include <vector>

#include <beltrami/constraints/boundary_condition.h>

namespace beltrami {

/// A problem on a mesh of the same surface some of whose edges are halved. Boundary values are linear along the old
/// edges, so the problem is the same.
struct SplitEdges {
    Surface surface;
    BoundaryCondition boundary;
    std::vector<int> parents;  ///< #F old face of each new one
    /// #corners: places in the old face (barycentric coordinates).
    std::vector<std::array<double, 3>> places;
    std::vector<std::array<int, 4>> ends;  ///< of the halved edges, as parents of the new vertices in SubdividedMesh
};

/// Halves edges; faces with one, two or three such edges become two, three or four. Old vertices come first, then the
/// midpoints in the order of topology's edges.
/// @param marked #E
/// @pre all faces are triangles; the whole boundary is prescribed
SplitEdges split_edges(const Surface& source, const BoundaryCondition& boundary, const std::vector<char>& marked);

}  // namespace beltrami
