#pragma once

#include <Eigen/Core>

namespace beltrami::detail {

/// Whether vector_gram() is worth while: on a processor with vectors of eight doubles, for which it is written.
bool has_vector_gram();

/// AᵀA in the lower triangle, 0 above, on all threads, with the same bytes for any number of them. As quick on one
/// thread as a good BLAS, which may not be called from several threads at once.
Eigen::MatrixXd vector_gram(const Eigen::Ref<const Eigen::MatrixXd>& A);

}  // namespace beltrami::detail
