#pragma once

#include <Eigen/Core>

namespace beltrami {

/// A c of a tall matrix, with the vector units of the processor at hand and on all threads, with the same bytes for any
/// number of them. (Eigen's own product of complex numbers has those of any processor only.)
Eigen::VectorXcd times_columns(const Eigen::MatrixXcd& A, const Eigen::VectorXcd& c);

/// Aᵀ w, not conjugated.
Eigen::VectorXcd transposed_times_columns(const Eigen::MatrixXcd& A, const Eigen::VectorXcd& w);

}  // namespace beltrami
