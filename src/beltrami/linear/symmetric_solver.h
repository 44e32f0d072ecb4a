#pragma once

#include <Eigen/SparseCore>
#include <memory>
#include <vector>

namespace beltrami::detail {

/// A sparse symmetric positive definite system whose pattern stays while its values change, private to the layer:
/// others take ElementSystem. Only the lower triangle is stored. The backend (CHOLMOD, or Eigen's Cholesky) is hidden.
///
///     SymmetricSolver solver(pattern, 10);      // ordering and symbolic analysis, once
///     solver.matrix().coeffs() = …;             // new values, as often as you like:
///     solver.factorize();
///     x = solver.solve(rhs);
class SymmetricSolver {
  public:
    using Matrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;

    /// Orders and analyses the pattern of @p lower (its values are kept as the first values).
    /// @param lower                   lower triangle, diagonal present in every column
    /// @param expected_factorizations how often factorize() will be called: few take the cheap ordering (AMD), many the
    ///                                better one (METIS); see docs/performance.md
    /// @param block                   so many unknowns, from a multiple of it on, occur in the same rows: they are
    ///                                ordered as one, which takes a fraction of the time
    /// @pre @p block divides the number of rows
    SymmetricSolver(Matrix lower, int expected_factorizations, int block = 1);
    ~SymmetricSolver();
    SymmetricSolver(SymmetricSolver&&) noexcept;
    SymmetricSolver& operator=(SymmetricSolver&&) noexcept;

    /// The stored lower triangle; change its values in place (never its pattern), then factorize().
    Matrix& matrix();
    const Matrix& matrix() const;

    /// @throw Error not_solved if the matrix is not numerically positive definite; indices() are the rows that carry
    ///        the null vector ("unconstrained"), the largest first.
    void factorize();

    /// Solves for every column of @p rhs (#rows × #rhs). One step of iterative refinement is taken where the residual
    /// asks for it.
    /// @throw Error not_solved if the relative residual stays above 1e-6
    Eigen::MatrixXd solve(const Eigen::MatrixXd& rhs) const;

    /// Solves with the present values by conjugate gradients, preconditioned by the last factorisation, which may
    /// belong to other values: a few steps where the two matrices are close, and much cheaper than a new factorisation.
    /// @param solution in: a first guess; out: the solution, if it was found
    /// @param tolerance of the error, relative to the solution, in the energy norm
    /// @return false if the steps allowed would not suffice (found out early); then factorize() and solve()
    bool solve_near(const Eigen::MatrixXd& rhs, Eigen::MatrixXd& solution, double tolerance, int max_steps) const;

    /// Relative residual ‖Ax − b‖∞ / (‖A‖∞‖x‖∞ + ‖b‖∞) of the last solve.
    double last_residual() const;
    int factorization_count() const;

  private:
    struct Backend;
    std::unique_ptr<Backend> backend_;
};

}  // namespace beltrami::detail
