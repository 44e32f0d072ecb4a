#pragma once

#include <beltrami/charts/chart.h>

namespace beltrami {

/// The coefficient of a map averaged over vertex stars in the natural coordinate of a quadratic differential φ.
///
/// In ζ = ∫√φ dz a map has ∂f/√φ and ∂̄f/conj(√φ). Their means over a star with the weight |φ| are those of
/// conj(√φ) ∂f and √φ ∂̄f, which are integrals along the star's boundary: the noise that a piecewise linear map has
/// inside does not enter. Averaging in a fixed frame instead would lose the part of μ that turns with φ. A sample gets
/// the mean of its vertices. At a strongly stretched map μ of the faces is so noisy that (1+|μ|²)/(1−|μ|²) is biased;
/// with this coefficient it is not (docs/homotopy.md).
///
/// Stars in which √φ has no common branch (around a zero of φ) take no part; a sample with such vertices only keeps its
/// own μ. Samples that the chart excludes do not enter and keep their own.
/// @param phi #S in the samples' frames
/// @param map #V
/// @return #S in the samples' frames, meant at the centroids; estimates, not the coefficient of any map
Eigen::VectorXcd averaged_coefficient(const Surface& source, const Chart& chart, const Eigen::VectorXcd& phi,
                                      const Eigen::VectorXcd& map);

}  // namespace beltrami
