#pragma once

#include <beltrami/certificate/pair_bound.h>

namespace beltrami {

/// The Dirichlet energy D of functions from a space of coordinates x.
class PairEnergy {
  public:
    virtual ~PairEnergy() = default;

    /// Solves ½ dD/dx = force. @pre force does nothing to functions without energy
    virtual Eigen::VectorXd solve(const Eigen::VectorXd& force) const = 0;
    /// ½ dD/dx.
    virtual Eigen::VectorXd apply(const Eigen::VectorXd& x) const = 0;
    /// D, summed from squares.
    virtual double energy(const Eigen::VectorXd& x) const = 0;
    virtual int factorization_count() const = 0;
};

/// The bilinear form ∫ d(u∘f) ∧ dv, the same for every f of a class.
class Pairing {
  public:
    virtual ~Pairing() = default;

    /// W v: what u is paired with.
    virtual Eigen::VectorXd with_v(const Eigen::VectorXd& v) const = 0;
    /// Wᵀ u.
    virtual Eigen::VectorXd with_u(const Eigen::VectorXd& u) const = 0;
    /// A function u that no symmetry makes orthogonal to the wanted one.
    virtual Eigen::VectorXd start() const = 0;
};

/// The pair with the largest (∫ d(u∘f) ∧ dv)² / (D_T(u) D_S(v)), by Lanczos' iteration for the largest eigenvalue of
/// L_S⁻¹ Wᵀ L_T⁻¹ W, in the energy product of L_S, and that quotient.
PairBound best_pair(const PairEnergy& source, const PairEnergy& image, const Pairing& pairing,
                    const PairBoundOptions& options);

}  // namespace beltrami
