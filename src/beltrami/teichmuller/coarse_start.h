#pragma once

#include <beltrami/teichmuller/extremal_map.h>
#include <beltrami/teichmuller/hamilton.h>

namespace beltrami {

/// A start for the iteration on a large mesh: the same problem solved on a coarse mesh of the canonical domain. φ and k
/// do not depend on the mesh, so they carry over as they are, and the fine mesh sees few factorisations.
/// @return no space if the mesh is small, or its boundary does not run monotonically around the canonical disk
HamiltonState coarse_start(const Surface& source, const BoundaryCondition& boundary, const Chart& chart, double phase,
                           const ExtremalOptions& options);

}  // namespace beltrami
