#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <beltrami/coefficient/coefficient_step.h>
#include <beltrami/differentials/quadratic_differential.h>
#include <beltrami/solve/sphere_map_step.h>
#include <beltrami/teichmuller/hamilton.h>

namespace beltrami {

/// The c-step of maps of a closed surface of genus 0 with landmarks, which depends on the surface and on the landmarks
/// there, and not on where they go.
class SphereProblem {
  public:
    /// @param source    kept by reference
    /// @param on_sphere #V×3: a conformal map to the unit sphere
    /// @param landmarks distinct vertices, at least 4
    SphereProblem(const Surface& source, const Positions& on_sphere, std::vector<int> landmarks, int cluster_count);
    SphereProblem(const SphereProblem&) = delete;
    SphereProblem& operator=(const SphereProblem&) = delete;

    /// The iteration from where step and state stand; goes on with its φ when called again.
    /// @throw Error cancelled, not_solved
    HamiltonIteration settle(SphereMapStep& step, const HamiltonIteration::Options& options);

    const HamiltonState& state() const { return state_; }
    int dimension() const { return static_cast<int>(landmarks_.size()) - 3; }
    QuadraticDifferential differential(const Eigen::VectorXcd& coefficients) const;
    /// k and φ of a map as it stands.
    CoefficientStep::Result coefficient_step(const Eigen::VectorXcd& mu);

  private:
    const Surface& source_;
    std::vector<int> landmarks_;
    std::shared_ptr<const Chart> chart_;
    std::shared_ptr<const DifferentialSpace> space_;
    std::optional<CoefficientStep> coefficient_step_;
    HamiltonState state_;
};

}  // namespace beltrami
