#pragma once

#include <any>
#include <limits>

#include <beltrami/operators/map_derivatives.h>
#include <beltrami/solve/beltrami_solver.h>

namespace beltrami {

/// The f-step of a problem: it owns a map, and makes it the map with a given coefficient that obeys the constraints.
class MapStep {
  public:
    virtual ~MapStep() = default;
    /// Told before each solve(): the φ (#S) whose coefficient comes next, by which a step may weigh the samples.
    virtual void weigh(const Eigen::VectorXcd& /*phi*/) {}
    /// Makes the map that with a coefficient, from where it stands.
    /// @param nu        #S coefficients in the samples' frames, |ν| < 1
    /// @param tolerance of the error, relative to the map, in the energy norm: more need not be had
    virtual void solve(const Eigen::VectorXcd& nu, double tolerance) = 0;
    /// Of the map as it stands.
    virtual MapDerivatives derivatives() const = 0;
    /// The map as it stands, to come back to.
    virtual std::any snapshot() const = 0;
    /// @param snapshot of this step
    virtual void restore(const std::any& snapshot) = 0;
};

/// A map to the plane.
class PlaneMapStep : public MapStep {
  public:
    const Eigen::VectorXcd& map() const { return map_; }  ///< #V
    void set_map(Eigen::VectorXcd map) { map_ = std::move(map); }

    MapDerivatives derivatives() const override { return beltrami::derivatives(operators_, map_); }
    std::any snapshot() const override { return map_; }
    void restore(const std::any& snapshot) override { map_ = std::any_cast<const Eigen::VectorXcd&>(snapshot); }

  protected:
    /// @param operators kept by reference
    explicit PlaneMapStep(const Operators& operators) : operators_(operators) {}

    const Operators& operators_;
    Eigen::VectorXcd map_;
};

/// Fixed boundary values, pins and lines inside: one linear solve, which depends on the present map by rounding only.
class FixedMapStep final : public PlaneMapStep {
  public:
    /// @param source, solver kept by reference
    FixedMapStep(const Surface& source, BeltramiSolver& solver) : PlaneMapStep(source.operators), solver_(solver) {}
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

    void solve(const Eigen::VectorXcd& nu, double tolerance) override;

  private:
    BeltramiSolver& solver_;
    Eigen::VectorXcd prescribed_, directions_;
    bool near_ = false;
    double given_up_at_ = std::numeric_limits<double>::infinity();  ///< tolerance at which near_ was not near enough
};

}  // namespace beltrami
