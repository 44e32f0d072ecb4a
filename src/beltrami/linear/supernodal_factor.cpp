#include <beltrami/linear/supernodal_factor.h>

#include <algorithm>
#include <cmath>

#include <beltrami/base/parallel.h>

namespace beltrami::detail {

namespace {

/// Subtrees become tasks below this part of the whole factor …
constexpr std::size_t kTaskParts = 12;
/// … and smaller factors than this many numbers are not worth a second thread.
constexpr std::size_t kWorthTasks = 200'000;

constexpr int kLanes = 4;
using Lanes = float __attribute__((vector_size(4 * kLanes)));

Lanes load_lanes(const float* from) {
    Lanes lanes;
    __builtin_memcpy(&lanes, from, sizeof lanes);
    return lanes;
}
void store_lanes(float* to, Lanes lanes) {
    __builtin_memcpy(to, &lanes, sizeof lanes);
}
float sum(Lanes lanes) {
    return (lanes[0] + lanes[2]) + (lanes[1] + lanes[3]);
}

/// to[i] −= Σ_c L(i, c) x[c], i < rows, for C columns that lie stride apart.
template <int C>
void subtract_columns(int rows, const float* L, std::ptrdiff_t stride, const float* x0, const float* x1, float* to0,
                      float* to1) {
    int i = 0;
    for (; i + kLanes <= rows; i += kLanes) {
        Lanes a0 = load_lanes(to0 + i), a1 = load_lanes(to1 + i);
        for (int c = 0; c < C; ++c) {
            const Lanes l = load_lanes(L + c * stride + i);
            a0 -= l * x0[c];
            a1 -= l * x1[c];
        }
        store_lanes(to0 + i, a0);
        store_lanes(to1 + i, a1);
    }
    for (; i < rows; ++i)
        for (int c = 0; c < C; ++c) {
            to0[i] -= L[c * stride + i] * x0[c];
            to1[i] -= L[c * stride + i] * x1[c];
        }
}

/// x[c] −= Σ_i L(i, c) from[i], for C columns.
template <int C>
void subtract_products(int rows, const float* L, std::ptrdiff_t stride, const float* from0, const float* from1,
                       float* x0, float* x1) {
    Lanes a0[C] = {}, a1[C] = {};
    int i = 0;
    for (; i + kLanes <= rows; i += kLanes) {
        const Lanes f0 = load_lanes(from0 + i), f1 = load_lanes(from1 + i);
        for (int c = 0; c < C; ++c) {
            const Lanes l = load_lanes(L + c * stride + i);
            a0[c] += l * f0;
            a1[c] += l * f1;
        }
    }
    for (int c = 0; c < C; ++c) {
        float s0 = sum(a0[c]), s1 = sum(a1[c]);
        for (int r = i; r < rows; ++r) {
            s0 += L[c * stride + r] * from0[r];
            s1 += L[c * stride + r] * from1[r];
        }
        x0[c] -= s0;
        x1[c] -= s1;
    }
}

}  // namespace

SupernodalFactor::SupernodalFactor(const SupernodalView& factor)
    : size_(factor.size),
      super_(factor.super, factor.super + factor.supernode_count + 1),
      row_begin_(factor.row_begin, factor.row_begin + factor.supernode_count + 1),
      rows_(factor.rows, factor.rows + factor.row_begin[factor.supernode_count]),
      permutation_(factor.permutation, factor.permutation + factor.size) {
    const int count = factor.supernode_count;
    value_begin_.assign(1, 0);
    int longest = 0;
    for (int s = 0; s < count; ++s) {
        const int length = row_begin_[s + 1] - row_begin_[s], columns = super_[s + 1] - super_[s];
        value_begin_.push_back(value_begin_.back() + static_cast<std::size_t>(length) * columns);
        longest = std::max(longest, length);
    }
    scratch_size_ = 2 * static_cast<std::size_t>(longest);

    // The elimination tree: the parent has the first row below a supernode's own columns. In postorder a subtree is the
    // range of supernodes from first_in[s] to s.
    std::vector<int> of_column(static_cast<std::size_t>(size_)), parent(static_cast<std::size_t>(count), -1),
        first_in(static_cast<std::size_t>(count));
    for (int s = 0; s < count; ++s) std::fill(of_column.begin() + super_[s], of_column.begin() + super_[s + 1], s);
    for (int s = 0; s < count; ++s) first_in[s] = s;
    for (int s = 0; s < count; ++s) {
        const int below = row_begin_[s] + super_[s + 1] - super_[s];
        if (below == row_begin_[s + 1]) continue;
        parent[s] = of_column[rows_[below]];
        first_in[parent[s]] = std::min(first_in[parent[s]], first_in[s]);
    }
    const std::size_t whole = value_begin_.back(), most = whole / kTaskParts;
    const auto share = [&](int s) { return value_begin_[s + 1] - value_begin_[first_in[s]]; };
    targets_ = rows_;
    int copies = size_;
    int done = 0;  // supernodes below are in a task or in the rest
    for (int s = 0; s < count; ++s) {
        const bool root = share(s) <= most && (parent[s] < 0 || share(parent[s]) > most);
        if (whole < kWorthTasks || !root) continue;
        for (; done < first_in[s]; ++done) rest_.push_back(done);
        done = s + 1;
        // A subtree reaches no other rows outside than its root does.
        Task task{first_in[s], s + 1, copies, row_begin_[s] + super_[s + 1] - super_[s], row_begin_[s + 1]};
        const auto root_rows = rows_.begin() + task.root_rows_begin, root_rows_end = rows_.begin() + task.root_rows_end;
        for (int i = row_begin_[task.begin]; i < row_begin_[task.end]; ++i)
            if (rows_[i] >= super_[task.end])
                targets_[i] =
                    copies + static_cast<int>(std::lower_bound(root_rows, root_rows_end, rows_[i]) - root_rows);
        copies += task.root_rows_end - task.root_rows_begin;
        tasks_.push_back(task);
    }
    for (; done < count; ++done) rest_.push_back(done);
    vector_.resize(2 * static_cast<std::size_t>(copies));
    scratch_.resize(scratch_size_ * (tasks_.size() + 1));
}

bool SupernodalFactor::load(const SupernodalView& factor) {
    values_.resize(value_begin_.back());
    const int count = static_cast<int>(super_.size()) - 1;
    std::vector<char> fits(static_cast<std::size_t>(count), 1);
    parallel_for(0, count, [&](int begin, int end) {
        for (int s = begin; s < end; ++s) {
            const int length = row_begin_[s + 1] - row_begin_[s], columns = super_[s + 1] - super_[s];
            for (int c = 0; c < columns; ++c) {
                const double* from = factor.values + factor.value_begin[s] + static_cast<std::ptrdiff_t>(c) * length;
                float* to = values_.data() + value_begin_[s] + static_cast<std::size_t>(c) * length;
                bool finite = true;
                for (int i = c + 1; i < length; ++i) {
                    to[i] = static_cast<float>(from[i]);
                    finite = finite && std::isfinite(to[i]);
                }
                to[c] = static_cast<float>(1 / from[c]);  // solving multiplies by it
                if (!finite || !std::isfinite(to[c]) || to[c] == 0) fits[s] = 0;
            }
        }
    });
    return std::find(fits.begin(), fits.end(), 0) == fits.end();
}

void SupernodalFactor::solve(const Eigen::MatrixXd& rhs, Eigen::MatrixXd& solution) {
    solution.resize(rhs.rows(), rhs.cols());
    for (Eigen::Index j = 0; j < rhs.cols(); j += 2) {
        const bool pair = j + 1 < rhs.cols();
        solve_two(rhs.col(j).data(), pair ? rhs.col(j + 1).data() : nullptr, solution.col(j).data(),
                  pair ? solution.col(j + 1).data() : nullptr);
    }
}

void SupernodalFactor::solve_two(const double* first, const double* second, double* first_solution,
                                 double* second_solution) {
    // Scaled to 1, so that no size of the unit overflows.
    const auto largest = [&](const double* values) {
        double most = 0;
        if (values)
            for (int i = 0; i < size_; ++i) most = std::max(most, std::abs(values[i]));
        return most;
    };
    const double scale[2] = {largest(first), largest(second)};
    const double inverse[2] = {scale[0] > 0 ? 1 / scale[0] : 0, scale[1] > 0 ? 1 / scale[1] : 0};
    parallel_for(0, size_, [&](int begin, int end) {
        for (int i = begin; i < end; ++i) {
            const int from = permutation_[i];
            vector_[2 * static_cast<std::size_t>(i)] = static_cast<float>(first[from] * inverse[0]);
            vector_[2 * static_cast<std::size_t>(i) + 1] =
                second ? static_cast<float>(second[from] * inverse[1]) : 0.0f;
        }
    });
    std::fill(vector_.begin() + 2 * static_cast<std::ptrdiff_t>(size_), vector_.end(), 0.0f);

    const int tasks = static_cast<int>(tasks_.size());
    const auto in_tasks = [&](auto&& work) {
        parallel_for(
            0, tasks,
            [&](int begin, int end) {
                for (int t = begin; t < end; ++t)
                    work(tasks_[t].begin, tasks_[t].end, scratch_.data() + scratch_size_ * static_cast<std::size_t>(t));
            },
            1);
    };
    float* const own_scratch = scratch_.data() + scratch_size_ * static_cast<std::size_t>(tasks);
    in_tasks([&](int begin, int end, float* scratch) { forward(begin, end, scratch); });
    for (const Task& task : tasks_)
        for (int i = task.root_rows_begin; i < task.root_rows_end; ++i) {
            const std::size_t to = 2 * static_cast<std::size_t>(rows_[i]),
                              from = 2 * static_cast<std::size_t>(task.copy_begin + i - task.root_rows_begin);
            vector_[to] += vector_[from];
            vector_[to + 1] += vector_[from + 1];
        }
    for (const int s : rest_) forward(s, s + 1, own_scratch);
    for (auto s = rest_.rbegin(); s != rest_.rend(); ++s) backward(*s, *s + 1, own_scratch);
    in_tasks([&](int begin, int end, float* scratch) { backward(begin, end, scratch); });

    parallel_for(0, size_, [&](int begin, int end) {
        for (int i = begin; i < end; ++i) {
            const int to = permutation_[i];
            first_solution[to] = scale[0] * static_cast<double>(vector_[2 * static_cast<std::size_t>(i)]);
            if (second)
                second_solution[to] = scale[1] * static_cast<double>(vector_[2 * static_cast<std::size_t>(i) + 1]);
        }
    });
}

void SupernodalFactor::forward(int begin, int end, float* scratch) {
    for (int s = begin; s < end; ++s) {
        const int columns = super_[s + 1] - super_[s], length = row_begin_[s + 1] - row_begin_[s];
        const float* const L = values_.data() + value_begin_[s];
        float* const own = vector_.data() + 2 * static_cast<std::size_t>(super_[s]);
        float *const x0 = scratch, *const x1 = scratch + length;
        for (int i = 0; i < columns; ++i) {
            x0[i] = own[2 * i];
            x1[i] = own[2 * i + 1];
        }
        std::fill(x0 + columns, x0 + length, 0.0f);
        std::fill(x1 + columns, x1 + length, 0.0f);
        constexpr int kBlock = 4;
        for (int c = 0; c < columns;) {
            const int block = std::min(kBlock, columns - c);
            for (int j = c; j < c + block; ++j) {
                const float* const column = L + static_cast<std::ptrdiff_t>(j) * length;
                x0[j] *= column[j];
                x1[j] *= column[j];
                for (int i = j + 1; i < c + block; ++i) {
                    x0[i] -= column[i] * x0[j];
                    x1[i] -= column[i] * x1[j];
                }
            }
            const int below = c + block;
            const float* const under = L + static_cast<std::ptrdiff_t>(c) * length + below;
            const auto apply = [&]<int C>() {
                subtract_columns<C>(length - below, under, length, x0 + c, x1 + c, x0 + below, x1 + below);
            };
            block == 4   ? apply.operator()<4>()
            : block == 3 ? apply.operator()<3>()
            : block == 2 ? apply.operator()<2>()
                         : apply.operator()<1>();
            c = below;
        }
        for (int i = 0; i < columns; ++i) {
            own[2 * i] = x0[i];
            own[2 * i + 1] = x1[i];
        }
        const int* const target = targets_.data() + row_begin_[s];
        for (int i = columns; i < length; ++i) {
            float* const to = vector_.data() + 2 * static_cast<std::size_t>(target[i]);
            to[0] += x0[i];
            to[1] += x1[i];
        }
    }
}

void SupernodalFactor::backward(int begin, int end, float* scratch) {
    for (int s = end - 1; s >= begin; --s) {
        const int columns = super_[s + 1] - super_[s], length = row_begin_[s + 1] - row_begin_[s];
        const float* const L = values_.data() + value_begin_[s];
        const int* const row = rows_.data() + row_begin_[s];
        float *const x0 = scratch, *const x1 = scratch + length;
        for (int i = 0; i < length; ++i) {
            const float* const from = vector_.data() + 2 * static_cast<std::size_t>(row[i]);
            x0[i] = from[0];
            x1[i] = from[1];
        }
        constexpr int kBlock = 4;
        for (int below = columns; below > 0;) {
            const int block = below % kBlock ? below % kBlock : kBlock, c = below - block;
            const float* const under = L + static_cast<std::ptrdiff_t>(c) * length + below;
            const auto apply = [&]<int C>() {
                subtract_products<C>(length - below, under, length, x0 + below, x1 + below, x0 + c, x1 + c);
            };
            block == 4   ? apply.operator()<4>()
            : block == 3 ? apply.operator()<3>()
            : block == 2 ? apply.operator()<2>()
                         : apply.operator()<1>();
            for (int j = below - 1; j >= c; --j) {
                const float* const column = L + static_cast<std::ptrdiff_t>(j) * length;
                for (int i = j + 1; i < below; ++i) {
                    x0[j] -= column[i] * x0[i];
                    x1[j] -= column[i] * x1[i];
                }
                x0[j] *= column[j];
                x1[j] *= column[j];
            }
            below = c;
        }
        float* const own = vector_.data() + 2 * static_cast<std::size_t>(super_[s]);
        for (int i = 0; i < columns; ++i) {
            own[2 * i] = x0[i];
            own[2 * i + 1] = x1[i];
        }
    }
}

}  // namespace beltrami::detail
