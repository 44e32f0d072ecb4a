#pragma once

#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/targets/target.h>

namespace beltrami BELTRAMI_PUBLIC {

/// Points along a locally shortest way between two points of a target, both included: its middle, the middles of the
/// halves and so on, each the point of the target in the middle of its neighbours. On the sphere arcs of great circles,
/// in the plane straight lines; of a smooth surface the geodesic that the chord leads to, to second order.
/// @param pieces power of two
/// @throw Error bad_boundary where the points are opposite to each other, so that the chord leads nowhere
Target::Points straight_way(const Target& target, const Target::Point& from, const Target::Point& to, int pieces = 64);

/// A polyline whose points are taken to a smooth target, such as one of straight_way(): by the arc length of its
/// chords.
class CurveOnTarget final : public SlideCurve {
  public:
    /// @param target kept by reference
    /// @param points as PolylineCurve
    CurveOnTarget(const Target& target, const Positions& points, bool closed)
        : target_(target), chords_(points, closed) {}
    double length() const override { return chords_.length(); }
    bool closed() const override { return chords_.closed(); }
    Eigen::Vector3d point(double s) const override { return target_.nearest(chords_.point(s)).position; }
    /// Across the target's normal.
    Eigen::Vector3d tangent(double s) const override;
    double nearest(const Eigen::Vector3d& point) const override { return chords_.nearest(point); }

  private:
    const Target& target_;
    PolylineCurve chords_;
};

}  // namespace beltrami
