#pragma once

#include <span>
#include <vector>

#include <beltrami/charts/chart_places.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/targets/simple_targets.h>
#include <beltrami/uniformize/sphere_map.h>

namespace beltrami {

/// What the target's surface becomes while maps to it are found: the unit sphere, or a circle domain in the plane z =
/// 0.
class TargetImage {
  public:
    virtual ~TargetImage() = default;
    /// #V×3 of the target.
    const Positions& points() const { return points_; }
    virtual const Target& target() const = 0;
    /// The point that a mean of points nearby stands for.
    virtual Eigen::Vector3d surface_point(const Eigen::Vector3d& mean) const = 0;
    virtual std::vector<MeshPoint> locate(const Positions& points) const = 0;
    virtual Distortion distortion_of(const Surface& source, const Positions& points) const = 0;

    /// Points of places, from those of the vertices that they name.
    Eigen::Vector3d place(const Positions& points, const MeshPoint& place) const;
    Positions at(const Positions& points, std::span<const MeshPoint> places) const;
    /// Points of vertices with those that curves add.
    Positions with_places(const Positions& points, std::span<const MeshPoint> places) const;

  protected:
    Positions points_;
};

class SphereImage final : public TargetImage {
  public:
    /// @throw Error as sphere_map
    SphereImage(const Surface& target, const SphereMapOptions& options, Warnings& warnings);
    const Target& target() const override { return sphere_; }
    Eigen::Vector3d surface_point(const Eigen::Vector3d& mean) const override { return mean.normalized(); }
    std::vector<MeshPoint> locate(const Positions& points) const override;
    Distortion distortion_of(const Surface& source, const Positions& points) const override {
        return distortion(source.operators, points, points);
    }

  private:
    const FaceList& faces_;
    SphereTarget sphere_;
};

class DomainImage final : public TargetImage {
  public:
    /// @throw Error as circle_domain_chart
    DomainImage(const Surface& target, int outer_loop);
    static Positions in_space(const Eigen::VectorXcd& plane);
    static Eigen::VectorXcd in_plane(const Positions& points);
    const Target& target() const override { return domain_; }
    Eigen::Vector3d surface_point(const Eigen::Vector3d& mean) const override { return mean; }
    std::vector<MeshPoint> locate(const Positions& points) const override;
    Distortion distortion_of(const Surface& source, const Positions& points) const override {
        return distortion(source.operators, in_plane(points));
    }

  private:
    const Surface& surface_;
    CircleDomainChart chart_;
    DomainTarget domain_;
};

}  // namespace beltrami
