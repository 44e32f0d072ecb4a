#pragma once

#include <vector>

#include <beltrami/constraints/boundary_condition.h>

namespace beltrami {

/// What a boundary condition says about an inner edge.
enum class EdgeConstraint : unsigned char {
    none,
    on_line,  ///< both ends are held to one line (or one is, and the other is pinned on it): the edge slides along it
    pinned,   ///< both ends are pinned, and with them the edge
};

/// #E constraints of topology's edges; none for edges of the boundary, and none where both ends lie on the boundary:
/// that they are pinned there says nothing about what is between them.
/// @pre validate(boundary, source)
std::vector<EdgeConstraint> edge_constraints(const BoundaryCondition& boundary, const Surface& source);

/// A chain of inner edges with the same constraint, as long as it can be: it ends where it ends, at the boundary, where
/// more than two constrained edges meet or two of different kinds, and at pinned vertices on lines.
struct ConstraintCurve {
    std::vector<int> vertices;  ///< along the curve; the first is the last again where it is closed
    EdgeConstraint kind;
    bool closed() const { return vertices.front() == vertices.back(); }
};

/// The curves, by their smallest first vertex. Of an open curve the smaller end comes first, a closed one begins at its
/// smallest vertex.
std::vector<ConstraintCurve> constraint_curves(const BoundaryCondition& boundary, const Surface& source);

}  // namespace beltrami
