#pragma once

#include <beltrami/constraints/boundary_condition.h>
#include <beltrami/differentials/differential_space.h>
#include <beltrami/teichmuller/extremal_map.h>

namespace beltrami {

/// Raises the residual of the result's map to the largest distance of one of these vertices from its image.
void record_residual(const BoundaryCondition& boundary, ExtremalMap& result);

/// K_max and the bound that a map itself is, of which the result has the distortion (attained_dilatation.h).
void record_attained(const Surface& source, const Eigen::VectorXcd& map, ExtremalMap& result);

/// K, k and the bounds of a map some of whose boundary slides.
/// @param k of its last c-step
void record_sliding_bounds(const Surface& source, const Eigen::VectorXcd& map, const ReichStrebel& integrals, double k,
                           ExtremalMap& result);

/// Of the space of differentials at the end what the result says where boundaries slide.
/// @param expected_dimension where theory says it
void record_space(const DifferentialSpace& space, std::optional<int> expected_dimension, ExtremalMap& result);

/// The warnings about a map that is not one-to-one, has not settled or is far from constant dilatation.
void record_shortcomings(ExtremalMap& result);

/// Takes back that a map has converged where nothing confirms it: faces are flipped, or K is more than a tenth above
/// every lower bound. The last word on a result, after all bounds.
void withdraw_unconfirmed(ExtremalMap& result);

/// The warning about single faces that are stretched far more than the extremal map is.
void warn_of_crushed_faces(ExtremalMap& result);

}  // namespace beltrami
