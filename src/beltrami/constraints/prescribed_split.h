#pragma once

#include <array>
#include <optional>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/constraints/boundary_condition.h>

namespace beltrami BELTRAMI_PUBLIC {

/// A mesh on which no face and no bridge is wholly prescribed.
struct SplitProblem {
    Mesh mesh;                        ///< the old vertices first, unchanged and in order; then the added ones
    std::optional<Positions> metric;  ///< of the new mesh: one point per face corner, if the surface had them
    /// For each added vertex (vertex #V_old + i) the 2 (edge midpoint, then -1, -1) or 4 (quad centre) old vertices
    /// whose mean it is. Midpoints come first, in the order of topology's edges, then centres in the order of the
    /// faces.
    std::vector<std::array<int, 4>> parents;
    std::vector<int> face_parents;  ///< old face of each new face
    int split_edges = 0;            ///< 0: the mesh is the old one
};

/// Splits, at their midpoints, the interior edges that a prescription would otherwise nail down. The image of such an
/// edge is the straight segment between two prescribed points, and the Beltrami coefficient of a face with all vertices
/// prescribed is fixed: no solver can repair either. An interior edge with both ends prescribed is split if
/// - both ends are boundary vertices (a bridge; the third edge of an ear is one), or
/// - it is the longest interior edge (of equals, the one of smallest index) of a face all of whose vertices are
///   prescribed and that has no bridge, or
/// - its straight image meets the image of a prescribed boundary edge, a prescribed vertex, or the straight image of
///   another such edge, other than at a common end.
/// All other edges with both ends pinned stay, so that a pinned feature curve remains one. A face without interior
/// edges stays. Triangles beside a split edge become 2, 3 or 4 triangles; quads become triangles around a new centre.
/// Texture coordinates and a custom metric are carried along: each new corner is the mean of old corners of its face.
/// Afterwards every face beside a split edge has a free vertex, and no added edge joins two prescribed vertices.
/// @pre validate(boundary, source)
SplitProblem split_prescribed(const Surface& source, const BoundaryCondition& boundary);

/// Splits the interior edges that join two boundary vertices, at their midpoints, as split_prescribed does: for maps
/// whose boundary vertices lie on curves, wherever they are there.
/// @pre source has a boundary
SplitProblem split_bridges(const Surface& source);

}  // namespace beltrami
