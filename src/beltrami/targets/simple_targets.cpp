#include <beltrami/targets/simple_targets.h>

#include <utility>

#include <beltrami/sphere/centring.h>
#include <beltrami/sphere/moebius_drift.h>

namespace beltrami {

Target::Point SphereTarget::nearest(const Eigen::Vector3d& point) const {
    Point result;
    const double length = point.norm();
    result.position = length > 0 ? Eigen::Vector3d(point / length) : Eigen::Vector3d::UnitZ();
    result.normal = result.position;
    return result;
}

Target::Points SphereTarget::centred(Points points, const Eigen::VectorXd& weights) const {
    return nearest_points(*this, beltrami::centred(positions_of(points), weights).points);
}

Positions SphereTarget::without_drift(const Positions& points, Positions motion, const Eigen::VectorXd& weights) const {
    return without_moebius_drift(points, motion, weights);
}

Target::Point PlaneTarget::nearest(const Eigen::Vector3d& point) const {
    Point result;
    result.position = {point.x(), point.y(), 0};
    return result;
}

DomainTarget::DomainTarget(const TargetDomain& domain) {
    for (int c = 0; c < domain.curve_count(); ++c)
        curves_.push_back(std::make_shared<PlanarSlideCurve>(domain.curve(c)));
}

}  // namespace beltrami
