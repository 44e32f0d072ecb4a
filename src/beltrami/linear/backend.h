#pragma once

#include <Eigen/SparseCore>
#include <memory>

namespace beltrami::detail {

/// One Cholesky backend: ordering and analysis at construction, then factorise and solve. Private to the layer.
class CholeskyBackend {
  public:
    using Matrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;

    virtual ~CholeskyBackend() = default;
    /// @return false if a pivot is not positive
    virtual bool factorize(const Matrix& lower) = 0;
    /// (smallest / largest pivot) of the Cholesky factor: a cheap bound of the reciprocal condition number.
    virtual double pivot_ratio() const = 0;
    virtual void solve(const Eigen::MatrixXd& rhs, Eigen::MatrixXd& solution) = 0;
    /// The same to a few digits only, as a preconditioner wants it, if that is cheaper.
    virtual void solve_roughly(const Eigen::MatrixXd& rhs, Eigen::MatrixXd& solution) { solve(rhs, solution); }
};

/// See SymmetricSolver.
std::unique_ptr<CholeskyBackend> make_backend(const CholeskyBackend::Matrix& lower, int expected_factorizations,
                                              int block);

}  // namespace beltrami::detail
