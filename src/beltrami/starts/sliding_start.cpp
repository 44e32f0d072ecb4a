#include <beltrami/starts/sliding_start.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include <beltrami/base/constants.h>
#include <beltrami/base/error.h>
#include <beltrami/homotopy/continuation.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/starts/loop_partners.h>
#include <beltrami/starts/untwisting.h>

namespace beltrami {

namespace {

/// Steps on the way of the holes, as part of a straight piece: one that folds is halved.
constexpr double kLargestStep = 0.5;
/// Loops that would turn by less, in radians, are not twisted.
constexpr double kTwisted = 0.1;

/// Where the vertices of a loop begin on the circle of the model.
class LoopAngles {
  public:
    LoopAngles(const Surface& source, const LoopPartners& matched, const TargetModel& target,
               const std::vector<Mark>& marks, double ahead, int loop)
        : vertices_(source.topology.boundary_loops[loop]), sign_(matched.curves[loop] == 0 ? 1 : -1) {
        const RoundHole circle = matched.circles[loop];
        const std::size_t n = vertices_.size();
        for (std::size_t i = 0; i < n; ++i) {
            const Complex z = matched.vertices[vertices_[i]] - circle.centre,
                          next = matched.vertices[vertices_[(i + 1) % n]] - circle.centre;
            if (i == 0) turns_.push_back(sign_ * std::arg(z));
            turns_.push_back(turns_.back() + sign_ * std::arg(next / z));
        }
        for (double& turn : turns_) turn += sign_ * ahead;
        held_.assign(n, 0);
        place_marks(target, marks, matched.curves[loop]);
        turns_.pop_back();
    }
    /// Angles on the model's circle.
    std::vector<double> angles() const {
        std::vector<double> result;
        for (const double turn : turns_) result.push_back(sign_ * turn);
        return result;
    }
    const std::vector<char>& held() const { return held_; }
    /// Arc lengths of the marks, by position; beside held().
    const std::vector<double>& mark_parameters() const { return parameters_; }

  private:
    void place_marks(const TargetModel& target, const std::vector<Mark>& wanted, int curve) {
        const int n = static_cast<int>(vertices_.size());
        parameters_.assign(n, 0);
        struct Placed {
            int position;
            double turn;
        };
        std::vector<Placed> marks;
        for (const Mark& mark : wanted) {
            const auto at = std::find(vertices_.begin(), vertices_.end(), mark.vertex);
            if (at == vertices_.end()) continue;
            const int position = static_cast<int>(at - vertices_.begin());
            held_[position] = 1;
            const double parameter = on_curve(mark).parameter;
            parameters_[position] = parameter;
            marks.push_back({position, sign_ * target.angle(curve, parameter)});
        }
        if (marks.empty()) return;
        std::sort(marks.begin(), marks.end(), [](const Placed& a, const Placed& b) { return a.position < b.position; });
        // Forward from mark to mark; the first in the branch nearest to where it would be.
        marks[0].turn += kTurn * std::round((turns_[marks[0].position] - marks[0].turn) / kTurn);
        for (std::size_t m = 1; m < marks.size(); ++m) {
            const double ahead = std::fmod(marks[m].turn - marks[m - 1].turn, kTurn);
            marks[m].turn = marks[m - 1].turn + (ahead > 0 ? ahead : ahead + kTurn);
        }
        const std::vector<double> old = turns_;
        for (std::size_t m = 0; m < marks.size(); ++m) {
            const bool last = m + 1 == marks.size();
            const int from = marks[m].position, to = last ? marks[0].position + n : marks[m + 1].position;
            const double begin = marks[m].turn, end = last ? marks[0].turn + kTurn : marks[m + 1].turn;
            const auto lifted = [&](int i) { return i < n ? old[i] : old[i - n] + (old[n] - old[0]); };
            for (int i = from; i < to; ++i) {
                const double part = (lifted(i) - lifted(from)) / (lifted(to) - lifted(from));
                turns_[i % n] = begin + part * (end - begin) - (i < n ? 0 : kTurn);
            }
        }
        turns_[n] = turns_[0] + kTurn;
    }

