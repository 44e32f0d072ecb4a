#pragma once

#include <beltrami/targets/target.h>
#include <beltrami/targets/target_domain.h>

namespace beltrami BELTRAMI_PUBLIC {

/// The unit sphere, seen from outside. Maps that hold no vertex are centred by Möbius maps (sphere/centring.h).
class SphereTarget final : public Target {
  public:
    Point nearest(const Eigen::Vector3d& point) const override;
    Points centred(Points points, const Eigen::VectorXd& weights) const override;
    /// Less what the motion has of Möbius maps (sphere/moebius_drift.h).
    Positions without_drift(const Positions& points, Positions motion, const Eigen::VectorXd& weights) const override;
};

/// The plane z = 0, seen from above.
class PlaneTarget : public Target {
  public:
    Point nearest(const Eigen::Vector3d& point) const override;
};

/// A domain of it, bounded by its curves. Points are not kept inside: what holds them is that boundary vertices slide
/// along the curves and that no face is flipped.
class DomainTarget final : public PlaneTarget {
  public:
    explicit DomainTarget(const TargetDomain& domain);
    /// In the order of the domain's curves.
    SlideCurves boundary() const override { return curves_; }

  private:
    SlideCurves curves_;
};

}  // namespace beltrami
