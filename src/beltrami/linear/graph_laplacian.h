#pragma once

#include <array>
#include <span>
#include <vector>

#include <beltrami/linear/element_system.h>

namespace beltrami {

/// The Laplacian of a graph with weights on its edges, vertices that are held eliminated:
/// (L u)_a = Σ w_ab (u_a − u_b) over the edges of a. Analysed once; any number of weights.
class GraphLaplacian {
  public:
    /// @param edges  vertices; the same two may be joined more than once, and a vertex with itself, which adds nothing
    /// @param held   #V
    /// @param expected_factorizations see ElementSystem
    GraphLaplacian(std::vector<std::array<int, 2>> edges, const std::vector<char>& held,
                   int expected_factorizations = 1);

    /// #V numbers of the vertices that are not held; −1 for those that are.
    const std::vector<int>& unknowns() const { return unknown_; }
    int unknown_count() const { return system_.unknown_count(); }

    /// Assembles for weights; then factorize().
    /// @param weights #edges
    void set(std::span<const double> weights);
    /// Mean of the absolute values of the diagonal.
    double mean_diagonal() const;
    /// Adds to the whole diagonal; then factorize().
    void shift_diagonal(double value);
    /// Adds to the diagonal at every vertex that is not held (#V); then factorize().
    void add_to_diagonal(const Eigen::VectorXd& values);
    /// @throw Error not_solved as ElementSystem::factorize
    void factorize() { system_.factorize(); }

    /// Solves L u = load at the vertices that are not held, u = 0 at the others, for every column.
    /// @param load #V×n, ignored where held
    /// @return #V×n
    /// @throw Error not_solved as ElementSystem::solve
    Eigen::MatrixXd solve(const Eigen::MatrixXd& load) const;
    /// The complex function with the given values where they are held and L u = 0 elsewhere.
    /// @param values #V, ignored where not held
    /// @return #V
    Eigen::VectorXcd extend(Eigen::VectorXcd values) const;
    /// What flows to each held vertex (#V, 0 elsewhere) of a function that is 0 where it is held.
    Eigen::VectorXd flux(const Eigen::VectorXd& u) const;

  private:
    /// Calls act(inner vertex, held vertex, weight) for every edge that has one of each.
    template <class Act>
    void each_link(Act&& act) const;
    std::vector<std::array<int, 2>> edges_;
    std::vector<int> unknown_;
    ElementSystem system_;
    std::vector<double> weights_;
};

}  // namespace beltrami
