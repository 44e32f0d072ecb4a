#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <beltrami/linear/element_assembly.h>

namespace beltrami {

namespace detail {
class SymmetricSolver;
}

/// A sparse symmetric positive definite system that is the sum of small dense matrices, one for each element: a sample
/// and its stencil, an edge and its ends. Which unknowns meet in which element stays while the values change. How the
/// matrix is stored and factorised is hidden.
///
///     ElementSystem system(offsets, nodes, count, 10);  // ordering and symbolic analysis, once
///     system.clear();                                   // new values, as often as you like:
///     for (int e = 0; e < system.element_count(); ++e) system.add(e, …);
///     system.factorize();
///     x = system.solve(rhs);
class ElementSystem {
  public:
    /// @param offsets    #elements+1
    /// @param nodes      those of the elements, element after element, different ones in each; −1 where one is
    /// eliminated
    /// @param node_count a node in no element has a zero diagonal unless something is added there
    /// @param expected_factorizations how often factorize() will be called: few take the cheap ordering (AMD), many the
    ///                                better one (METIS); see docs/performance.md
    /// @param block      unknowns of every node, 1 or 2, which are ordered as one: those of node n are block·n …
    ElementSystem(std::vector<int> offsets, std::vector<int> nodes, int node_count, int expected_factorizations,
                  int block = 1);
    ~ElementSystem();
    ElementSystem(ElementSystem&&) noexcept;
    ElementSystem& operator=(ElementSystem&&) noexcept;

    int element_count() const { return assembly_.element_count(); }
    /// Of the whole system: block times #nodes.
    int unknown_count() const { return block_ * assembly_.unknown_count(); }
    /// Nodes of an element, −1 where eliminated.
    std::span<const int> nodes(int element) const { return assembly_.unknowns(element); }

    /// A matrix of the same system that stands aside, to be put in place as it is or combined with another.
    class Values {
      public:
        /// Zero.
        explicit Values(const ElementSystem& system);
        void clear() { entries_.setZero(); }

      private:
        friend class ElementSystem;
        Eigen::VectorXd entries_;
    };

    /// Sets the matrix to zero.
    void clear();
    /// Adds the matrix of an element.
    /// @param lower its lower triangle by rows, (0,0), (1,0), (1,1), (2,0) …: a row for each unknown of its nodes, node
    ///              by node; what stands where a node is eliminated is not read
    void add(int element, std::span<const double> lower) {
        factorized_ = false;
        add(element, lower.data(), entries_);
    }
    /// The same to a matrix that stands aside.
    void add(int element, std::span<const double> lower, Values& to) const {
        add(element, lower.data(), to.entries_.data());
    }
    double diagonal(int unknown) const { return entries_[diagonal_at(unknown)]; }
    void add_to_diagonal(int unknown, double value);
    void scale_diagonal(double factor);
    /// Sets the matrix to @p a.
    void set(const Values& a);
    /// Sets the matrix to a + factor b.
    void set(const Values& a, double factor, const Values& b);

    /// @throw Error not_solved if the matrix is not numerically positive definite; indices() are the unknowns that
    /// carry
    ///        the null vector ("unconstrained"), the largest first.
    void factorize();

    /// Solves for every column of @p rhs (#unknowns × #rhs). One step of iterative refinement is taken where the
    /// residual asks for it.
    /// @pre nothing has changed since factorize()
    /// @throw Error not_solved if the relative residual stays above 1e-6
    Eigen::MatrixXd solve(const Eigen::MatrixXd& rhs) const;

    /// Solves with the present values by conjugate gradients, preconditioned by the last factorisation, which may
    /// belong to other values: a few steps where the two matrices are close, and much cheaper than a new factorisation.
    /// @param solution in: a first guess; out: the solution, if it was found
    /// @param tolerance of the error, relative to the solution, in the energy norm
    /// @return false if the steps allowed would not suffice (found out early); then factorize() and solve()
    bool solve_near(const Eigen::MatrixXd& rhs, Eigen::MatrixXd& solution, double tolerance, int max_steps) const;

    /// Relative residual ‖Ax − b‖∞ / (‖A‖∞‖x‖∞ + ‖b‖∞) of the last solve.
    double last_residual() const;
    int factorization_count() const;

  private:
    void add(int element, const double* lower, double* entries) const {
        if (block_ == 2) return add_pairs(element, lower, entries);
        for (const int slot : assembly_.slots(element)) {
            if (slot >= 0) entries[slot] += *lower;
            ++lower;
        }
    }
    /// The same for two unknowns a node.
    void add_pairs(int element, const double* lower, double* entries) const {
        const auto nodes = assembly_.unknowns(element);
        const int* slot = assembly_.slots(element).data();
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            // Rows 2i and 2i+1 of the element's triangle.
            const double *first = lower + i * (2 * i + 1), *second = first + 2 * i + 1;
            for (std::size_t j = 0; j < i; ++j, ++slot) {
                if (*slot < 0) continue;
                const Pair at = pair_at(*slot, std::min(nodes[i], nodes[j]));
                const bool below = nodes[i] > nodes[j];  // else the block stands transposed
                entries[at.first] += first[2 * j];
                entries[at.first + 1] += below ? second[2 * j] : first[2 * j + 1];
                entries[at.second] += below ? first[2 * j + 1] : second[2 * j];
                entries[at.second + 1] += second[2 * j + 1];
            }
            if (*slot >= 0) {
                const Pair at = pair_at(*slot, nodes[i]);
                entries[at.first] += first[2 * i];
                entries[at.first + 1] += second[2 * i];
                entries[at.second + 1] += second[2 * i + 1];
            }
            ++slot;
        }
    }
    /// Where the two by two entries of a pair of nodes stand: in two columns.
    struct Pair {
        int first, second;  ///< of the row of the first unknown; in the second column the diagonal's is not stored
    };
    Pair pair_at(int slot, int column) const {
        const int* columns = assembly_.columns().data();
        const int begin = 4 * columns[column] - column, row = 2 * (slot - columns[column]);
        return {begin + row, begin + 2 * (columns[column + 1] - columns[column]) + row - 1};
    }
    int diagonal_at(int unknown) const {
        if (block_ == 1) return assembly_.columns()[unknown];
        const int column = unknown / 2, slot = assembly_.columns()[column];
        return unknown % 2 ? pair_at(slot, column).second + 1 : pair_at(slot, column).first;
    }

    detail::ElementAssembly assembly_;  // of nodes
    int block_;
    std::unique_ptr<detail::SymmetricSolver> solver_;
    double* entries_;          // of the matrix that the solver holds
    bool factorized_ = false;  // and not changed since
};

}  // namespace beltrami
