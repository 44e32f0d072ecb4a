#pragma once

#include <beltrami/base/public.h>
#include <beltrami/charts/chart.h>
#include <beltrami/solve/beltrami_solver.h>

namespace beltrami BELTRAMI_PUBLIC {

struct RoundDiskOptions {
    int sliding_steps = 0;    ///< Newton steps of the sliding boundary after the linear solve (docs/conformal.md)
    double tolerance = 1e-9;  ///< stop sliding when no boundary vertex turns by more (radians)
};

/// The conformal map of a disk-like surface to the round unit disk, normalised so that the source's area is centred at
/// 0.
///
/// A planar source whose boundary already lies on a circle is only moved and scaled (exact = true). A large surface is
/// mapped by its own Green's function (disk_map_by_greens_function). Otherwise the surface is flattened (flatten), and
/// g = (w − p) exp(h + i h*) with h harmonic, h = −log|w − p| on the boundary, so |g| = 1 there: Riemann's construction
/// by Green's function. If faces come out flipped, h* is found more carefully (ConjugateBy::system), and the better
/// chart is kept; if there are some still, by a source at a vertex (vertex_source.h), and the chart is kept that turns
/// over less of itself. Then, optionally, sliding steps: boundary vertices move along the circle,
/// three of them held, to minimise the conformal energy.
/// @pre one component, one boundary loop, genus 0
/// @throw Error bad_mesh, not_solved
Chart round_disk_chart(const Surface& source, const RoundDiskOptions& options = {});

/// The same, where a solver that fixes exactly the boundary is already factorised for the coefficient 0: the harmonic
/// extensions are solved with it.
Chart round_disk_chart(const Surface& source, const BeltramiSolver& dirichlet, const RoundDiskOptions& options = {});

/// Turns a disk's points by the Möbius map that brings their weighted mean to 0 (Douady & Earle's conformal barycentre,
/// by fixed-point iteration).
void centre_in_disk(Eigen::VectorXcd& points, const Eigen::VectorXd& weights);

}  // namespace beltrami
