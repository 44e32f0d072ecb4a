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

}  // namespace beltrami
