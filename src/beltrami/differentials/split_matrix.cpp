#include <beltrami/differentials/split_matrix.h>

#include <algorithm>

#include <beltrami/mesh/parallel.h>

namespace beltrami {

namespace {

/// Rows worked through together: their results stay in the first cache.
constexpr int kRows = 512;
/// Rows of a thread's chunk.
constexpr int kGrain = 4 * kRows;

}  // namespace

Eigen::VectorXcd SplitMatrix::times(const Eigen::VectorXcd& c) const {
    Eigen::VectorXcd result(rows());
    parallel_for(
        0, static_cast<int>(rows()),
        [&](int begin, int end) {
            Eigen::ArrayXd re(kRows), im(kRows);
            for (int first = begin; first < end; first += kRows) {
                const int count = std::min(kRows, end - first);
                re.head(count).setZero();
                im.head(count).setZero();
                for (Eigen::Index j = 0; j < cols(); ++j) {
                    const auto a = re_.col(j).segment(first, count).array(),
                               b = im_.col(j).segment(first, count).array();
                    re.head(count) += c[j].real() * a - c[j].imag() * b;
                    im.head(count) += c[j].imag() * a + c[j].real() * b;
                }
                result.segment(first, count).real() = re.head(count).matrix();
                result.segment(first, count).imag() = im.head(count).matrix();
            }
        },
        kGrain);
    return result;
}

Eigen::MatrixXcd SplitMatrix::transposed_times(const Eigen::MatrixXcd& weights) const {
    const Eigen::MatrixXcd zero = Eigen::MatrixXcd::Zero(cols(), weights.cols());
    return parallel_sum<Eigen::MatrixXcd>(
        static_cast<int>(rows()), zero,
        [&](int begin, int end) {
            Eigen::MatrixXcd sum = zero;
            Eigen::VectorXd re(kRows), im(kRows);
            for (int first = begin; first < end; first += kRows) {
                const int count = std::min(kRows, end - first);
                for (Eigen::Index column = 0; column < weights.cols(); ++column) {
                    re.head(count) = weights.col(column).segment(first, count).real();
                    im.head(count) = weights.col(column).segment(first, count).imag();
                    for (Eigen::Index j = 0; j < cols(); ++j) {
                        const auto a = re_.col(j).segment(first, count), b = im_.col(j).segment(first, count);
                        sum(j, column) += Complex(a.dot(re.head(count)) - b.dot(im.head(count)),
                                                  a.dot(im.head(count)) + b.dot(re.head(count)));
                    }
                }
            }
            return sum;
        },
        kGrain);
}

}  // namespace beltrami
