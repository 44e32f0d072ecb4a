#include <beltrami/linear/complex_columns.h>

#include <algorithm>
#include <array>
#include <complex>

#include <beltrami/base/parallel.h>
#include <beltrami/base/vector_clones.h>

namespace beltrami {

namespace {

/// Rows worked through together: what belongs to them stays in the first cache.
constexpr int kColumnRows = 256;
/// Rows of a thread's chunk.
constexpr int kColumnGrain = 2 * kColumnRows;
/// Columns that are taken together.
constexpr int kTogether = 4;
/// Numbers that a vector unit works on at once.
constexpr int kColumnLanes = 8;
using ColumnLanes = double __attribute__((vector_size(8 * kColumnLanes)));

/// Real and imaginary parts in turn, of the rows that are worked through together.
using Interleaved = std::array<double, 2 * kColumnRows>;
/// So many columns of them, the first ones from one row on.
using FourColumns = std::array<const double*, kTogether>;

inline __attribute__((always_inline)) void load_lanes(const double* from, ColumnLanes& to) {
    __builtin_memcpy(&to, from, sizeof to);
}

/// Adds Σ x a and Σ y a, number by number.
BELTRAMI_VECTOR_CLONES
void add_columns(const FourColumns& a, int count, const double* x, const double* y, double* by_x, double* by_y) {
    int i = 0;
    for (; i + kColumnLanes <= count; i += kColumnLanes) {
        ColumnLanes first, second, value;
        load_lanes(by_x + i, first);
        load_lanes(by_y + i, second);
        for (int j = 0; j < kTogether; ++j) {
            load_lanes(a[j] + i, value);
            first += x[j] * value;
            second += y[j] * value;
        }
        __builtin_memcpy(by_x + i, &first, sizeof first);
        __builtin_memcpy(by_y + i, &second, sizeof second);
    }
    for (; i < count; ++i)
        for (int j = 0; j < kTogether; ++j) {
            by_x[i] += x[j] * a[j][i];
            by_y[i] += y[j] * a[j][i];
        }
}

/// Σ a w and Σ a v of every column, w with the imaginary parts negative and v with both parts exchanged: the real and
/// the imaginary part of the sum.
BELTRAMI_VECTOR_CLONES
void dot_columns(const FourColumns& a, int count, const double* w, const double* v, double* real, double* imaginary) {
    ColumnLanes first[kTogether] = {}, second[kTogether] = {};
    int i = 0;
    for (; i + kColumnLanes <= count; i += kColumnLanes) {
        ColumnLanes by_w, by_v, value;
        load_lanes(w + i, by_w);
        load_lanes(v + i, by_v);
        for (int j = 0; j < kTogether; ++j) {
            load_lanes(a[j] + i, value);
            first[j] += value * by_w;
            second[j] += value * by_v;
        }
    }
    for (int j = 0; j < kTogether; ++j) {
        double re = 0, im = 0;
        for (int l = 0; l < kColumnLanes; ++l) {
            re += first[j][l];
            im += second[j][l];
        }
        for (int rest = i; rest < count; ++rest) {
            re += a[j][rest] * w[rest];
            im += a[j][rest] * v[rest];
        }
        real[j] = re;
        imaginary[j] = im;
    }
}

/// Columns past the last one are taken to be the last one.
FourColumns four_columns(const Eigen::MatrixXcd& A, Eigen::Index row, Eigen::Index column) {
    FourColumns result{};
    for (int j = 0; j < kTogether; ++j)
        result[j] = reinterpret_cast<const double*>(&A.coeffRef(row, std::min(column + j, A.cols() - 1)));
    return result;
}

}  // namespace

Eigen::VectorXcd times_columns(const Eigen::MatrixXcd& A, const Eigen::VectorXcd& c) {
    Eigen::VectorXcd result(A.rows());
    parallel_for(
        0, static_cast<int>(A.rows()),
        [&](int begin, int end) {
            Interleaved by_x, by_y;
            for (int first = begin; first < end; first += kColumnRows) {
                const int count = std::min(kColumnRows, end - first);
                by_x.fill(0);
                by_y.fill(0);
                for (Eigen::Index j = 0; j < A.cols(); j += kTogether) {
                    std::array<double, kTogether> x{}, y{};
                    for (int l = 0; l < kTogether && j + l < A.cols(); ++l) {
                        x[l] = c[j + l].real();
                        y[l] = c[j + l].imag();
                    }
                    add_columns(four_columns(A, first, j), 2 * count, x.data(), y.data(), by_x.data(), by_y.data());
                }
                for (int i = 0; i < count; ++i)
                    result[first + i] = {by_x[2 * i] - by_y[2 * i + 1], by_x[2 * i + 1] + by_y[2 * i]};
            }
        },
        kColumnGrain);
    return result;
}

Eigen::VectorXcd transposed_times_columns(const Eigen::MatrixXcd& A, const Eigen::VectorXcd& w) {
    const Eigen::VectorXcd zero = Eigen::VectorXcd::Zero(A.cols());
    return parallel_sum<Eigen::VectorXcd>(
        static_cast<int>(A.rows()), zero,
        [&](int begin, int end) {
            Eigen::VectorXcd sum = zero;
            Interleaved weight, exchanged;
            for (int first = begin; first < end; first += kColumnRows) {
                const int count = std::min(kColumnRows, end - first);
                for (int i = 0; i < count; ++i) {
                    weight[2 * i] = exchanged[2 * i + 1] = w[first + i].real();
                    exchanged[2 * i] = w[first + i].imag();
                    weight[2 * i + 1] = -w[first + i].imag();
                }
                for (Eigen::Index j = 0; j < A.cols(); j += kTogether) {
                    std::array<double, kTogether> real{}, imaginary{};
                    dot_columns(four_columns(A, first, j), 2 * count, weight.data(), exchanged.data(), real.data(),
                                imaginary.data());
                    for (int l = 0; l < kTogether && j + l < A.cols(); ++l)
                        sum[j + l] += std::complex<double>(real[l], imaginary[l]);
                }
            }
            return sum;
        },
        kColumnGrain);
}

}  // namespace beltrami
