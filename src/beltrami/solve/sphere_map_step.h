#pragma once

#include <memory>
#include <span>

#include <beltrami/solve/map_step.h>
#include <beltrami/solve/sphere_barrier.h>

namespace beltrami {

/// The f-step of maps of a surface to the unit sphere with pinned vertices: one step down the barrier energy towards
/// the given coefficient (sphere_barrier.h). Samples count by their part of ∫|φ|, and in any case by a little of their
/// area: where φ vanishes faces would be left to flip.
class SphereMapStep final : public MapStep {
  public:
    /// @param source kept by reference
    /// @param pinned vertices that stay
    /// @param points #V×3 unit vectors, no face flipped
    SphereMapStep(const Surface& source, std::span<const int> pinned, Positions points);

    const Positions& points() const { return points_; }
    void set_points(Positions points) { points_ = std::move(points); }
    /// How much of its last step was taken; 0: none lowered the energy.
    double last_length() const { return last_length_; }
    int factorization_count() const { return barrier_.factorization_count(); }

    void weigh(const Eigen::VectorXcd& phi) override;
    void solve(const Eigen::VectorXcd& nu, double tolerance) override;
    MapDerivatives derivatives() const override { return beltrami::derivatives(source_.operators, points_, points_); }
    std::any snapshot() const override { return points_; }
    void restore(const std::any& snapshot) override { points_ = std::any_cast<const Positions&>(snapshot); }

  private:
    const Surface& source_;
    Operators shapes_;  // in which the energy is measured: no needles
    SphereBarrier barrier_;
    std::vector<double> weights_;
    Positions points_;
    double last_length_ = 1;
};

}  // namespace beltrami
