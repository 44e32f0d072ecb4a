#pragma once

#include <Eigen/Core>

#include <beltrami/mesh/mesh.h>

namespace beltrami {

/// A tall complex matrix kept as real and imaginary parts: products with few columns then run at the speed of memory,
/// on all threads, with the same bytes for any number of them. (Single precision would not do: combinations of
/// clustered poles cancel to five digits.)
class SplitMatrix {
  public:
    SplitMatrix() = default;
    explicit SplitMatrix(const Eigen::MatrixXcd& matrix) : re_(matrix.real()), im_(matrix.imag()) {}

    Eigen::Index rows() const { return re_.rows(); }
    Eigen::Index cols() const { return re_.cols(); }

    /// A c.
    Eigen::VectorXcd times(const Eigen::VectorXcd& c) const;
    /// Aᵀ W, not conjugated.
    Eigen::MatrixXcd transposed_times(const Eigen::MatrixXcd& weights) const;

  private:
    Eigen::MatrixXd re_, im_;
};

}  // namespace beltrami
