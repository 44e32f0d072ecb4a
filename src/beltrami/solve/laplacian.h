#pragma once

#include <memory>
#include <span>
#include <vector>

#include <beltrami/constraints/boundary_condition.h>
#include <beltrami/linear/element_assembly.h>

namespace beltrami::detail {

/// The real Dirichlet Laplacian of a surface with its fixed vertices eliminated: L_ij = Σ A Re(conj(g_i) g_j),
/// cotangent weights on triangles. Analysed once; factorised at construction and for any weights since.
class Laplacian {
  public:
    /// @param freedoms               #V
    /// @param expected_factorizations see SymmetricSolver
    Laplacian(const Operators& operators, const std::vector<Freedom>& freedoms, int expected_factorizations = 1);

    /// Factorises for the weights Σ weights Re(conj(g_i) g_j) instead of areas.
    /// @param weights #S, positive
    void factorize(std::span<const double> weights);

    /// Solves L u = force at the vertices that are not fixed, u = 0 at the others, for every column.
    /// @param force #V×n, ignored at fixed vertices
    /// @return #V×n
    Eigen::MatrixXd solve(const Eigen::MatrixXd& force) const;

    int factorization_count() const { return solver_ ? solver_->factorization_count() : 0; }

  private:
    const Operators& operators_;
    std::vector<int> unknown_;  // #V, −1 where fixed
    int count_ = 0;
    std::unique_ptr<ElementAssembly> assembly_;
    std::unique_ptr<SymmetricSolver> solver_;
};

}  // namespace beltrami::detail
