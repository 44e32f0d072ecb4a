#include <beltrami/targets/implicit_target.h>

#include <beltrami/base/error.h>

namespace beltrami {

namespace {

constexpr int kMostSteps = 50;
constexpr double kSettledOnLevel = 1e-14;  // step, relative to the distance from the origin

}  // namespace

Target::Point ImplicitTarget::onto(Eigen::Vector3d point) const {
    Jet jet = function_(point);
    for (int step = 0; step < kMostSteps; ++step) {
        const Eigen::Vector3d change = -jet.value / jet.gradient.squaredNorm() * jet.gradient;
        if (!change.allFinite()) break;
        point += change;
        jet = function_(point);
        if (change.norm() <= kSettledOnLevel * (1 + point.norm())) break;
    }
    Point result;
    result.position = point;
    result.normal = jet.gradient.normalized();
    return result;
}

Target::Point ImplicitTarget::nearest(const Eigen::Vector3d& point) const {
    Point best = onto(point);
    for (int step = 0; step < kMostSteps; ++step) {
        const Eigen::Vector3d left = point - best.position;
        const Eigen::Vector3d change = left - left.dot(best.normal) * best.normal;
        if (change.norm() <= kSettledOnLevel * (1 + point.norm())) break;
        const Point next = onto(best.position + change);
        if (!((next.position - point).norm() < left.norm())) break;
        best = next;
    }
    return best;
}

ImplicitTarget ellipsoid_target(const Eigen::Vector3d& half_axes) {
    if (!(half_axes.minCoeff() > 0 && half_axes.allFinite()))
        throw Error(Cause::bad_option, "the half-axes of an ellipsoid must be positive");
    const Eigen::Vector3d scale = half_axes.cwiseAbs2().cwiseInverse();
    return ImplicitTarget([scale](const Eigen::Vector3d& x) {
        return ImplicitTarget::Jet{x.cwiseAbs2().dot(scale) - 1, 2 * x.cwiseProduct(scale)};
    });
}

}  // namespace beltrami
