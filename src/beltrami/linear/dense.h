#pragma once

#include <Eigen/Core>

namespace beltrami {

/// AᵀA in the lower triangle, 0 above: with the backend's BLAS where there is one, else Eigen.
Eigen::MatrixXd gram_lower(const Eigen::MatrixXd& A);

}  // namespace beltrami
