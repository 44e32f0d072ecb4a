#pragma once

#include <numeric>
#include <utility>
#include <vector>

namespace beltrami {

/// Sets of the numbers 0 … n-1 that can be joined; the representative of a set is its smallest number.
class DisjointSets {
  public:
    explicit DisjointSets(int n) : parent_(static_cast<std::size_t>(n)) {
        std::iota(parent_.begin(), parent_.end(), 0);
    }

    int find(int i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void join(int i, int j) {
        i = find(i);
        j = find(j);
        if (i > j) std::swap(i, j);
        parent_[j] = i;
    }

  private:
    std::vector<int> parent_;
};

}  // namespace beltrami
