#include <beltrami/targets/parametric_target.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>

#include <beltrami/base/constants.h>
#include <beltrami/base/error.h>

namespace beltrami {

namespace {

constexpr int kGrid = 48;  // places along each parameter
constexpr int kMostParameterSteps = 60;
constexpr double kSettledParameters = 1e-14;  // step in the parameters, relative to their ranges

double into(const ParametricTarget::Range& range, double t) {
    if (!range.periodic) return std::clamp(t, range.first, range.last);
    const double period = range.last - range.first;
    return t - period * std::floor((t - range.first) / period);
}

void require_positive(bool condition, const char* sentence) {
    if (!condition) throw Error(Cause::bad_option, sentence);
}

/// A surface of revolution whose profile depends on the angle: (h cos 2πu, h sin 2πu, z).
struct Profile {
    double h, h_u, h_v, z, z_u, z_v;
};
ParametricTarget::Jet turned(double u, const Profile& p) {
    const double c = std::cos(kTurn * u), s = std::sin(kTurn * u);
    return {{p.h * c, p.h * s, p.z},
            {p.h_u * c - kTurn * p.h * s, p.h_u * s + kTurn * p.h * c, p.z_u},
            {p.h_v * c, p.h_v * s, p.z_v}};
}

}  // namespace

ParametricTarget::ParametricTarget(Function function, Range u, Range v, SlideCurves boundary,
                                   std::optional<Eigen::Vector2d> unit)
    : function_(std::move(function)), u_(u), v_(v), boundary_(std::move(boundary)), unit_(std::move(unit)) {
    for (int i = 0; i < kGrid; ++i)
        for (int j = 0; j < kGrid; ++j)
            grid_.push_back(
                at(std::lerp(u_.first, u_.last, (i + 0.5) / kGrid), std::lerp(v_.first, v_.last, (j + 0.5) / kGrid)));
}

Target::Point ParametricTarget::at(double u, double v) const {
    u = into(u_, u);
    v = into(v_, v);
    const Jet jet = function_(u, v);
    Point point;
    point.position = jet.position;
    point.normal = jet.du.cross(jet.dv).normalized();
    point.parameters = {u, v};
    return point;
}

Target::Point ParametricTarget::nearest(const Eigen::Vector3d& point) const {
    const auto nearer = [&](const Point& a, const Point& b) {
        return (a.position - point).squaredNorm() < (b.position - point).squaredNorm();
    };
    return retract(point, *std::min_element(grid_.begin(), grid_.end(), nearer));
}

/// Gauss-Newton steps for the squared distance, halved where they do not lower it.
Target::Point ParametricTarget::retract(const Eigen::Vector3d& moved, const Point& from) const {
    Point best = from;
    double distance = (best.position - moved).squaredNorm();
    for (int step = 0; step < kMostParameterSteps; ++step) {
        const Jet jet = function_(best.parameters.x(), best.parameters.y());
        const Eigen::Vector3d left = moved - best.position;
        Eigen::Matrix2d normal;
        normal << jet.du.dot(jet.du), jet.du.dot(jet.dv), jet.du.dot(jet.dv), jet.dv.dot(jet.dv);
        const Eigen::Vector2d change = normal.inverse() * Eigen::Vector2d(jet.du.dot(left), jet.dv.dot(left));
        const double size =
            std::max(std::abs(change.x()) / (u_.last - u_.first), std::abs(change.y()) / (v_.last - v_.first));
        bool lower = false;
        for (double length = 1; length * size > kSettledParameters && !lower; length *= 0.5) {
            const Point trial =
                at(best.parameters.x() + length * change.x(), best.parameters.y() + length * change.y());
            const double there = (trial.position - moved).squaredNorm();
            lower = there < distance;
            if (lower) {
                best = trial;
                distance = there;
            }
        }
        if (!lower) break;
    }
    return best;
}

std::optional<ParametricTarget::Unrolled> ParametricTarget::unrolled() const {
    if (!unit_) return {};
    const auto turn = [](const Range& range) { return range.periodic ? range.last - range.first : 0.0; };
    return Unrolled{*unit_, unit_->cwiseProduct(Eigen::Vector2d(turn(u_), turn(v_)))};
}

ParametricTarget torus_target(double major, double minor) {
    require_positive(minor > 0 && major > minor, "a torus needs radii R > r > 0");
    return ParametricTarget(
        [=](double u, double v) {
            const double c = std::cos(kTurn * v), s = std::sin(kTurn * v);
            return turned(u, {major + minor * c, 0, -kTurn * minor * s, minor * s, 0, kTurn * minor * c});
        },
        {0, 1, true}, {0, 1, true});
}

ParametricTarget first_modified_torus() {
    return ParametricTarget(
        [](double u, double v) {
            const double c = std::cos(kTurn * v), s = std::sin(kTurn * v);
            const double wave = 0.3 * std::cos(3 * kTurn * (u + v)),
                         slope = -0.9 * kTurn * std::sin(3 * kTurn * (u + v));
            return turned(u, {4 + 1.7 * c + wave, slope, slope - 1.7 * kTurn * s, 1.7 * s, 0, 1.7 * kTurn * c});
        },
        {0, 1, true}, {0, 1, true});
}

ParametricTarget second_modified_torus() {
    return ParametricTarget(
        [](double u, double v) {
            const double c = std::cos(kTurn * v), s = std::sin(kTurn * v);
            const double q = 1.5 + 0.4 * std::cos(5 * kTurn * u), q_u = -2 * kTurn * std::sin(5 * kTurn * u);
            return turned(u, {4 + q * c, q_u * c, -kTurn * q * s, q * s, q_u * s, kTurn * q * c});
        },
        {0, 1, true}, {0, 1, true});
}

ParametricTarget cylinder_target(double radius, double height) {
    require_positive(radius > 0 && height > 0, "a cylinder needs a positive radius and height");
    return ParametricTarget(
        [=](double u, double v) {
            return turned(u, {radius, 0, 0, v, 0, 1});
        },
        {0, 1, true}, {0, height, false},
        {std::make_shared<LevelCircle>(radius, 0), std::make_shared<LevelCircle>(radius, height)},
        Eigen::Vector2d(kTurn * radius, 1));
}

}  // namespace beltrami
