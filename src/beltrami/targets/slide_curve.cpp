#include <beltrami/targets/slide_curve.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include <Eigen/Geometry>

#include <beltrami/base/error.h>

namespace beltrami {

namespace {

Eigen::Vector3d in_space(Complex z) {
    return {z.real(), z.imag(), 0};
}

}  // namespace

double SlideCurve::wrap(double s) const {
    if (!closed()) return std::clamp(s, 0.0, length());
    s = std::fmod(s, length());
    return s < 0 ? s + length() : s;
}

PolylineCurve::PolylineCurve(const Positions& points, bool closed) : closed_(closed) {
    const auto count = static_cast<int>(points.rows());
    if (count < (closed ? 3 : 2))
        throw Error(Cause::bad_option, "a curve of " + std::to_string(count) + " points is none");
    for (int i = 0; i < count; ++i) {
        if (!points.row(i).allFinite())
            throw Error(Cause::bad_option, "point " + std::to_string(i) + " of a curve is not finite", {},
                        {Things::points, {i}});
        points_.emplace_back(points(i, 0), points(i, 1), points.cols() > 2 ? points(i, 2) : 0.0);
    }
    if (closed) points_.push_back(points_.front());
    ends_.push_back(0);
    for (std::size_t i = 1; i < points_.size(); ++i) {
        const double side = (points_[i] - points_[i - 1]).norm();
        if (!(side > 0))
            throw Error(
                Cause::bad_option,
                "points " + std::to_string(i - 1) + " and " + std::to_string(i % count) + " of a curve coincide",
                "leave one out", {Things::points, {static_cast<int>(i) - 1, static_cast<int>(i) % count}});
        ends_.push_back(ends_.back() + side);
    }
}

/// The segment that holds s, the later one at a corner.
std::size_t PolylineCurve::segment_at(double s) const {
    const auto after = std::upper_bound(ends_.begin() + 1, ends_.end() - 1, s);
    return static_cast<std::size_t>(after - ends_.begin()) - 1;
}

Eigen::Vector3d PolylineCurve::direction(std::size_t segment) const {
    return (points_[segment + 1] - points_[segment]).normalized();
}

Eigen::Vector3d PolylineCurve::point(double s) const {
    s = wrap(s);
    const std::size_t i = segment_at(s);
    const double t = (s - ends_[i]) / (ends_[i + 1] - ends_[i]);
    return (1 - t) * points_[i] + t * points_[i + 1];
}

Eigen::Vector3d PolylineCurve::tangent(double s) const {
    s = wrap(s);
    const std::size_t i = segment_at(s), last = points_.size() - 2;
    const bool corner = s - ends_[i] <= 1e-12 * length();
    if (!corner || (i == 0 && !closed_)) return direction(i);
    const Eigen::Vector3d sum = direction(i) + direction(i == 0 ? last : i - 1);
    return sum.norm() > 1e-9 ? sum.normalized() : direction(i);
}

double PolylineCurve::nearest(const Eigen::Vector3d& point) const {
    double best = std::numeric_limits<double>::infinity(), s = 0;
    for (std::size_t i = 0; i + 1 < points_.size(); ++i) {
        const Eigen::Vector3d side = points_[i + 1] - points_[i];
        const double t = std::clamp((point - points_[i]).dot(side) / side.squaredNorm(), 0.0, 1.0);
        const double distance = (points_[i] + t * side - point).squaredNorm();
        if (distance < best) {
            best = distance;
            s = ends_[i] + t * (ends_[i + 1] - ends_[i]);
        }
    }
    return wrap(s);
}

double LevelCircle::length() const {
    return 2 * std::numbers::pi * radius_;
}

Eigen::Vector3d LevelCircle::point(double s) const {
    return {radius_ * std::cos(s / radius_), radius_ * std::sin(s / radius_), height_};
}

Eigen::Vector3d LevelCircle::tangent(double s) const {
    return {-std::sin(s / radius_), std::cos(s / radius_), 0};
}

double LevelCircle::nearest(const Eigen::Vector3d& point) const {
    return wrap(radius_ * std::atan2(point.y(), point.x()));
}

Eigen::Vector3d PlanarSlideCurve::point(double s) const {
    return in_space(curve_.point(s));
}

Eigen::Vector3d PlanarSlideCurve::tangent(double s) const {
    return in_space(curve_.tangent(s));
}

double PlanarSlideCurve::nearest(const Eigen::Vector3d& point) const {
    return curve_.nearest({point.x(), point.y()});
}

}  // namespace beltrami
