#pragma once

#include <beltrami/constraints/boundary_condition.h>

namespace beltrami {

/// A map with prescribed vertices whose other vertices follow them: the similarity of the source that fits the images
/// best, and the harmonic displacement (natural where the boundary is free) that takes the rest of the way. It turns
/// and stretches no more than its data do, whereas the least-squares conformal map continues them as a holomorphic
/// function would, to zeros of its derivative or beyond: a start for data on a part of the boundary.
/// @param places #V the source in the plane, its own coordinates or a conformal image
/// @return #V; vertices on lines lie on them
/// @pre two or more images or lines; one component
/// @throw Error not_solved
Eigen::VectorXcd displacement_start(const Surface& source, const Eigen::VectorXcd& places,
                                    const BoundaryCondition& boundary);

}  // namespace beltrami
