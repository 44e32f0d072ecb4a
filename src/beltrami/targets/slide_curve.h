#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

#include <beltrami/base/public.h>
#include <beltrami/mesh/mesh.h>
#include <beltrami/plane/target_curve.h>

namespace beltrami BELTRAMI_PUBLIC {

/// A curve on a target by its arc length s, along which vertices slide.
class SlideCurve {
  public:
    virtual ~SlideCurve() = default;
    virtual double length() const = 0;
    /// Whether it ends where it begins: parameters are then taken modulo length(), else they end at 0 and length().
    virtual bool closed() const = 0;
    virtual Eigen::Vector3d point(double s) const = 0;
    /// Of length 1. At a corner of a polyline the mean direction of the two sides.
    virtual Eigen::Vector3d tangent(double s) const = 0;
    /// Parameter of the point of the curve that is nearest to a point.
    virtual double nearest(const Eigen::Vector3d& point) const = 0;

    /// The parameter on the curve: modulo its length, or not beyond its ends.
    double wrap(double s) const;
};

using SlideCurves = std::vector<std::shared_ptr<const SlideCurve>>;

/// A polyline in space.
class PolylineCurve final : public SlideCurve {
  public:
    /// @param points #P×3, at least 2, or 3 of a closed one, neighbours apart; a closed one does not repeat the first
    /// @throw Error bad_option naming points that are not finite, or neighbours that coincide
    PolylineCurve(const Positions& points, bool closed);

    double length() const override { return ends_.back(); }
    bool closed() const override { return closed_; }
    Eigen::Vector3d point(double s) const override;
    Eigen::Vector3d tangent(double s) const override;
    double nearest(const Eigen::Vector3d& point) const override;

  private:
    std::size_t segment_at(double s) const;
    Eigen::Vector3d direction(std::size_t segment) const;

    std::vector<Eigen::Vector3d> points_;  ///< the first again at the end of a closed one
    std::vector<double> ends_;             ///< arc length at the points
    bool closed_;
};

/// A circle in a plane z = const around the z-axis, counter-clockwise from above.
class LevelCircle final : public SlideCurve {
  public:
    LevelCircle(double radius, double height) : radius_(radius), height_(height) {}
    double length() const override;
    bool closed() const override { return true; }
    Eigen::Vector3d point(double s) const override;
    Eigen::Vector3d tangent(double s) const override;
    double nearest(const Eigen::Vector3d& point) const override;

  private:
    double radius_, height_;
};

/// A curve of a domain in the plane z = 0.
class PlanarSlideCurve final : public SlideCurve {
  public:
    explicit PlanarSlideCurve(TargetCurve curve) : curve_(std::move(curve)) {}
    double length() const override { return curve_.length(); }
    bool closed() const override { return true; }
    Eigen::Vector3d point(double s) const override;
    Eigen::Vector3d tangent(double s) const override;
    double nearest(const Eigen::Vector3d& point) const override;

  private:
    TargetCurve curve_;
};

}  // namespace beltrami
