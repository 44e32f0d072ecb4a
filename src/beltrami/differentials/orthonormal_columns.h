#pragma once

#include <Eigen/Core>

namespace beltrami::detail {

/// Appends to the first @p size orthonormal columns of Q what a unit vector has beside them (Gram and Schmidt, twice),
/// and to those of T the same combination of the functions of which they are made.
/// @param in_functions the vector by functions
/// @param least        a vector with less than this left depends on the others: nothing is appended
template <class Scalar>
void append_orthonormal(Eigen::Matrix<Scalar, Eigen::Dynamic, 1> v,
                        Eigen::Matrix<Scalar, Eigen::Dynamic, 1> in_functions, double least,
                        Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>& Q,
                        Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>& T, Eigen::Index& size) {
    for (int pass = 0; pass < 2; ++pass) {
        const Eigen::Matrix<Scalar, Eigen::Dynamic, 1> along = Q.leftCols(size).adjoint() * v;
        v -= Q.leftCols(size) * along;
        in_functions -= T.leftCols(size) * along;
    }
    const double left = v.norm();
    if (!(left > least)) return;
    Q.col(size) = v / left;
    T.col(size++) = in_functions / left;
}

}  // namespace beltrami::detail
