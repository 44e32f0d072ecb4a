#pragma once

#include <limits>

#include <beltrami/teichmuller/extremal_map.h>
#include <beltrami/teichmuller/hamilton.h>

namespace beltrami {

struct CoarseStart {
    HamiltonState state;  ///< without a space if there is none
    /// Of the bracket of K with which it has settled, as part of K, times the number of triangles: of smooth problems
    /// it is the same on every mesh. ∞ if it has not settled.
    double bracket_by_triangles = std::numeric_limits<double>::infinity();
};

/// Below so many samples the coarse problem would cost as much as it saves.
constexpr int kCoarseStartPays = 6'000;
/// The same in the plane of a chart, where few iterations are left to save.
constexpr int kCoarseStartPaysInPlane = 50'000;

/// A start for the iteration on a large mesh: the same problem solved on a coarse mesh of the canonical domain, by
/// polynomials. φ and k do not depend on the mesh, so they carry over as they are, and the fine mesh sees few
/// factorisations.
/// @param largest_degree that the mesh resolves
/// @param least_samples a mesh of fewer is small
/// @param grown the space has that degree at once, and the c-step runs on cells
/// @return none if the mesh is small, or its boundary does not run monotonically around the canonical disk
CoarseStart coarse_start(const Surface& source, const BoundaryCondition& boundary, const Chart& chart, double phase,
                         int largest_degree, const ExtremalOptions& options, int least_samples = kCoarseStartPays,
                         bool grown = false);

}  // namespace beltrami
