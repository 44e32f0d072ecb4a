#include <beltrami/linear/vector_gram.h>

#include <algorithm>
#include <array>

#include <beltrami/base/parallel.h>

#if defined(__x86_64__) && defined(__GNUC__)
#define BELTRAMI_EIGHT_DOUBLES __attribute__((target("avx512f")))
#else
#define BELTRAMI_EIGHT_DOUBLES
#endif

namespace beltrami::detail {

namespace {

constexpr int kGramLanes = 8;
using GramLanes = double __attribute__((vector_size(8 * kGramLanes)));

/// Columns against columns whose products are summed side by side: 16 sums fit the registers.
constexpr int kTile = 4;
/// Rows worked through together: two tiles of them stay in the first cache.
constexpr int kRows = 512;
/// Columns of a task: with fewer the matrix would be read too often.
constexpr int kTaskColumns = 16;

using Columns = std::array<const double*, kTile>;

/// Products of every column of one tile with every column of another.
BELTRAMI_EIGHT_DOUBLES
void multiply_tiles(const Columns& a, const Columns& b, int rows, double* products) {
    GramLanes sums[kTile][kTile] = {};
    int row = 0;
    for (; row + kGramLanes <= rows; row += kGramLanes) {
        GramLanes x[kTile], y[kTile];
        for (int i = 0; i < kTile; ++i) {
            __builtin_memcpy(&x[i], a[i] + row, sizeof x[i]);
            __builtin_memcpy(&y[i], b[i] + row, sizeof y[i]);
        }
        for (int i = 0; i < kTile; ++i)
            for (int j = 0; j < kTile; ++j) sums[i][j] += x[i] * y[j];
    }
    for (int i = 0; i < kTile; ++i)
        for (int j = 0; j < kTile; ++j) {
            double sum = 0;
            for (int l = 0; l < kGramLanes; ++l) sum += sums[i][j][l];
            for (int rest = row; rest < rows; ++rest) sum += a[i][rest] * b[j][rest];
            products[kTile * i + j] = sum;
        }
}

}  // namespace

bool has_vector_gram() {
#if defined(__x86_64__) && defined(__GNUC__)
    static const bool has = __builtin_cpu_supports("avx512f");
    return has;
#else
    return false;
#endif
}

Eigen::MatrixXd vector_gram(const Eigen::Ref<const Eigen::MatrixXd>& A) {
    const int n = static_cast<int>(A.cols()), rows = static_cast<int>(A.rows());
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(n, n);
    if (n == 0 || rows == 0) return result;
    // Columns past the last one are taken to be the last one; their products go nowhere.
    const auto tile = [&](int row, int column) {
        Columns columns;
        for (int i = 0; i < kTile; ++i) columns[i] = &A.coeffRef(row, std::min(column + i, n - 1));
        return columns;
    };
    const auto fill = [&](int first, int last) {
        double products[kTile * kTile];
        for (int row = 0; row < rows; row += kRows)
            for (int j = 0; j < last; j += kTile)
                for (int i = std::max(first, j); i < last; i += kTile) {
                    multiply_tiles(tile(row, i), tile(row, j), std::min(kRows, rows - row), products);
                    for (int p = 0; p < kTile && i + p < n; ++p)
                        for (int q = 0; q < kTile && j + q <= i + p; ++q)
                            result(i + p, j + q) += products[kTile * p + q];
                }
    };
    // The longest rows of the triangle first.
    const int tasks = (n - 1) / kTaskColumns + 1;
    parallel_for(
        0, tasks,
        [&](int begin, int end) {
            for (int t = begin; t < end; ++t) {
                const int first = kTaskColumns * (tasks - 1 - t);
                fill(first, std::min(first + kTaskColumns, n));
            }
        },
        1);
    return result;
}

}  // namespace beltrami::detail
