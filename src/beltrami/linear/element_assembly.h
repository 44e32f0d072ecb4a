#pragma once

#include <span>
#include <vector>

#include <beltrami/linear/symmetric_solver.h>

namespace beltrami {

/// Where the small dense matrices of elements go in one sparse symmetric matrix: the pattern is found once, the values
/// are then added straight into place as often as they change.
class ElementAssembly {
  public:
    /// @param offsets  #elements+1
    /// @param unknowns unknowns of the elements, element after element; −1 for one that is eliminated
    /// @param unknown_count number of unknowns; each must occur in some element
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
    /// Lower triangle with zero values.
    SymmetricSolver::Matrix pattern() const;

  private:
    std::vector<int> offsets_, unknowns_;
    std::vector<std::size_t> slot_offsets_;
    std::vector<int> slots_;
    int unknown_count_;
    std::vector<int> columns_, rows_;  ///< compressed lower pattern
};

}  // namespace beltrami
