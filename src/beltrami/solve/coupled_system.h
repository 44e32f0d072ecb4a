#pragma once

#include <vector>

#include <beltrami/constraints/boundary_condition.h>
#include <beltrami/linear/element_system.h>

namespace beltrami {

/// The linear system of a Newton step for an energy of maps that is a sum over samples and couples real and imaginary
/// parts: two unknowns a vertex that is not fixed. One symbolic analysis.
class CoupledSystem {
  public:
    /// @param operators kept by reference; every vertex that is not fixed occurs in some sample
    /// @param expected_factorizations see ElementSystem
    CoupledSystem(const Operators& operators, const std::vector<Freedom>& freedoms, int expected_factorizations);

    struct Step {
        Eigen::VectorXcd direction;  ///< #V, 0 at fixed vertices
        double slope = 0;            ///< of the energy along it, negative
    };

    void set_zero();
    /// Adds the derivatives of one sample's part of the energy by the real and imaginary parts of its stencil, vertex
    /// by vertex.
    /// @param hessian lower triangle by rows: (0,0), (1,0), (1,1), (2,0) …
    void add(int sample, const double* gradient, const double* hessian);
    /// Multiplies the diagonal of what was added: Levenberg's and Marquardt's damping.
    void scale_diagonal(double factor);
    /// Factorises what was added and takes the Newton step.
    /// @throw Error not_solved where it is not positive definite
    Step solve();

    int factorization_count() const { return system_.factorization_count(); }

  private:
    std::vector<int> place_;  // #V among those that are not fixed, −1 where fixed; twice it the first unknown
    ElementSystem system_;
    Eigen::VectorXd gradient_;
};

/// Fixes what an energy that similarities of the image do not change leaves undetermined: vertices in no face, and in
/// every component that has no fixed vertex two far apart, where one is fixed one more.
void fix_similarity(const Surface& source, const Eigen::VectorXcd& map, std::vector<Freedom>& freedoms);

}  // namespace beltrami
