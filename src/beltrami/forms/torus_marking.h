#pragma once

#include <Eigen/Core>

#include <beltrami/base/complex.h>
#include <beltrami/base/public.h>

namespace beltrami BELTRAMI_PUBLIC {

/// Generators of a lattice, or where a map sends those of one torus, in terms of other generators a, b (columns): an
/// integer matrix of determinant 1.
using TorusMarking = Eigen::Matrix2i;

/// τ in the basis with these columns: (m₀₁ + m₁₁ τ)/(m₀₀ + m₁₀ τ).
/// @param tau in the basis a, b: the period of b where that of a is 1; above the real axis
Complex tau_in_basis(Complex tau, const TorusMarking& basis);

/// The basis in which τ lies in the fundamental domain |Re τ| ≤ ½, |τ| ≥ 1 of the modular group (to 1e-12; on its
/// border either of two).
TorusMarking reducing_basis(Complex tau);

/// Distance in the upper half-plane, curvature −1: 2 arsinh(|a − b| / 2√(Im a Im b)).
double hyperbolic_distance(Complex a, Complex b);

/// The marking for which the tori of two τ are nearest: it minimises the distance between @p from and
/// tau_in_basis(to, marking). Of a marking and its negative, which differ by z → −z, the first number that is not 0 is
/// positive; of several (to 1e-12) the identity, if it is one of them, else any. All that could be nearer are tried.
/// @pre both are above the real axis
TorusMarking nearest_marking(Complex from, Complex to);

}  // namespace beltrami
