#pragma once

#include <span>
#include <vector>

#include <beltrami/constraints/boundary_condition.h>
#include <beltrami/linear/element_system.h>

namespace beltrami::detail {

/// #V: whether a vertex is fixed.
std::vector<char> fixed_vertices(const std::vector<Freedom>& freedoms);

/// ∫|∇u|² of real functions on a surface and its Laplacian L_ij = Σ A Re(conj(g_i) g_j), cotangent weights on
/// triangles, with the vertices that are held eliminated. Also of functions that are known up to sign: then the value
/// at a corner is that of its vertex times the corner's sign (branched_cover.h). Analysed once; factorised at
/// construction and for any weights since.
class Laplacian {
  public:
    /// @param operators is kept by reference
    /// @param held      #V; vertices in no sample count as held
    /// @param expected_factorizations see ElementSystem
    /// @param signs     beside operators.vertices; empty: all are +1
    /// @throw Error not_solved as ElementSystem::factorize
    Laplacian(const Operators& operators, const std::vector<char>& held, int expected_factorizations = 1,
              std::vector<signed char> signs = {});

    /// Factorises for the weights Σ weights Re(conj(g_i) g_j) instead of areas.
    /// @param weights #S, positive
    void factorize(std::span<const double> weights);

    /// Solves L u = force at the vertices that are not held, u = 0 at the others, for every column: ½ d(energy)/du is
    /// then the force.
    /// @param force #V×n, ignored where held
    /// @return #V×n
    Eigen::MatrixXd solve(const Eigen::MatrixXd& force) const;
    /// The functions with the given values where they are held, harmonic elsewhere and without flux through the rest of
    /// the boundary.
    /// @param values #V×n, ignored at the vertices that are not held
    /// @return #V×n
    /// @pre the last factorisation is of the areas
    Eigen::MatrixXd extend(const Eigen::MatrixXd& values) const;

    /// L u = ½ d(energy)/du, all of it (#V), of the areas.
    Eigen::VectorXd apply(const Eigen::VectorXd& u) const;
    /// The energy, of the areas, summed from squares.
    double energy(const Eigen::VectorXd& u) const;

    int factorization_count() const { return system_.factorization_count(); }

  private:
    double sign(int corner) const { return signs_.empty() ? 1.0 : signs_[corner]; }
    /// L's entry of two corners of a sample.
    double entry(int i, int j, double weight) const {
        return weight * sign(i) * sign(j) * std::real(std::conj(operators_.gradients[i]) * operators_.gradients[j]);
    }
    /// ∇u on a sample.
    Complex gradient(int sample, const Eigen::VectorXd& u) const;
    void put_back(const Eigen::MatrixXd& solution, Eigen::MatrixXd& of_vertices) const;

    const Operators& operators_;
    std::vector<signed char> signs_;
    std::vector<int> unknown_;  // #V, −1 where held
    ElementSystem system_;
};

}  // namespace beltrami::detail
