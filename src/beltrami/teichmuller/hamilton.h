#pragma once

#include <memory>

#include <beltrami/maps/beltrami_solver.h>
#include <beltrami/teichmuller/coefficient_step.h>
#include <beltrami/teichmuller/extremal_map.h>

namespace beltrami {

/// Where the iteration stands: a space of differentials, φ in it, and k. No space: nothing is known yet.
struct HamiltonState {
    std::unique_ptr<DifferentialSpace> space;
    Eigen::VectorXcd direction;  ///< coefficients of φ, of length 1
    double k = 0;
};

/// Hamilton's iteration, the one loop for every topology: the c-step finds φ and k of a map, the f-step the map with
/// the coefficient k conj(φ)/|φ|, until both settle. Anderson acceleration on (direction of φ, k).
class HamiltonIteration {
  public:
    /// All are kept by reference. @param solver factorised for a coefficient near where the iteration starts, or for
    /// any
    HamiltonIteration(const Surface& source, BeltramiSolver& solver, const Eigen::VectorXcd& prescribed,
                      CoefficientStep& coefficient_step, const ExtremalOptions& options);

    /// Runs from @p state, or where that knows nothing from the c-step of @p start in @p smallest, a first space.
    /// state.space is the last space used; last_step() belongs to it.
    /// @param may_grow_in_the_end whether a larger space is tried once all has settled
    void run(HamiltonState& state, const Eigen::VectorXcd& start, std::unique_ptr<DifferentialSpace> smallest,
             bool may_grow_in_the_end);

    const Eigen::VectorXcd& map() const { return map_; }
    /// The c-step of map().
    const CoefficientStep::Result& last_step() const { return step_; }
    const std::vector<Iteration>& history() const { return history_; }
    int iterations() const { return iterations_; }
    bool converged() const { return converged_; }

  private:
    bool grow(HamiltonState& state, const Eigen::VectorXcd& mu);

    const Surface& source_;
    BeltramiSolver& solver_;
    const Eigen::VectorXcd& prescribed_;
    CoefficientStep& coefficient_step_;
    const ExtremalOptions& options_;
    Eigen::VectorXcd map_;
    CoefficientStep::Result step_;
    std::vector<Iteration> history_;
    int iterations_ = 0;
    bool converged_ = false;
};

}  // namespace beltrami
