#pragma once

#include <beltrami/differentials/tabulated_space.h>
#include <beltrami/hyperbolic/hyperbolic_surface.h>

namespace beltrami {

/// The holomorphic quadratic differentials of a closed surface of genus g ≥ 2, and how they were told from others; of a
/// surface with a boundary, whose double has genus g, those that are real along it.
struct HyperbolicSpace {
    /// 3g − 3 functions, orthonormal in L² of the surface; complex coefficients of a closed surface, else real ones.
    TabulatedSpace space;
    Eigen::VectorXd kernel;  ///< 3g − 3 eigenvalues of ∂̄*∂̄, 0 but for the mesh
    double next = 0;         ///< the next one, ½ but for the mesh
    int solves = 0;          ///< linear solves, after one factorisation
};

/// The kernel of ∂̄ on sections of K² at the vertices, in the surface's own metric of curvature −1, where ∂̄*∂̄ has no
/// eigenvalue between 0 and ½: with charts centred on the faces q_k is carried from a vertex frame by conj(a_k)⁴, and
/// the lowest eigenvectors of Dᴴ A D x = λ M x are found by inverse iteration of a subspace. At boundary vertices,
/// whose frames lie along the boundary, q is real: that is the symmetric part of the kernel of the double.
/// @param source of triangles; @param metric of it
/// @throw Error bad_mesh for faces that are not triangles; not_solved if not 3g − 3 eigenvalues are below ¼
HyperbolicSpace hyperbolic_space(const Surface& source, const HyperbolicSurface& metric);

}  // namespace beltrami
