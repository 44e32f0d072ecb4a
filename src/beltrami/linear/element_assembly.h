#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace beltrami::detail {

/// Where the small dense matrices of elements go in one sparse symmetric matrix, private to the layer: the pattern is
/// found once, the values are then added straight into place as often as they change.
class ElementAssembly {
  public:
    /// @param offsets  #elements+1
    /// @param unknowns unknowns of the elements, element after element; −1 for one that is eliminated
    /// @param unknown_count number of unknowns; one in no element has its place on the diagonal all the same
    ElementAssembly(std::vector<int> offsets, std::vector<int> unknowns, int unknown_count);

    int element_count() const { return static_cast<int>(offsets_.size()) - 1; }
    int unknown_count() const { return unknown_count_; }
    /// Unknowns of an element, −1 where eliminated.
    std::span<const int> unknowns(int element) const {
        return {unknowns_.data() + offsets_[element],
                static_cast<std::size_t>(offsets_[element + 1] - offsets_[element])};
    }
    /// Value slots of the pairs (0,0), (1,0), (1,1), (2,0) … of an element; −1 where one of the two is eliminated.
    std::span<const int> slots(int element) const {
        const int n = offsets_[element + 1] - offsets_[element];
        return {slots_.data() + slot_offsets_[element], static_cast<std::size_t>(n * (n + 1) / 2)};
    }
    /// The lower triangle by columns: #unknowns+1 where each begins, and the rows in it, ascending from the diagonal.
    const std::vector<int>& columns() const { return columns_; }
    const std::vector<int>& rows() const { return rows_; }

  private:
    std::vector<int> offsets_, unknowns_;
    std::vector<std::size_t> slot_offsets_;
    std::vector<int> slots_;
    int unknown_count_;
    std::vector<int> columns_, rows_;
};

}  // namespace beltrami::detail
