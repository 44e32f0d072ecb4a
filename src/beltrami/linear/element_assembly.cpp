#include <beltrami/linear/element_assembly.h>

#include <algorithm>
#include <utility>

#include <beltrami/base/parallel.h>

namespace beltrami::detail {

ElementAssembly::ElementAssembly(std::vector<int> offsets, std::vector<int> unknowns, int unknown_count)
    : offsets_(std::move(offsets)), unknowns_(std::move(unknowns)), unknown_count_(unknown_count) {
    const int elements = element_count();
    slot_offsets_.resize(static_cast<std::size_t>(elements) + 1, 0);
    for (int e = 0; e < elements; ++e) {
        const std::size_t n = this->unknowns(e).size();
        slot_offsets_[e + 1] = slot_offsets_[e] + n * (n + 1) / 2;
    }
    // Calls act(column, row) for every pair below the diagonal, as often as it occurs.
    const auto each_pair = [&](auto&& act) {
        for (int e = 0; e < elements; ++e) {
            const auto u = this->unknowns(e);
            for (std::size_t i = 1; i < u.size(); ++i)
                for (std::size_t j = 0; j < i; ++j)
                    if (u[i] >= 0 && u[j] >= 0 && u[i] != u[j]) act(std::min(u[i], u[j]), std::max(u[i], u[j]));
        }
    };
    std::vector<std::size_t> starts(static_cast<std::size_t>(unknown_count_) + 1, 0);
    each_pair([&](int column, int) { ++starts[column + 1]; });
    for (int c = 0; c < unknown_count_; ++c) starts[c + 1] += starts[c];

    // Rows of every column with repetitions, then sorted and made unique column by column.
    std::vector<int> repeated(starts.back());
    std::vector<std::size_t> fill(starts.begin(), starts.end() - 1);
    each_pair([&](int column, int row) { repeated[fill[column]++] = row; });
    std::vector<int> lengths(static_cast<std::size_t>(unknown_count_));
    parallel_for(0, unknown_count_, [&](int begin, int end) {
        for (int c = begin; c < end; ++c) {
            const auto first = repeated.begin() + static_cast<std::ptrdiff_t>(starts[c]),
                       last = repeated.begin() + static_cast<std::ptrdiff_t>(starts[c + 1]);
            std::sort(first, last);
            lengths[c] = static_cast<int>(std::unique(first, last) - first);
        }
    });
    columns_.assign(static_cast<std::size_t>(unknown_count_) + 1, 0);
    for (int c = 0; c < unknown_count_; ++c) columns_[c + 1] = columns_[c] + 1 + lengths[c];
    rows_.resize(static_cast<std::size_t>(columns_.back()));
    for (int c = 0; c < unknown_count_; ++c) {
        int* row = rows_.data() + columns_[c];
        *row++ = c;
        std::copy_n(repeated.begin() + static_cast<std::ptrdiff_t>(starts[c]), lengths[c], row);
    }
    repeated = {};

    slots_.resize(slot_offsets_.back());
    parallel_for(0, elements, [&](int begin, int end) {
        for (int e = begin; e < end; ++e) {
            const auto u = this->unknowns(e);
            int* slot = slots_.data() + slot_offsets_[e];
            for (std::size_t i = 0; i < u.size(); ++i)
                for (std::size_t j = 0; j <= i; ++j, ++slot) {
                    if (u[i] < 0 || u[j] < 0) {
                        *slot = -1;
                        continue;
                    }
                    const auto [column, row] = std::minmax(u[i], u[j]);
                    const auto first = rows_.begin() + columns_[column], last = rows_.begin() + columns_[column + 1];
                    const auto at = row == column ? first : std::lower_bound(first + 1, last, row);
                    *slot = static_cast<int>(at - rows_.begin());
                }
        }
    });
}

}  // namespace beltrami::detail
