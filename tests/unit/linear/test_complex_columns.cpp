#include <gtest/gtest.h>

#include <cmath>

#include <beltrami/linear/complex_columns.h>

using namespace beltrami;

namespace {

using Number = std::complex<double>;

Eigen::MatrixXcd numbers(Eigen::Index rows, Eigen::Index cols) {
    Eigen::MatrixXcd result(rows, cols);
    for (Eigen::Index j = 0; j < cols; ++j)
        for (Eigen::Index i = 0; i < rows; ++i)
            result(i, j) = Number(std::sin(1.0 + 0.7 * i + 3.1 * j), std::cos(0.3 * i * j + 2.0 * j));
    return result;
}

}  // namespace

// Sizes that fill vectors, tiles of columns and chunks of rows, and such that do not.
TEST(ComplexColumns, AreTheProductsOfTheMatrix) {
    for (const Eigen::Index rows : {0, 1, 3, 8, 255, 256, 1029})
        for (const Eigen::Index cols : {1, 2, 4, 7, 12}) {
            const Eigen::MatrixXcd A = numbers(rows, cols);
            const Eigen::VectorXcd c = numbers(cols, 1), w = numbers(rows, 1);
            const Eigen::VectorXcd product = A * c, transposed = A.transpose() * w;
            const double size = 1 + std::sqrt(static_cast<double>(rows * cols));
            ASSERT_EQ(times_columns(A, c).size(), rows);
            EXPECT_LT((times_columns(A, c) - product).norm(), 1e-14 * size * size) << rows << " × " << cols;
            EXPECT_LT((transposed_times_columns(A, w) - transposed).norm(), 1e-14 * size * size)
                << rows << " × " << cols;
        }
}
