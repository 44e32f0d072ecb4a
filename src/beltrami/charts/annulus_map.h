#pragma once

#include <beltrami/operators/surface.h>

namespace beltrami {

/// The conformal map of an annulus-like surface to a round annulus, @p outer_loop on the unit circle and the other loop
/// on a circle about 0: exp(−2π(u − i v)/T), u harmonic, 0 on the outer loop and 1 on the other one, v its conjugate
/// with the period T, each by one linear solve of #V unknowns. T is the geometric mean of what u and v give for it,
/// whose errors have opposite signs. The discretisation error is of second order.
/// @return #V positions
/// @pre one component of genus 0 with two boundary loops
/// @throw Error not_solved
Eigen::VectorXcd annulus_map(const Surface& surface, int outer_loop);

}  // namespace beltrami
