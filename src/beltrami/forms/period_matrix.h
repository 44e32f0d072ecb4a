#pragma once

#include <Eigen/Core>

#include <beltrami/base/public.h>
#include <beltrami/forms/harmonic_basis.h>

namespace beltrami BELTRAMI_PUBLIC {

/// Holomorphic 1-forms of a closed surface of genus g, and their periods.
struct PeriodMatrix {
    /// #loops×2g: the symplectic basis a_1 … a_g, b_1 … b_g in terms of the loops of the homology basis (columns).
    Eigen::MatrixXi basis;
    /// g×g, symmetric with positive definite imaginary part: ω_i has the period δ_ij around a_j and Π_ij around b_j.
    Eigen::MatrixXcd periods;
    Eigen::MatrixXcd forms;  ///< #E×g: the forms ω_i on the edges, as HomologyBasis::cochains
    /// How far the star of the discrete forms is from a complex structure: the largest |e − 1| of the eigenvalues e of
    /// −∗∗, which are 1 or more. It falls with the square of the edges' length.
    double defect = 0;
};

/// The energies E of harmonic forms dual to a symplectic basis give the star; it is normalised to ∗∗ = −1, that is, E
/// becomes symplectic, E = [[·, −Re Π (Im Π)⁻¹], [·, (Im Π)⁻¹]]. Of genus 1 Π is τ = (−E_ab + i √det E)/E_bb.
/// @throw Error bad_mesh if the surface has a boundary or genus 0
PeriodMatrix period_matrix(const Surface& surface, const HarmonicBasis& basis);

}  // namespace beltrami
