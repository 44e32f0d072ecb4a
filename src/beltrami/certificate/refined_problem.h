#pragma once

#include <beltrami/constraints/boundary_condition.h>
#include <beltrami/mesh/subdivide.h>

namespace beltrami {

/// A problem on the midpoint subdivision of its mesh. The boundary polygons are the same, and the midpoints of boundary
/// edges go to the midpoints of their images: the boundary values as functions are the same, and so is K*.
struct RefinedProblem {
    Surface surface;
    BoundaryCondition boundary;
    std::vector<std::array<int, 4>> parents;  ///< of the new vertices, as in SubdividedMesh

    /// Values at the old vertices, interpolated.
    Eigen::VectorXcd interpolated(const Eigen::VectorXcd& values) const;
};

/// @pre the whole boundary is prescribed
RefinedProblem refined_problem(const Surface& source, const BoundaryCondition& boundary);

/// The surface with every quad cut into two triangles (split_quad); vertices stay.
Surface cut_into_triangles(const Surface& source);

bool all_triangles(const Mesh& mesh);

}  // namespace beltrami
