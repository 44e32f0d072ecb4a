#pragma once

#include <beltrami/base/public.h>
#include <beltrami/operators/surface.h>

namespace beltrami BELTRAMI_PUBLIC {

/// The conformal module log(R/r) of a surface with two boundary loops in the structure |dz + μ dz̄|²: its maps with the
/// coefficient μ go onto round rings of this module, and onto no others.
/// @param mu #S in the samples' frames, |μ| < 1
/// @throw Error bad_mesh unless the surface is one component of genus 0 with two boundary loops; bad_option (μ);
///        not_solved
double ring_module(const Surface& source, const Eigen::VectorXcd& mu, int outer_loop = 0);

}  // namespace beltrami
