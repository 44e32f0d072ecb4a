#pragma once

#include <vector>

#include <beltrami/teichmuller/balance.h>
#include <beltrami/teichmuller/sphere_problem.h>

namespace beltrami {

/// Landmarks that need not be met: places x of the landmarks are sought at which
///
///     J(x) = ½ log K(x) + Σ w_i |x_i − t_i|²
///
/// is least, K(x) the dilatation of the extremal map that takes the landmarks to x. Its derivative in the direction of
/// a motion V of the image is that of Teichmüller's metric,
///
///     δ ½ log K = Re ∫ φ V_w̄ conj(p)/p / ∫|φ|,   p = ∂f,
///
/// which depends on V at the landmarks only, as φ is holomorphic: V is a smooth field (landmark_flow.h), over which the
/// noise of the mesh averages out. Every trial map is carried along and settled by a few steps (balance.h).
class SoftLandmarks final : private Balanced {
  public:
    /// All are kept by reference.
    /// @param vertices of the landmarks
    /// @param wanted   #L×3 unit vectors t
    /// @param weights  #L, infinite for those that are met
    /// @param options  of the iteration that settles a map
    SoftLandmarks(const Surface& source, SphereProblem& problem, SphereMapStep& step, const std::vector<int>& vertices,
                  Positions wanted, Eigen::VectorXd weights, HamiltonIteration::Options options);

    /// Moves the landmarks until J settles; the map of the step comes along.
    /// @return steps of the map that were taken
    int settle();

    /// Where the landmarks are.
    const Positions& places() const { return places_; }

  private:
    Eigen::VectorXd coordinates() const override;
    double value() const override;
    Eigen::VectorXd gradient() const override;
    bool move(const Eigen::VectorXd& step) override;
    void undo() override;
    void follow();

    const Surface& source_;
    SphereProblem& problem_;
    SphereMapStep& step_;
    const std::vector<int>& vertices_;
    Positions wanted_, places_;
    Eigen::VectorXd weights_;
    HamiltonIteration::Options options_;
    double width_ = 0;
    CoefficientStep::Result last_;  // c-step
    int steps_ = 0;
    Positions places_before_;
    std::any map_before_;
    CoefficientStep::Result last_before_;
};

}  // namespace beltrami
