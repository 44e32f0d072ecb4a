#pragma once

#include "gallery/gallery.h"

#include <beltrami/flow/slid_map.h>

namespace beltrami::gallery {

struct Descent {
    Eigen::VectorXcd map;
    int iterations = 0;
    double value = 0;  ///< of the energy in the end
};

/// Least Σ A |μ|^p/Σ A over the inner vertices by a quasi-Newton method (L-BFGS), as Weber, Myles & Zorin try it (their
/// Figure 11): finite on folds, not convex.
Descent least_power(const Surface& surface, const BoundaryCondition& boundary, const Eigen::VectorXcd& start, double p,
                    int max_iterations);

/// Least t with |μ| ≤ t on every face by an interior point method: t − ε mean log(t² − |μ|²) by L-BFGS for falling ε.
Descent least_largest(const Surface& surface, const BoundaryCondition& boundary, const Eigen::VectorXcd& start,
                      int max_iterations);

/// Least (Σ A |μ_f − ν|^p/Σ A)^{1/p} over the maps whose boundary vertices slide along their curves: the problem (24)
/// of Ng, Gu & Lui for the power p, by L-BFGS.
/// @param start with boundary vertices on the curves of @p target
Descent nearest_coefficient(const Surface& source, const TargetDomain& target, const SlidMap& start,
                            const Eigen::VectorXcd& nu, double p, int max_iterations);

}  // namespace beltrami::gallery
