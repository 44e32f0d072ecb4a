#pragma once

#include <functional>

#include <beltrami/targets/target.h>

namespace beltrami BELTRAMI_PUBLIC {

/// A surface F = 0, seen from where F > 0.
class ImplicitTarget final : public Target {
  public:
    struct Jet {
        double value;
        Eigen::Vector3d gradient;  ///< not 0 near the surface
    };
    using Function = std::function<Jet(const Eigen::Vector3d&)>;

    explicit ImplicitTarget(Function function) : function_(std::move(function)) {}
    /// That found by Newton's steps along the gradient, and tangential ones back to below the point.
    Point nearest(const Eigen::Vector3d& point) const override;

  private:
    Point onto(Eigen::Vector3d point) const;

    Function function_;
};

/// The ellipsoid with these half-axes, seen from outside; a spheroid has two that are equal.
/// @throw Error bad_option unless they are positive
ImplicitTarget ellipsoid_target(const Eigen::Vector3d& half_axes);

}  // namespace beltrami
