#pragma once

#include <vector>

#include <beltrami/conformal/chart.h>
#include <beltrami/maps/beltrami_solver.h>
#include <beltrami/maps/boundary_corners.h>

namespace beltrami {

/// The chart in which φ of a problem is built: the canonical domain of the source, or a plane source's own coordinates
/// where poles in these do better: its outer loop is a polygon of few sharp corners, or the canonical chart is far from
/// conformal.
/// @param corners of the source and its boundary values
/// @param solver  of the problem, factorised for the coefficient 0
/// @throw Error as domain_chart
Chart chart_of_problem(const Surface& source, const BoundaryCondition& boundary,
                       const std::vector<BoundaryCorner>& corners, int outer_loop, const BeltramiSolver& solver);

}  // namespace beltrami
