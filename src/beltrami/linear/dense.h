#pragma once

#include <Eigen/Core>

namespace beltrami {

/// AᵀA in the lower triangle, 0 above: with the backend's BLAS where there is one, else Eigen.
Eigen::MatrixXd gram_lower(const Eigen::Ref<const Eigen::MatrixXd>& A);

/// A B, likewise.
Eigen::MatrixXcd complex_product(const Eigen::MatrixXcd& A, const Eigen::MatrixXcd& B);

/// AᴴA in the upper triangle, 0 below, likewise.
Eigen::MatrixXcd complex_gram_upper(const Eigen::MatrixXcd& A);

}  // namespace beltrami
