#include <beltrami/linear/decomposition.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>

namespace beltrami {

namespace {

using Svd = Eigen::JacobiSVD<Eigen::MatrixXd, Eigen::HouseholderQRPreconditioner>;
template <typename Matrix>
using OwnEigen = Eigen::SelfAdjointEigenSolver<Matrix>;
template <typename Matrix>
using PencilEigen = Eigen::GeneralizedSelfAdjointEigenSolver<Matrix>;

}  // namespace

ComplexQr complex_qr(const Eigen::MatrixXcd& A) {
    const Eigen::HouseholderQR<Eigen::MatrixXcd> qr(A);
    return {qr.householderQ() * Eigen::MatrixXcd::Identity(A.rows(), A.cols()),
            qr.matrixQR().topRows(A.cols()).triangularView<Eigen::Upper>()};
}

Eigen::MatrixXd orthonormal_columns(const Eigen::MatrixXd& A) {
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(A);
    return qr.householderQ() * Eigen::MatrixXd::Identity(A.rows(), A.cols());
}

Eigen::VectorXd singular_values(const Eigen::MatrixXd& A) {
    return Svd(A).singularValues();
}

RightSingular right_singular(const Eigen::MatrixXd& A) {
    const Svd svd(A, Eigen::ComputeThinV);
    return {svd.singularValues(), svd.matrixV()};
}

SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& lower) {
    const OwnEigen<Eigen::MatrixXd> eigen(lower);
    return {eigen.eigenvalues(), eigen.eigenvectors()};
}

SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B) {
    const PencilEigen<Eigen::MatrixXd> eigen(A, B);
    return {eigen.eigenvalues(), eigen.eigenvectors()};
}

HermitianEigen hermitian_eigen(const Eigen::MatrixXcd& lower) {
    const OwnEigen<Eigen::MatrixXcd> eigen(lower);
    return {eigen.eigenvalues(), eigen.eigenvectors()};
}

HermitianEigen hermitian_eigen(const Eigen::MatrixXcd& A, const Eigen::MatrixXcd& B) {
    const PencilEigen<Eigen::MatrixXcd> eigen(A, B);
    return {eigen.eigenvalues(), eigen.eigenvectors()};
}

Eigen::MatrixXd matrix_inverse(const Eigen::MatrixXd& A) {
    return A.inverse();
}

Eigen::MatrixXd least_squares(const Eigen::MatrixXd& A, const Eigen::MatrixXd& b, double threshold) {
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition;
    if (threshold > 0) decomposition.setThreshold(threshold);
    return decomposition.compute(A).solve(b);
}

}  // namespace beltrami
