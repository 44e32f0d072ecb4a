#pragma once

#include <limits>

#include <beltrami/solve/beltrami_solver.h>

namespace beltrami {

/// The f-step of a problem: the map with a given coefficient that obeys the boundary condition.
class MapStep {
  public:
    virtual ~MapStep() = default;
    /// Makes @p map the map with a coefficient, from where it stands.
    /// @param nu        #S coefficients in the samples' frames, |ν| < 1
    /// @param map       #V
    /// @param tolerance of the error, relative to the map, in the energy norm: more need not be had
    virtual void solve(const Eigen::VectorXcd& nu, Eigen::VectorXcd& map, double tolerance) = 0;
};

/// Fixed boundary values, pins and lines inside: one linear solve, which depends on the present map by rounding only.
class FixedMapStep final : public MapStep {
  public:
    /// @param solver kept by reference
    explicit FixedMapStep(BeltramiSolver& solver) : solver_(solver) {}
    /// @param prescribed #V values of the fixed vertices, points on their lines for sliding ones
    /// @param directions #V of sliding vertices; empty if none slides
    void prescribe(Eigen::VectorXcd prescribed, Eigen::VectorXcd directions) {
        prescribed_ = std::move(prescribed);
        directions_ = std::move(directions);
    }
    /// Whether the solver's last factorisation is of a coefficient near the next one, so that conjugate gradients with
    /// it may do.
    void set_near(bool near) {
        near_ = near;
        given_up_at_ = std::numeric_limits<double>::infinity();
    }

    void solve(const Eigen::VectorXcd& nu, Eigen::VectorXcd& map, double tolerance) override;

  private:
    BeltramiSolver& solver_;
    Eigen::VectorXcd prescribed_, directions_;
    bool near_ = false;
    double given_up_at_ = std::numeric_limits<double>::infinity();  ///< tolerance at which near_ was not near enough
};

}  // namespace beltrami
