#pragma once

#include <beltrami/base/public.h>
#include <beltrami/constraints/boundary_condition.h>

namespace beltrami BELTRAMI_PUBLIC {

/// Seconds of one harmonic map of a loaded mesh: operators, ordering, analysis, assembly, factorisation and solution,
/// with the ordering and threads that the solvers use; median of three. The yardstick for other times.
double harmonic_seconds(const Surface& source, const BoundaryCondition& boundary);

}  // namespace beltrami
