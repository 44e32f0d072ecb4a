#include <beltrami/linear/multifrontal.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>

namespace beltrami::detail {

namespace {

std::size_t square(int n) {
    return static_cast<std::size_t>(n) * static_cast<std::size_t>(n);
}

/// An update on the stack.
struct Update {
    int supernode;
    std::size_t begin;
};

/// The supernode of every column.
std::vector<int> supernode_of_columns(const std::vector<int>& super, int columns) {
    std::vector<int> result(static_cast<std::size_t>(columns));
    for (int s = 0; s + 1 < static_cast<int>(super.size()); ++s)
        std::fill(result.begin() + super[s], result.begin() + super[s + 1], s);
    return result;
}

}  // namespace

MultifrontalCholesky::MultifrontalCholesky(const SupernodalView& pattern, const int* begins, const int* rows)
    : super_(pattern.super, pattern.super + pattern.supernode_count + 1),
      row_begin_(pattern.row_begin, pattern.row_begin + pattern.supernode_count + 1),
      rows_(pattern.rows, pattern.rows + pattern.row_begin[pattern.supernode_count]),
      value_begin_(pattern.value_begin, pattern.value_begin + pattern.supernode_count + 1),
      parent_(static_cast<std::size_t>(pattern.supernode_count), -1),
      children_(static_cast<std::size_t>(pattern.supernode_count), 0),
      place_(static_cast<std::size_t>(pattern.size)) {
    find_targets(pattern, begins, rows);
    const std::vector<int> of_column = supernode_of_columns(super_, pattern.size);
    std::size_t top = 0, largest = 0;
    int longest = 0;
    std::vector<Update> updates;
    for (int s = 0; s < pattern.supernode_count; ++s) {
        largest = std::max(largest, top + square(left_of(s)));
        longest = std::max(longest, left_of(s));
        for (; !updates.empty() && parent_[updates.back().supernode] == s; updates.pop_back()) {
            top = updates.back().begin;
            ++children_[s];
        }
        if (left_of(s) == 0) continue;
        parent_[s] = of_column[rows_[row_begin_[s] + columns_of(s)]];
        updates.push_back({s, top});
        top += square(left_of(s));
    }
    if (!updates.empty()) throw std::logic_error("MultifrontalCholesky: supernodes are not in postorder");
    stack_.resize(largest);
    in_parent_.resize(static_cast<std::size_t>(longest));
}

/// Entries are sorted by their supernodes, so that the places of rows are looked up once for each of these.
void MultifrontalCholesky::find_targets(const SupernodalView& pattern, const int* begins, const int* rows) {
    const int n = pattern.size, supernodes = pattern.supernode_count;
    std::vector<int> in_factor(static_cast<std::size_t>(n));
    for (int i = 0; i < n; ++i) in_factor[pattern.permutation[i]] = i;
    const std::vector<int> of_column = supernode_of_columns(super_, n);
    const auto each = [&](auto&& act) {
        for (int c = 0; c < n; ++c)
            for (int e = begins[c]; e < begins[c + 1]; ++e) {
                const auto [column, row] = std::minmax(in_factor[c], in_factor[rows[e]]);
                act(e, column, row);
            }
    };
    struct Entry {
        int index, column, row;
    };
    std::vector<int> first(static_cast<std::size_t>(supernodes) + 1, 0);
    each([&](int, int column, int) { ++first[of_column[column] + 1]; });
    for (int s = 0; s < supernodes; ++s) first[s + 1] += first[s];
    std::vector<Entry> entries(static_cast<std::size_t>(begins[n]));
    std::vector<int> fill(first.begin(), first.end() - 1);
    each([&](int e, int column, int row) { entries[fill[of_column[column]]++] = {e, column, row}; });
    target_.resize(entries.size());
    for (int s = 0; s < supernodes; ++s) {
        for (int k = row_begin_[s]; k < row_begin_[s + 1]; ++k) place_[rows_[k]] = k - row_begin_[s];
        for (int i = first[s]; i < first[s + 1]; ++i)
            target_[entries[i].index] = value_begin_[s] +
                                        static_cast<std::size_t>(entries[i].column - super_[s]) * rows_of(s) +
                                        static_cast<std::size_t>(place_[entries[i].row]);
    }
}

/// Adds what a child leaves over to its parent's panel and update; place_ is that of the parent's rows.
void MultifrontalCholesky::add_update(int child, const double* from, int to, double* panel, double* update) {
    const int size = left_of(child), height = rows_of(to), columns = columns_of(to), rest = height - columns;
    const int* const rows = rows_.data() + row_begin_[child] + columns_of(child);
    for (int i = 0; i < size; ++i) in_parent_[i] = place_[rows[i]];
    const int* const in_parent = in_parent_.data();
    for (int j = 0; j < size; ++j, from += size) {
        const int at = in_parent[j];
        double* const column = at < columns ? panel + static_cast<std::ptrdiff_t>(at) * height
                                            : update + static_cast<std::ptrdiff_t>(at - columns) * rest - columns;
        for (int i = j; i < size; ++i) column[in_parent[i]] += from[i];
    }
}

bool MultifrontalCholesky::factorize(const double* lower, double* values, DensePart dense) {
    const int supernodes = static_cast<int>(super_.size()) - 1;
    std::fill(values, values + value_begin_.back(), 0.0);
    for (std::size_t e = 0; e < target_.size(); ++e) values[target_[e]] += lower[e];
    std::vector<Update> updates;
    std::size_t top = 0;
    for (int s = 0; s < supernodes; ++s) {
        double *const panel = values + value_begin_[s], *const update = stack_.data() + top;
        const std::size_t size = square(left_of(s));
        std::fill(update, update + size, 0.0);
        for (int k = row_begin_[s]; k < row_begin_[s + 1]; ++k) place_[rows_[k]] = k - row_begin_[s];
        const auto first = updates.end() - children_[s];
        for (auto child = first; child != updates.end(); ++child)
            add_update(child->supernode, stack_.data() + child->begin, s, panel, update);
        if (!dense(rows_of(s), columns_of(s), panel, update)) return false;
        if (first != updates.end()) top = first->begin;
        updates.erase(first, updates.end());
        if (size == 0) continue;
        std::memmove(stack_.data() + top, update, size * sizeof(double));
        updates.push_back({s, top});
        top += size;
    }
    return true;
}

}  // namespace beltrami::detail
