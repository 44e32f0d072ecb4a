#pragma once

#include <memory>
#include <vector>

#include <beltrami/linear/element_assembly.h>
#include <beltrami/operators/operators.h>

namespace beltrami::detail {

/// ∫|∇u|² of functions that are linear on triangles, also of functions that are known up to sign: then the value at a
/// corner is that of its vertex times the corner's sign (branched_cover.h). Vertices that are held are 0 and have no
/// unknown. Analysed and factorised once.
class DirichletForm {
  public:
    /// @param operators is kept by reference
    /// @param signs     beside operators.vertices; empty: all are +1
    /// @param held      #V
    DirichletForm(const Operators& operators, std::vector<signed char> signs, const std::vector<char>& held);

    /// u with ½ d(energy)/du = force at the vertices that are not held, 0 at those that are.
    /// @param force #V, ignored where held
    Eigen::VectorXd solve(const Eigen::VectorXd& force) const;
    /// ½ d(energy)/du, all of it (#V).
    Eigen::VectorXd apply(const Eigen::VectorXd& u) const;
    /// The energy, summed from squares.
    double energy(const Eigen::VectorXd& u) const;

    int factorization_count() const { return solver_ ? solver_->factorization_count() : 0; }

  private:
    double sign(int corner) const { return signs_.empty() ? 1.0 : signs_[corner]; }
    /// ∇u on a sample.
    Complex gradient(int sample, const Eigen::VectorXd& u) const;

    const Operators& operators_;
    std::vector<signed char> signs_;
    std::vector<int> unknown_;  ///< #V, −1 where held
    int count_ = 0;
    std::unique_ptr<SymmetricSolver> solver_;
};

}  // namespace beltrami::detail
