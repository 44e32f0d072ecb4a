#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace beltrami::detail {

/// A supernodal Cholesky factor P A Pᵀ = L Lᵀ as CHOLMOD holds it: supernode s has the columns super[s] … super[s+1]−1
/// and the rows rows[row_begin[s]] … (its own columns first), stored by columns from values[value_begin[s]].
/// Supernodes are numbered in postorder.
struct SupernodalView {
    int size = 0;
    int supernode_count = 0;
    const int* super = nullptr;
    const int* row_begin = nullptr;
    const int* value_begin = nullptr;
    const int* rows = nullptr;
    const double* values = nullptr;
    const int* permutation = nullptr;  ///< row of A of every row of L
};

/// A copy of a factor in single precision that solves for two right-hand sides at once, subtrees of the elimination
/// tree in parallel: made to precondition, where its seven digits do as well as sixteen and half the memory is read.
/// The result does not depend on the number of threads.
class SupernodalFactor {
  public:
    /// Copies the pattern: once per analysis.
    explicit SupernodalFactor(const SupernodalView& factor);

    /// Copies the values. @return false if one does not fit into single precision; then solve() must not be called
    bool load(const SupernodalView& factor);

    /// solution ≈ A⁻¹ rhs, to single precision of every column of its own.
    void solve(const Eigen::MatrixXd& rhs, Eigen::MatrixXd& solution);

  private:
    void solve_two(const double* first, const double* second, double* first_solution, double* second_solution);
    void forward(int begin, int end, float* scratch);
    void backward(int begin, int end, float* scratch);

    int size_;
    std::vector<int> super_, row_begin_, rows_, permutation_;
    std::vector<std::size_t> value_begin_;
    std::vector<float> values_;
    /// Where forward() adds what rows_ names: the row itself within a task's subtree, else the task's own copy of it,
    /// beyond size_.
    std::vector<int> targets_;
    struct Task {
        int begin, end;  ///< supernodes of the subtree
        int copy_begin;  ///< its copies of rows outside stand for root_rows, one after the other
        int root_rows_begin, root_rows_end;
    };
    std::vector<Task> tasks_;
    std::vector<int> rest_;      ///< supernodes above all tasks, in ascending order
    std::vector<float> vector_;  ///< two numbers a row, the copies behind
    std::size_t scratch_size_;
    std::vector<float> scratch_;  ///< of every task, and of the rest
};

}  // namespace beltrami::detail
