#pragma once

#include <optional>

#include <beltrami/constraints/boundary_condition.h>

namespace beltrami {

enum class ConvexWeights {
    uniform,     ///< Tutte, How to draw a graph, 1963: the mean of the neighbours
    mean_value,  ///< Floater, Mean value coordinates, 2003: exact for maps that are affine
};

/// Every vertex that is not prescribed in the mean, with positive weights, of its neighbours across edges (of a quad:
/// its sides). Where the boundary of a disk goes to a convex polygon no face folds, whatever its shape, and none
/// collapses unless an edge inside joins boundary vertices of one side of the polygon (Tutte 1963; Floater 1997).
/// Mean value weights are those of the metric, tan(α/2) of the angles α beside an edge over its length; their system is
/// not symmetric. Lines are not treated.
/// @pre every component has a prescribed vertex
/// @return #V; unreferenced vertices at 0
/// @throw Error not_solved
Eigen::VectorXcd convex_combination_map(const Surface& source, const BoundaryCondition& boundary,
                                        ConvexWeights weights);

/// Whether the one boundary loop of a disk is wholly prescribed and goes once around a convex polygon,
/// counter-clockwise and straight at some vertices at most, and nothing else is prescribed.
bool has_convex_target(const Surface& source, const BoundaryCondition& boundary);

/// A map without folds of a problem with a convex target: Tutte's, or that with mean value weights where rounding makes
/// folds of the tiny faces of the other; nothing without a convex target, or where both have folds. Adds to
/// @p factorizations.
std::optional<Eigen::VectorXcd> convex_embedding(const Surface& source, const BoundaryCondition& boundary,
                                                 int& factorizations);

}  // namespace beltrami