    const std::vector<int>& vertices_;
    double sign_;
    std::vector<double> turns_;  ///< angles in the direction of the loop, ascending
    std::vector<char> held_;
    std::vector<double> parameters_;
};

int folded(const Surface& source, const Eigen::VectorXcd& map) {
    return static_cast<int>(distortion(source.operators, map).flipped.size());
}

/// Loops on their curves, and the harmonic map of the model that belongs to them.
struct Placement {
    std::vector<SlidingLoop> loops;
    BoundaryCondition model;
    Eigen::VectorXcd harmonic;
};

Placement place(const LoopPartners& matched, const Surface& source, const TargetModel& target,
                const std::vector<Mark>& marks, const std::vector<double>& start_turns) {
    const auto& loops = source.topology.boundary_loops;
    Placement result;
    for (std::size_t l = 0; l < loops.size(); ++l) {
        const int curve = matched.curves[l];
        const LoopAngles angles(source, matched, target, marks, start_turns.empty() ? 0 : start_turns[l],
                                static_cast<int>(l));
        const RoundHole circle = target.circle(curve);
        const std::vector<double> at = angles.angles();
        SlidingLoop sliding{static_cast<int>(l), target.domain().curve(curve), {}, angles.held()};
        for (std::size_t i = 0; i < loops[l].size(); ++i) {
            result.model.pin(loops[l][i], circle.centre + std::polar(circle.radius, at[i]));
            const double s = sliding.held[i] ? angles.mark_parameters()[i] : target.parameter(curve, at[i]);
            sliding.parameters.push_back(
                i == 0 ? s : sliding.parameters.back() + sliding.curve.ahead(sliding.parameters.back(), s));
        }
        result.loops.push_back(std::move(sliding));
    }
    result.harmonic = harmonic_map(source, result.model);
    return result;
}

/// A map of the model carried to the target.
SlidingStart started(const LoopPartners& matched, const Surface& source, const TargetModel& target,
                     const Placement& placed, const Eigen::VectorXcd& map) {
    SlidingStart result;
    result.curves = matched.curves;
    result.move = matched.move;
    result.loops = placed.loops;
    result.map = target.places(map);
    for (const SlidingLoop& sliding : result.loops) {
        const auto& vertices = source.topology.boundary_loops[sliding.loop];
        for (std::size_t i = 0; i < vertices.size(); ++i)
            result.map[vertices[i]] = sliding.curve.point(sliding.parameters[i]);
    }
    return result;
}

/// Start turns with more added, if any loop is to be turned noticeably.
std::optional<std::vector<double>> turned_further(std::vector<double> start_turns, const std::vector<double>& turns) {
    if (std::none_of(turns.begin(), turns.end(), [](double turn) { return std::abs(turn) > kTwisted; })) return {};
    start_turns.resize(turns.size(), 0);
    for (std::size_t l = 0; l < turns.size(); ++l) start_turns[l] += turns[l];
    return start_turns;
}

/// Waypoints in the model.
std::vector<Waypoint> in_model(const TargetModel& target, const std::vector<Waypoint>& waypoints) {
    std::vector<Waypoint> result = waypoints;
    for (Waypoint& waypoint : result) waypoint.position = target.model_place(waypoint.position);
    return result;
}

/// The start from the circle domain as it was moved.
SlidingStart start_from(const LoopPartners& matched, const Surface& source, const TargetModel& target,
                        const Correspondence& wanted, const std::vector<double>& start_turns) {
    Placement placed = place(matched, source, target, wanted.marks, start_turns);
    const int flips = folded(source, placed.harmonic);
    int factorizations = 1;
    // Waypoints and marks say how the map is to be twisted.
    if (flips > 0 && !wanted.waypoints && wanted.marks.empty()) {
        const Untwisting loops =
            untwisting(source, target, started(matched, source, target, placed, placed.harmonic), wanted.outer_loop);
        factorizations += loops.factorizations;
        if (const auto further = turned_further(start_turns, loops.turns)) {
            placed = place(matched, source, target, wanted.marks, *further);
            ++factorizations;
        }
    }
    Eigen::VectorXcd map = placed.harmonic;
    std::vector<Waypoint> path;
    const bool lead = wanted.waypoints || folded(source, map) > 0;
    if (lead) {
        if (wanted.waypoints) path = in_model(target, *wanted.waypoints);
        const Continuation way(source, matched.vertices, wanted.outer_loop, placed.model, path);
        const FollowedMap followed = follow(source, way, kLargestStep);
        map = followed.map;
        factorizations += followed.steps;
    }
    SlidingStart result = started(matched, source, target, placed, map);
    result.path = std::move(path);
    result.led = lead;
    result.flips = flips;
    result.factorizations = factorizations;
    return result;
}

}  // namespace

SlidingStart sliding_start(const Surface& source, const CircleDomainChart& chart, const TargetModel& target,
                           const Correspondence& wanted, const std::vector<double>& start_turns) {
    const LoopPartners matched = loop_partners(source, chart, target, wanted);
    validate(wanted.marks, source, target.domain(), matched.curves);
    try {
        return start_from(matched, source, target, wanted, start_turns);
    } catch (const Error& error) {
        // Where there is no way from the moved domain there may be one from the turned one; the result says which it
        // was.
        if (matched.move.centre == 0.0 || (error.cause() != Cause::not_solved && error.cause() != Cause::bad_boundary))
            throw;
    }
    return start_from(turned(matched, chart, target, wanted), source, target, wanted, start_turns);
}

SlidingStart even_start(const Surface& source, const CircleDomainChart& chart, const TargetModel& target,
                        const Correspondence& wanted, const std::vector<double>& start_turns) {
    const LoopPartners matched = loop_partners(source, chart, target, wanted);
    const Placement placed = place(matched, source, target, {}, start_turns);
    SlidingStart result = started(matched, source, target, placed, placed.harmonic);
    result.flips = folded(source, placed.harmonic);
    result.factorizations = 1;
    return result;
}

void hold_what_conformal_maps_move(std::vector<SlidingLoop>& loops, int outer, std::size_t marks) {
    const std::size_t holes = loops.size() - 1;
    const std::size_t free = holes == 0 ? 3 : holes == 1 ? 1 : 0;
    if (marks >= free) return;
    for (SlidingLoop& sliding : loops) {
        if (sliding.loop != outer) continue;
        // Places that share the curve evenly with the marks of this loop.
        const std::size_t n = sliding.held.size();
        for (std::size_t more = marks; more < free; ++more) {
            std::size_t best = 0;
            double farthest = -1;
            for (std::size_t i = 0; i < n; ++i) {
                double nearest = std::numeric_limits<double>::infinity();
                for (std::size_t j = 0; j < n; ++j)
                    if (sliding.held[j])
                        nearest =
                            std::min(nearest, std::abs(std::remainder(sliding.parameters[i] - sliding.parameters[j],
                                                                      sliding.curve.length())));
                if (nearest > farthest * (1 + 1e-9)) farthest = nearest, best = i;
            }
            sliding.held[best] = 1;
        }
    }
}

}  // namespace beltrami
