#pragma once

#include <beltrami/base/public.h>
#include <beltrami/constraints/boundary_condition.h>

namespace beltrami BELTRAMI_PUBLIC {

/// @param mu coefficients of the source's samples
/// @throw Error bad_option unless there is one for every sample (#S), all finite and below 1 in size; the indices are
///        those of the samples that are not
void require_coefficient(const Surface& source, const Eigen::VectorXcd& mu);

/// The map f with a given Beltrami coefficient, ∂̄f = μ∂f, and given boundary values: of all maps that are linear on the
/// triangles (bilinear on the quads) and have these values the one with the least Σ A |∂̄f − μ∂f|²/(1−|μ|²), by one
/// linear solve (Ng, Gu & Lui 2014, eq. (30), the boundary held; Weber, Myles & Zorin 2012, the step for f). μ = 0
/// gives the harmonic map.
///
/// Boundary values and μ together say more than a map can obey: those with this μ differ by conformal maps of the image
/// only. Where the values are those of one of them the error is of second order in the size of the faces; where they
/// are not, the least-squares map results, whose own coefficient is another (distortion.h). Faces may be flipped
/// where the values do not belong to μ or |μ| is near 1.
///
/// Boundary vertices that are not prescribed are free (natural condition): with two pinned vertices the result is the
/// least-squares quasiconformal map. Vertices inside may be prescribed or held to lines too.
/// @param mu #S in the samples' frames (operators.h), |μ| < 1
/// @return #V images; 0 at vertices without faces that are not prescribed
/// @throw Error bad_option (μ: size, and samples where it is not finite or |μ| ≥ 1); bad_boundary; not_solved naming
///        vertices that are not determined: two of every component must be prescribed
Eigen::VectorXcd quasiconformal_map(const Surface& source, const Eigen::VectorXcd& mu,
                                    const BoundaryCondition& boundary);

}  // namespace beltrami
