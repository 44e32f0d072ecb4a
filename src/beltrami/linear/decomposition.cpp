#include <beltrami/linear/decomposition.h>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SVD>

namespace beltrami {

namespace {

using Svd = Eigen::JacobiSVD<Eigen::MatrixXd, Eigen::HouseholderQRPreconditioner>;

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
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(lower);
    return {eigen.eigenvalues(), eigen.eigenvectors()};
}

}  // namespace beltrami
