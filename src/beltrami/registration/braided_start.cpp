#include <beltrami/registration/braided_start.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include <beltrami/base/error.h>
#include <beltrami/charts/circle_domain_chart.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/solve/beltrami_solver.h>
#include <beltrami/solve/dirichlet_solver.h>
#include <beltrami/teichmuller/mixed_conditions.h>
#include <beltrami/teichmuller/mixed_start.h>
#include <beltrami/unfold/fold_free.h>

namespace beltrami {

namespace {

constexpr double kTooNear = 1e-3;  // of the target's circle domain, whose radius is 1
constexpr double kPush = 0.1;      // of the disk that a point takes along, in one go
constexpr double kSmallestSide = 1e-3;
constexpr int kLegs = 8;  // of every step of the ways: folds are opened after each

/// The boundary where the circle domains put it, and the harmonic map inside.
Eigen::VectorXcd unpinned(const Surface& source, const Constraints& constraints) {
    const MixedBoundary boundary = mixed_boundary(source, mixed_conditions(source, constraints));
    const CircleDomainChart own = circle_domain_chart(source, constraints.correspondence.outer_loop);
    BoundaryCondition rim;
    for (const SlidingLoop& loop : places_on_curves(source, own, boundary)) {
        const std::vector<int>& vertices = source.topology.boundary_loops[loop.loop];
        for (std::size_t i = 0; i < vertices.size(); ++i) rim.pin(vertices[i], loop.curve.point(loop.parameters[i]));
    }
    Eigen::VectorXcd map = harmonic_map(source, rim);
    if (distortion(source.operators, map).flipped.empty()) return map;
    const FoldFreeMap opened =
        fold_free_map(source, dirichlet_freedoms(source), Eigen::VectorXcd::Zero(source.operators.sample_count()), map);
    if (!opened.fold_free)
        throw Error(Cause::not_solved, "the map from which landmarks set out folds, and cannot be unfolded",
                    "refine the mesh of the source, or give a start map");
    return opened.map;
}

/// Moves the place of a pin.
void place(MixedBoundary& boundary, int pin, Complex to) {
    std::vector<int>& vertices = boundary.prescribed.vertices;
    boundary.prescribed.images[std::find(vertices.begin(), vertices.end(), pin) - vertices.begin()] = to;
}

/// The least distance from 0 on a straight way.
double least_distance(Complex from, Complex to) {
    const Complex way = to - from;
    const double square = std::norm(way);
    return std::abs(from + (square > 0 ? std::clamp(-std::real(std::conj(way) * from) / square, 0.0, 1.0) : 0.0) * way);
}

/// @throw Error bad_boundary where pins that move evenly from their places to others run into each other or into a hole
void require_room(const std::vector<int>& pins, const std::vector<Complex>& from, const std::vector<Complex>& to,
                  const TargetDomain& domain, const std::string& where) {
    for (std::size_t i = 0; i < pins.size(); ++i) {
        for (const TargetCurve& hole : domain.holes)
            if (least_distance(from[i] - hole.centre(), to[i] - hole.centre()) < hole.radius() + kTooNear)
                throw Error(Cause::bad_boundary,
                            "on the way " + where + " landmark " + std::to_string(pins[i]) + " runs into a hole",
                            "lead it around by another step: on which side decides the homotopy class",
                            {Things::vertices, {pins[i]}});
        for (std::size_t j = 0; j < i; ++j)
            if (least_distance(from[i] - from[j], to[i] - to[j]) < kTooNear)
                throw Error(Cause::bad_boundary,
                            "on the way " + where + " landmarks " + std::to_string(pins[j]) + " and " +
                                std::to_string(pins[i]) + " run into each other",
                            "lead one around the other by another step: on which side decides the homotopy class",
                            {Things::vertices, {pins[j], pins[i]}});
    }
}

/// Arcs that points push along as these move: a diffeomorphism of the plane that keeps the boundary and whose class is
/// that of the points' ways, whatever mesh may fold under it.
class PushedArcs {
  public:
    PushedArcs(ArcWords::Polylines arcs, std::vector<Complex> points, const TargetDomain& domain)
        : arcs_(std::move(arcs)), points_(std::move(points)), domain_(domain) {}

    /// All points straight and evenly to others.
    void move(const std::vector<Complex>& to) {
        double left = 1;
        while (left > 0) {
            double part = left;
            for (std::size_t i = 0; i < points_.size(); ++i)
                part = std::min(part, kPush * reach(i) / std::max(std::abs(to[i] - points_[i]), 1e-300) * left);
            for (std::size_t i = 0; i < points_.size(); ++i) push(i, part / left * (to[i] - points_[i]));
            left = part < left ? left - part : 0;
            refine();
        }
        points_ = to;
    }
    const ArcWords::Polylines& arcs() const { return arcs_; }
    const std::vector<Complex>& points() const { return points_; }

