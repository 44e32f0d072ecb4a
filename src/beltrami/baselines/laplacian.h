#pragma once

#include <memory>
#include <vector>

#include <beltrami/linear/symmetric_solver.h>
#include <beltrami/maps/boundary_condition.h>

namespace beltrami::detail {

/// The real Dirichlet Laplacian of a surface with its fixed vertices eliminated, factorised once:
/// L_ij = Σ A Re(conj(g_i) g_j), cotangent weights on triangles.
class Laplacian {
  public:
    /// @param freedoms #V
    Laplacian(const Operators& operators, const std::vector<Freedom>& freedoms);

    /// Solves L u = force at the vertices that are not fixed, u = 0 at the others, for every column.
    /// @param force #V×n, ignored at fixed vertices
    /// @return #V×n
    Eigen::MatrixXd solve(const Eigen::MatrixXd& force) const;

  private:
    std::vector<int> unknown_;  // #V, −1 where fixed
    int count_ = 0;
    std::unique_ptr<SymmetricSolver> solver_;
};

}  // namespace beltrami::detail
