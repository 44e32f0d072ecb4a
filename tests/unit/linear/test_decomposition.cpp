#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include <beltrami/linear/decomposition.h>

namespace beltrami {
namespace {

Eigen::MatrixXd random_matrix(int rows, int columns, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    Eigen::MatrixXd A(rows, columns);
    for (double& a : A.reshaped()) a = uniform(random);
    return A;
}

double distance_from_orthonormal(const Eigen::MatrixXcd& Q) {
    return (Q.adjoint() * Q - Eigen::MatrixXcd::Identity(Q.cols(), Q.cols())).norm();
}

/// U diag(values) Vᵀ with U and V orthonormal: rows × columns, as many values as columns.
Eigen::MatrixXd with_singular_values(int rows, const Eigen::VectorXd& values) {
    const int columns = static_cast<int>(values.size());
    const Eigen::MatrixXd U = orthonormal_columns(random_matrix(rows, columns, 1)),
                          V = orthonormal_columns(random_matrix(columns, columns, 2));
    return U * values.asDiagonal() * V.transpose();
}

TEST(Decomposition, ComplexQrIsTheMatrixWithOrthonormalColumnsAndATriangle) {
    for (const auto& [rows, columns] : {std::pair{7, 7}, {200, 60}, {5, 1}}) {
        Eigen::MatrixXcd A(rows, columns);
        A.real() = random_matrix(rows, columns, 3);
        A.imag() = random_matrix(rows, columns, 4);
        const auto [Q, R] = complex_qr(A);
        ASSERT_EQ(Q.rows(), rows);
        ASSERT_EQ(Q.cols(), columns);
        EXPECT_LT(distance_from_orthonormal(Q), 1e-13);
        EXPECT_LT((Q * R - A).norm(), 1e-13 * A.norm());
        EXPECT_TRUE(R.isUpperTriangular(0));
    }
}

TEST(Decomposition, OrthonormalColumnsSpanTheMatrixEvenIfNearlyDependent) {
    Eigen::MatrixXd A = random_matrix(300, 40, 5);
    A.col(7) = A.col(3) + 1e-14 * A.col(7);
    const Eigen::MatrixXd Q = orthonormal_columns(A);
    ASSERT_EQ(Q.cols(), 40);
    EXPECT_LT(distance_from_orthonormal(Q), 1e-13);
    EXPECT_LT((Q * (Q.transpose() * A) - A).norm(), 1e-13 * A.norm());
}

TEST(Decomposition, SingularValuesAreThoseTheMatrixWasMadeOf) {
    const Eigen::Vector4d values(3, 2, 0.5, 1e-9);
    const Eigen::MatrixXd A = with_singular_values(50, values);
    EXPECT_LT((singular_values(A) - values).norm(), 1e-14);
    EXPECT_LT((singular_values(A.transpose()) - values).norm(), 1e-14) << "wide";
    const RightSingular singular = right_singular(A);
    EXPECT_LT((singular.values - values).norm(), 1e-14);
    EXPECT_LT(distance_from_orthonormal(singular.vectors), 1e-14);
    const Eigen::MatrixXd images = A * singular.vectors;
    EXPECT_LT((images.transpose() * images - Eigen::MatrixXd(values.cwiseAbs2().asDiagonal())).norm(), 1e-14);
}

TEST(Decomposition, SymmetricEigenReadsTheLowerTriangle) {
    // The second difference on n points: 2 − 2 cos(π j / (n + 1)).
    const int n = 30;
    Eigen::MatrixXd A = Eigen::MatrixXd::Constant(n, n, std::numeric_limits<double>::quiet_NaN());
    A.triangularView<Eigen::Lower>().setZero();
    A.diagonal().setConstant(2);
    A.diagonal(-1).setConstant(-1);
    const auto [values, vectors] = symmetric_eigen(A);
    ASSERT_EQ(values.size(), n);
    EXPECT_LT(distance_from_orthonormal(vectors), 1e-13);
    for (int j = 0; j < n; ++j) EXPECT_NEAR(values[j], 2 - 2 * std::cos(EIGEN_PI * (j + 1) / (n + 1)), 1e-14);
    const Eigen::MatrixXd whole = A.selfadjointView<Eigen::Lower>();
    EXPECT_LT((whole * vectors - vectors * values.asDiagonal()).norm(), 1e-13);
}

TEST(Decomposition, EigenvaluesOfAPencilAreThoseItWasMadeOf) {
    const int n = 12;
    const Eigen::VectorXd known = Eigen::VectorXd::LinSpaced(n, -2, 3);
    const Eigen::MatrixXd C = random_matrix(n, n, 6), vectors = matrix_inverse(C).transpose();
    const SymmetricEigen real = symmetric_eigen(C * known.asDiagonal() * C.transpose(), C * C.transpose());
    EXPECT_LT((real.values - known).norm(), 1e-12);
    EXPECT_LT((real.vectors.transpose() * C * C.transpose() * real.vectors - Eigen::MatrixXd::Identity(n, n)).norm(),
              1e-12);
    for (int j = 0; j < n; ++j)
        EXPECT_NEAR(std::abs(real.vectors.col(j).normalized().dot(vectors.col(j).normalized())), 1, 1e-12);

    Eigen::MatrixXcd D(n, n);
    D.real() = C;
    D.imag() = random_matrix(n, n, 7);
    const HermitianEigen complex =
        hermitian_eigen(D * known.cast<std::complex<double>>().asDiagonal() * D.adjoint(), D * D.adjoint());
    EXPECT_LT((complex.values - known).norm(), 1e-12);
    EXPECT_LT(distance_from_orthonormal(D.adjoint() * complex.vectors), 1e-12);
    const Eigen::MatrixXcd Q = complex_qr(D).Q;
    const HermitianEigen own = hermitian_eigen(Q * known.cast<std::complex<double>>().asDiagonal() * Q.adjoint());
    EXPECT_LT((own.values - known).norm(), 1e-13);
    EXPECT_LT(distance_from_orthonormal(own.vectors), 1e-13);
}

TEST(Decomposition, LeastSquaresAreOfLeastNormWhereTheColumnsDepend) {
    Eigen::MatrixXd A = random_matrix(40, 6, 8);
    const Eigen::MatrixXd x = random_matrix(6, 2, 9), orthogonal = random_matrix(40, 2, 10);
    const Eigen::MatrixXd Q = orthonormal_columns(A);
    EXPECT_LT((least_squares(A, A * x + orthogonal - Q * (Q.transpose() * orthogonal)) - x).norm(), 1e-13);
    A.col(5) = A.col(2);  // the two share what one of them had
    const Eigen::MatrixXd shared = least_squares(A, A.leftCols(5) * x.topRows(5));
    EXPECT_LT((shared.row(5) - 0.5 * x.row(2)).norm(), 1e-13);
    EXPECT_LT((shared.row(2) - 0.5 * x.row(2)).norm(), 1e-13);
    // Two columns that differ by less than the threshold are taken for one.
    A.col(5) += 1e-3 * random_matrix(40, 1, 11);
    EXPECT_LT(least_squares(A, orthogonal, 1e-2).norm(), 10);
    EXPECT_GT(least_squares(A, orthogonal).norm(), 50);
}

}  // namespace
}  // namespace beltrami
