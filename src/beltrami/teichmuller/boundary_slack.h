#pragma once

#include <beltrami/charts/chart.h>
#include <beltrami/constraints/boundary_condition.h>

namespace beltrami {

/// Boundary values whose points have moved along the target.
struct SlackBoundary {
    BoundaryCondition boundary;
    double energy_before = 0, energy_after = 0;  ///< E, below
    double largest_move = 0;                     ///< of a point, in edges of its own
};

/// The boundary values of least energy among those whose points move along the target by at most @p slack edges (half
/// the two edges of the image beside a point). A scan's outline is known to an edge at best, and what single edges say
/// costs much dilatation.
///
/// E(u) = Σ_{i<j} w_ij (u_i − u_j)², u = log(dt/dθ) on the edges of the loop, t the length along the target, θ the
/// angle in the chart, and w_ij = ∬ dθ dθ'/4 sin²((θ − θ')/2): the square of the H^½ norm, which no Möbius map of the
/// disk changes, of the Weil-Petersson metric of universal Teichmüller space (Nag & Sullivan 1995). u is linearised, up
/// to eight times, and every step is a quadratic problem in a box, solved by an interior point method; couplings of
/// edges more than 16 apart are left out there.
///
/// The target is the circle on which the images lie; else the polygon of the images where that has a corner, and
/// corners do not move; else the spline through them.
/// @param chart a chart of the round disk, whose rim runs forward
/// @param slack 0 < slack
/// @throw Error bad_boundary if the rim does not run forward in the chart, or the images do not run along a simple
/// curve
/// @pre one boundary loop, all of it prescribed
SlackBoundary slacken(const Surface& source, const Chart& chart, const BoundaryCondition& boundary, double slack);

/// E of the outline seen in blocks of four edges, as part of E: near 1 where boundary values vary slowly against the
/// edges, near 0 where most of E is what single edges say. No system is solved for it.
/// @throw Error as slacken
/// @pre as slacken
double energy_of_blocks(const Surface& source, const Chart& chart, const BoundaryCondition& boundary);

}  // namespace beltrami
