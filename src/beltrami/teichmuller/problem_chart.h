#pragma once

#include <optional>
#include <vector>

#include <beltrami/charts/shape.h>
#include <beltrami/constraints/boundary_corners.h>
#include <beltrami/solve/beltrami_solver.h>

namespace beltrami {

struct ProblemChart {
    Chart chart;
    /// A plane source's own coordinates, where the chart is far from conformal: φ that has poles at corners does better
    /// in these, one that is smooth in the canonical domain does not.
    std::optional<Chart> instead;
};

/// The chart in which φ of a problem is built: the canonical domain of the source, or a plane source's own coordinates
/// where its outer loop is a polygon of few sharp corners.
/// @param corners of the source and its boundary values
/// @param solver  of the problem, factorised for the coefficient 0
/// @param shape   the source with its charts; null: there is none
/// @throw Error as domain_chart
ProblemChart chart_of_problem(const Surface& source, const BoundaryCondition& boundary,
                              const std::vector<BoundaryCorner>& corners, int outer_loop, const BeltramiSolver& solver,
                              const Shape* shape = nullptr);

}  // namespace beltrami
