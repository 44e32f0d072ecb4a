#pragma once

#include <array>

#include <beltrami/differentials/tabulated_space.h>

namespace beltrami {

/// The one quadratic differential of a quadrilateral, and the conformal map to a rectangle that it belongs to.
struct QuadrilateralSpace {
    TabulatedSpace space;                         ///< (∂f)² in the samples' frames; real coefficients
    Eigen::VectorXcd map;                         ///< #V f = u + iv, onto [0, 1] × [0, modulus], the first corner to 0
    double modulus = 0;                           ///< height of the rectangle over its width
    double modulus_lower = 0, modulus_upper = 0;  ///< of this mesh's surface, by Dirichlet's principle
};

/// φ = (2 ∂u)² with u harmonic, 0 and 1 on two opposite sides and without flux through the other two: real along the
/// boundary whatever the corners' angles, and integrable. Works on any disk-like surface in its own frames, at
/// reentrant corners too, where L² projection does not.
///
/// Both u and its conjugate v (0 on the first side) are solved for and φ = (∂(u + iv))²: the noise of piecewise linear
/// u sits in ∂̄ of the sum, and ∂u alone would have half of it.
/// @param corners boundary vertices, counter-clockwise; the first side goes from the first to the second one
/// @throw Error bad_mesh unless the surface is a disk; bad_boundary if the corners are not four boundary vertices in
///        order; not_solved
QuadrilateralSpace quadrilateral_space(const Surface& source, const std::array<int, 4>& corners);

/// Products of the differentials of harmonic measures, (2 ∂u_i)(2 ∂u_j), on a surface with two holes or more: u_i is 1
/// on hole i and 0 on the other loops. They span the quadratic differentials with φ τ² real on the boundary in general,
/// but not where the doubled domain is hyperelliptic: centres of three holes or more in one line, or symmetric in
/// another way, give fewer functions than the theory asks for (2n − 1 instead of 3n − 3). projected_space has no such
/// gaps.
/// @throw Error bad_mesh unless there is one component of genus 0 with at least three boundary loops; not_solved with
/// the
///        eigenvalues where the products do not span the space
TabulatedSpace one_form_products(const Surface& source);

}  // namespace beltrami
