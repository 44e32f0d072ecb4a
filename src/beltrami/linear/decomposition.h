#pragma once

#include <Eigen/Core>

// Eigen's decompositions of dense matrices, compiled here once: each file that takes them from Eigen's headers compiles
// for seconds longer.

namespace beltrami {

/// A = Q R.
struct ComplexQr {
    Eigen::MatrixXcd Q;  ///< orthonormal columns
    Eigen::MatrixXcd R;  ///< upper triangle, 0 below
};

/// By reflections.
/// @param A  no fewer rows than columns
ComplexQr complex_qr(const Eigen::MatrixXcd& A);

/// The Q of A = Q R, by reflections: orthonormal columns that span those of A, however nearly dependent these are.
/// @param A  no fewer rows than columns
Eigen::MatrixXd orthonormal_columns(const Eigen::MatrixXd& A);

/// Descending; as many as A has rows or columns, whichever are fewer. By Jacobi's rotations.
Eigen::VectorXd singular_values(const Eigen::MatrixXd& A);

struct RightSingular {
    Eigen::VectorXd values;   ///< descending
    Eigen::MatrixXd vectors;  ///< in columns
};

/// Singular values with the right singular vectors, likewise.
RightSingular right_singular(const Eigen::MatrixXd& A);

struct SymmetricEigen {
    Eigen::VectorXd values;   ///< ascending
    Eigen::MatrixXd vectors;  ///< orthonormal, in columns
};

/// Eigenvalues and eigenvectors of a symmetric matrix, of which the lower triangle is read.
SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& lower);

/// A x = λ B x.
/// @param A  symmetric; the lower triangle is read, as of B
/// @param B  symmetric and positive definite
/// @returns vectors that are orthonormal with respect to B
SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

struct HermitianEigen {
    Eigen::VectorXd values;    ///< ascending
    Eigen::MatrixXcd vectors;  ///< orthonormal, in columns
};

/// Likewise of Hermitian matrices.
HermitianEigen hermitian_eigen(const Eigen::MatrixXcd& lower);
HermitianEigen hermitian_eigen(const Eigen::MatrixXcd& A, const Eigen::MatrixXcd& B);

/// Of a square matrix of full rank, by elimination with row pivots.
Eigen::MatrixXd matrix_inverse(const Eigen::MatrixXd& A);

/// The x of least norm among those that make |A x − b| least, by a complete orthogonal decomposition.
/// @param b  as many rows as A; each column is a problem of its own
/// @param threshold  of the largest pivot, below which one counts as 0; 0: rounding's own
Eigen::MatrixXd least_squares(const Eigen::MatrixXd& A, const Eigen::MatrixXd& b, double threshold = 0);

}  // namespace beltrami
