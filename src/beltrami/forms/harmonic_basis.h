#pragma once

#include <vector>

#include <Eigen/Core>

#include <beltrami/base/public.h>
#include <beltrami/forms/homology.h>
#include <beltrami/operators/surface.h>

namespace beltrami BELTRAMI_PUBLIC {

/// The harmonic 1-forms of a surface, dual to the loops of a homology basis: closed, and coclosed by cotangent weights
/// of the intrinsic Delaunay triangulation, without flux through the boundary.
struct HarmonicBasis {
    HomologyBasis homology;
    /// #V×#loops: form j is homology.cochains.col(j) plus the differences of potentials.col(j).
    Eigen::MatrixXd potentials;
    Eigen::MatrixXd forms;     ///< #E×#loops, as homology.cochains
    Eigen::MatrixXd energies;  ///< #loops×#loops: ∫ α_i ∧ ∗α_j, which no change of scale alters
    int flips = 0;             ///< of edges to the intrinsic Delaunay triangulation
    int factorizations = 0;
};

/// One factorisation of a cotangent Laplacian, whose weights are never negative on the intrinsic Delaunay
/// triangulation, so that all depends on the surface alone and not on how it is triangulated. Quads are two triangles
/// (split_quad). Sources: Gu, Yau 2003, "Global conformal surface parameterization"; Bobenko, Springborn 2007, "A
/// discrete Laplace-Beltrami operator for simplicial surfaces".
/// @throw Error bad_mesh unless the surface has one component; not_solved
HarmonicBasis harmonic_basis(const Surface& surface);

/// ∫ α_i ∧ α_j of forms that add up to 0 around every face, linear on its triangles. Of closed surfaces and forms dual
/// to a homology basis with intersections N it is the inverse of N, transposed.
/// @param forms #E×n
Eigen::MatrixXd wedge_products(const Surface& surface, const Eigen::MatrixXd& forms);

}  // namespace beltrami