  private:
    /// Of the disk about a point that it takes along: no other point and no boundary is in there.
    double reach(std::size_t i) const {
        double result = 1 - std::abs(points_[i]);
        for (std::size_t j = 0; j < points_.size(); ++j)
            if (j != i) result = std::min(result, std::abs(points_[j] - points_[i]));
        for (const TargetCurve& hole : domain_.holes)
            result = std::min(result, std::abs(points_[i] - hole.centre()) - hole.radius());
        return std::max(0.9 * result, 1e-6);
    }
    void push(std::size_t i, Complex by) {
        const Complex at = points_[i];
        const double square = std::pow(reach(i), 2);
        for (auto& arc : arcs_)
            for (Complex& z : arc)
                if (const double far = std::norm(z - at) / square; far < 1) z += by * std::pow(1 - far, 2);
        points_[i] = at + by;
    }
    /// No side is longer than a part of its distance from the points, so that polylines stay in their class.
    void refine() {
        for (auto& arc : arcs_) {
            std::vector<Complex> finer;
            finer.reserve(arc.size());
            for (std::size_t k = 0; k < arc.size(); ++k) {
                if (k > 0) {
                    const Complex from = arc[k - 1], side = arc[k] - from;
                    double room = 0.05;
                    for (const Complex point : points_)
                        room = std::min(room, std::max(0.2 * std::abs(from - point), kSmallestSide));
                    const int count = static_cast<int>(std::min(std::ceil(std::abs(side) / room), 1e4));
                    for (int m = 1; m < count; ++m) finer.push_back(from + static_cast<double>(m) / count * side);
                }
                finer.push_back(arc[k]);
            }
            arc = std::move(finer);
        }
    }

    ArcWords::Polylines arcs_;
    std::vector<Complex> points_;
    const TargetDomain& domain_;
};

/// In the order of the source's loops the middles of the circles to which its holes go.
std::vector<Complex> middles_of(const Surface& source, const TargetDomain& domain, int outer_loop,
                                const Eigen::VectorXcd& map) {
    std::vector<Complex> result;
    const auto& loops = source.topology.boundary_loops;
    result.reserve(loops.size());
    for (int l = 0; l < static_cast<int>(loops.size()); ++l) {
        if (l == outer_loop) continue;
        double least = std::numeric_limits<double>::infinity();
        Complex middle = 0;
        for (const TargetCurve& hole : domain.holes) {
            const double off = std::abs(std::abs(map[loops[l][0]] - hole.centre()) - hole.radius());
            if (off < least) least = off, middle = hole.centre();
        }
        result.push_back(middle);
    }
    return result;
}

}  // namespace

BraidedStart braided_start(const Surface& source, const Constraints& constraints,
                           std::span<const std::vector<std::optional<Complex>>> stops) {
    const std::vector<int>& pins = constraints.prescribed.vertices;
    const std::vector<Complex>& images = constraints.prescribed.images;
    const TargetDomain& domain = *constraints.domain();
    Eigen::VectorXcd map = unpinned(source, constraints);
    MixedBoundary boundary = mixed_boundary(source, mixed_conditions(source, constraints));
    std::vector<int> marked;
    marked.reserve(constraints.correspondence.marks.size());
    for (const Mark& mark : constraints.correspondence.marks) marked.push_back(mark.vertex);
    const int outer = constraints.correspondence.outer_loop;
    BraidedStart result{{}, ArcWords(source, pins, marked, outer), middles_of(source, domain, outer, map), {}};
    PushedArcs pushed(result.arcs.images(map, result.middles), result.arcs.places_of_pins(map), domain);
    std::vector<Complex> from;
    from.reserve(pins.size());
    for (const int v : pins) from.push_back(map[v]);
    for (std::size_t step = 0; step <= stops.size(); ++step) {
        const double part = static_cast<double>(step + 1) / static_cast<double>(stops.size() + 1);
        std::vector<Complex> begin, end;
        begin.reserve(pins.size());
        end.reserve(pins.size());
        for (std::size_t i = 0; i < pins.size(); ++i) {
            begin.push_back(map[pins[i]]);
            end.push_back(step < stops.size() && stops[step][i] ? *stops[step][i]
                                                                : (1 - part) * from[i] + part * images[i]);
        }
        const std::string where = step < stops.size() ? "to their places of step " + std::to_string(step + 1)
                                                      : std::string("from their last step to their places");
        require_room(pins, begin, end, domain, where);
        pushed.move(end);
        for (int leg = 1; leg <= kLegs; ++leg) {
            const double t = static_cast<double>(leg) / kLegs;
            for (std::size_t i = 0; i < pins.size(); ++i) place(boundary, pins[i], (1 - t) * begin[i] + t * end[i]);
            map = mixed_start(source, boundary, map).map;
            if (!distortion(source.operators, map).flipped.empty())
                throw Error(Cause::not_solved, "landmarks cannot be led " + where + " without folds",
                            "ways may not run into each other, into holes or along the boundary: give more steps that "
                            "keep apart, or refine the mesh of the source",
                            {Things::vertices, pins});
        }
    }
    result.words = result.arcs.of(pushed.arcs(), pushed.points(), result.middles);
    if (result.arcs.of(map, result.middles) != result.words)
        throw Error(Cause::not_solved,
                    "the mesh of the source is too coarse for the landmarks' ways: it cannot wind as they do",
                    "refine it, or give ways that keep farther apart", {Things::vertices, pins});
    result.map = std::move(map);
    return result;
}

}  // namespace beltrami
