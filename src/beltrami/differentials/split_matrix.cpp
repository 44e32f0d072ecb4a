#include <beltrami/differentials/split_matrix.h>

#include <algorithm>

#include <beltrami/base/parallel.h>

namespace beltrami {

namespace {

/// Rows worked through together: their results stay in the first cache.
constexpr int kRows = 512;
/// Rows of a thread's chunk.
constexpr int kSplitGrain = 4 * kRows;

Eigen::VectorXcd product(const Eigen::MatrixXd& re_part, const Eigen::MatrixXd& im_part, const Eigen::VectorXcd& c) {
    const Eigen::Index rows = re_part.rows(), cols = re_part.cols();
    Eigen::VectorXcd result(rows);
    parallel_for(
        0, static_cast<int>(rows),
        [&](int begin, int end) {
            Eigen::ArrayXd re(kRows), im(kRows);
            for (int first = begin; first < end; first += kRows) {
                const int count = std::min(kRows, end - first);
                re.head(count).setZero();
                im.head(count).setZero();
                double *const to_re = re.data(), *const to_im = im.data();
                for (Eigen::Index j = 0; j < cols; ++j) {
                    const double *const a = &re_part(first, j), *const b = &im_part(first, j);
                    const double x = c[j].real(), y = c[j].imag();
                    for (int i = 0; i < count; ++i) {
                        const double p = a[i], q = b[i];
                        to_re[i] += x * p - y * q;
                        to_im[i] += y * p + x * q;
                    }
                }
                result.segment(first, count).real() = re.head(count).matrix();
                result.segment(first, count).imag() = im.head(count).matrix();
            }
        },
        kSplitGrain);
    return result;
}

Eigen::MatrixXcd transposed_product(const Eigen::MatrixXd& re_part, const Eigen::MatrixXd& im_part,
                                    const Eigen::MatrixXcd& weights) {
    const Eigen::Index rows = re_part.rows(), cols = re_part.cols();
    const Eigen::MatrixXcd zero = Eigen::MatrixXcd::Zero(cols, weights.cols());
    return parallel_sum<Eigen::MatrixXcd>(
        static_cast<int>(rows), zero,
        [&](int begin, int end) {
            Eigen::MatrixXcd sum = zero;
            Eigen::VectorXd re(kRows), im(kRows);
            for (int first = begin; first < end; first += kRows) {
                const int count = std::min(kRows, end - first);
                for (Eigen::Index column = 0; column < weights.cols(); ++column) {
                    re.head(count) = weights.col(column).segment(first, count).real();
                    im.head(count) = weights.col(column).segment(first, count).imag();
                    for (Eigen::Index j = 0; j < cols; ++j) {
                        const auto a = re_part.col(j).segment(first, count), b = im_part.col(j).segment(first, count);
                        sum(j, column) +=
                            Complex(a.head(count).dot(re.head(count)) - b.head(count).dot(im.head(count)),
                                    a.head(count).dot(im.head(count)) + b.head(count).dot(re.head(count)));
                    }
                }
            }
            return sum;
        },
        kSplitGrain);
}

}  // namespace

Eigen::VectorXcd SplitMatrix::times(const Eigen::VectorXcd& c) const {
    return product(re_, im_, c);
}

Eigen::MatrixXcd SplitMatrix::transposed_times(const Eigen::MatrixXcd& weights) const {
    return transposed_product(re_, im_, weights);
}

}  // namespace beltrami
