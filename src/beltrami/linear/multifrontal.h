#pragma once

#include <cstddef>
#include <vector>

#include <beltrami/linear/supernodal_factor.h>

namespace beltrami::detail {

/// The values of a supernodal Cholesky factor by the multifrontal method (Duff & Reid 1983): each supernode adds up
/// what its children in the elimination tree leave over, is factorised as a dense matrix, and leaves an update to its
/// parent. The updates lie on a stack. Where supernodes have few columns this takes a third of the time of CHOLMOD's
/// left-looking method, which looks for its descendants' rows one by one.
class MultifrontalCholesky {
  public:
    /// The dense part of a supernode: of the @p rows × @p columns panel (by columns) the first rows become their
    /// Cholesky factor L, in the lower triangle, the rest R becomes R L⁻ᵀ =: B, and B Bᵀ is subtracted from the lower
    /// triangle of the square @p update, which has a row for each of B's. @return false if a pivot is not positive
    using DensePart = bool (*)(int rows, int columns, double* panel, double* update);

    /// @param pattern of the factor, without values; numbered in postorder
    /// @param begins, rows the lower triangle of the matrix by columns, compressed, in its own order
    MultifrontalCholesky(const SupernodalView& pattern, const int* begins, const int* rows);

    /// @param lower  values of the matrix, as the rows were given
    /// @param values of the factor, as the pattern says where
    /// @return false if a pivot is not positive
    bool factorize(const double* lower, double* values, DensePart dense);

  private:
    int rows_of(int s) const { return row_begin_[s + 1] - row_begin_[s]; }
    int columns_of(int s) const { return super_[s + 1] - super_[s]; }
    /// Rows of the update of a supernode.
    int left_of(int s) const { return rows_of(s) - columns_of(s); }
    void find_targets(const SupernodalView& pattern, const int* begins, const int* rows);
    void add_update(int child, const double* from, int to, double* panel, double* update);

    std::vector<int> super_, row_begin_, rows_;
    std::vector<std::size_t> value_begin_;
    std::vector<int> parent_, children_;  ///< of supernodes: −1 for a root; how many
    std::vector<std::size_t> target_;     ///< of every entry of the matrix among the factor's values
    std::vector<int> place_;              ///< of a row within the supernode at hand
    std::vector<int> in_parent_;          ///< of a child's rows, the same
    std::vector<double> stack_;
};

}  // namespace beltrami::detail
