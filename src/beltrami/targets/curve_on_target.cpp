#include <beltrami/targets/curve_on_target.h>

#include <algorithm>

#include <beltrami/base/error.h>

namespace beltrami {

namespace {

constexpr double kOpposite = 0.49;  // of the chord, by which its middle is off where no way is the shorter one
constexpr int kMostSweeps = 400;
constexpr double kSettled = 1e-13;  // of the chord, below which a point has come to rest

/// Every point to the middle of its neighbours, until that changes nothing.
void pull_straight(const Target& target, Target::Points& way, double chord) {
    for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
        double largest = 0;
        for (std::size_t i = 1; i + 1 < way.size(); ++i) {
            const Eigen::Vector3d before = way[i].position, middle = 0.5 * (way[i - 1].position + way[i + 1].position);
            way[i] = target.retract(middle, way[i]);
            largest = std::max(largest, (way[i].position - before).norm());
        }
        if (largest < kSettled * chord) return;
    }
}

}  // namespace

Target::Points straight_way(const Target& target, const Target::Point& from, const Target::Point& to, int pieces) {
    const double chord = (to.position - from.position).norm();
    Target::Points way{from, to};
    while (static_cast<int>(way.size()) <= pieces) {
        Target::Points finer{way[0]};
        for (std::size_t i = 1; i < way.size(); ++i) {
            const Eigen::Vector3d middle = 0.5 * (way[i - 1].position + way[i].position);
            finer.push_back(target.retract(middle, way[i - 1]));
            if (way.size() == 2 && (finer.back().position - middle).norm() > kOpposite * chord)
                throw Error(Cause::bad_boundary, "two points of a curve are opposite to each other on the target",
                            "give a point between them");
            finer.push_back(way[i]);
        }
        way = std::move(finer);
        pull_straight(target, way, chord);
    }
    return way;
}

Eigen::Vector3d CurveOnTarget::tangent(double s) const {
    const Eigen::Vector3d up = target_.nearest(chords_.point(s)).normal, along = chords_.tangent(s);
    return (along - along.dot(up) * up).normalized();
}

}  // namespace beltrami
