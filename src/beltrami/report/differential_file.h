#pragma once

#include <string>

#include <beltrami/base/public.h>
#include <beltrami/differentials/quadratic_differential.h>

namespace beltrami BELTRAMI_PUBLIC {

/// μ and φ of an extremal map at the samples of the mesh that was mapped, each in the frame whose real axis is the
/// first edge of its face, and φ's zeros and poles (zeros_and_poles.h), as JSON (docs/json.md). φ, known up to a
/// positive factor, has the mean |φ| 1 by area; where it is 0 everywhere it stays so.
/// @param mu, phi #S in the samples' frames
std::string differential_json(const Surface& mapped, const Eigen::VectorXcd& mu, const Eigen::VectorXcd& phi,
                              const QuadraticDifferential& differential);

}  // namespace beltrami
