#include <beltrami/teichmuller/mixed_start.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

#include <beltrami/base/error.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/plane/increasing.h>
#include <beltrami/solve/dirichlet_solver.h>
#include <beltrami/solve/sliding_map_step.h>
#include <beltrami/starts/given_start.h>
#include <beltrami/unfold/fold_free.h>
#include <beltrami/unfold/local_unfold.h>

namespace beltrami {

namespace {

/// Ends of sliding arcs lie on their curve to this part of its diameter.
constexpr double kOnMixedCurve = 1e-6;
/// Steps in which loops turn, and the movement, as part of the curve, at which they have.
constexpr int kTurningSteps = 20;
constexpr double kTurnedBelow = 0.02, kTurningTolerance = 1e-3;
/// Pushes of inner vertices, how far each goes and the disk it moves, as parts of the distance to what is not to move
/// with it.
constexpr int kPushes = 500;
constexpr double kPush = 0.1, kPushReach = 0.9;
/// Newton steps in which folds of the start are opened.
constexpr int kOpeningSteps = 60;
/// Least length of a step along a rim: parts of the mean of its neighbours, and of what arc length gives.
constexpr double kOfMixedNeighbours = 1e-3, kOfLength = 1e-5;

/// The similarity a z + b that fits what is prescribed best, in least squares.
struct Similarity {
    Complex a = 1, b = 0;
};

Similarity fitted(const Eigen::VectorXcd& z, const BoundaryCondition& prescribed) {
    const auto n = static_cast<double>(prescribed.vertices.size());
    if (prescribed.vertices.empty()) return {};
    Complex from = 0, to = 0, product = 0;
    double square = 0;
    for (std::size_t i = 0; i < prescribed.vertices.size(); ++i) {
        from += z[prescribed.vertices[i]] / n;
        to += prescribed.images[i] / n;
    }
    for (std::size_t i = 0; i < prescribed.vertices.size(); ++i) {
        const Complex at = z[prescribed.vertices[i]] - from;
        product += std::conj(at) * (prescribed.images[i] - to);
        square += std::norm(at);
    }
    if (!(square > 0) || product == 0.0) return {1, to - from};
    return {product / square, to - product / square * from};
}

/// Whether a vertex is held beside one that is not.
bool ends_arc(const std::vector<char>& held, std::size_t i) {
    const std::size_t n = held.size();
    return held[i] && (!held[(i + 1) % n] || !held[(i + n - 1) % n]);
}

/// Steps along a rim that a chart has crowded to nothing get a length: a part of that of their neighbours, and of what
/// the lengths of the edges would give them.
void raise_crowded(const std::vector<double>& lengths, std::vector<double>& steps) {
    raise_to_neighbours(steps, kOfMixedNeighbours);
    const double whole = std::accumulate(steps.begin(), steps.end(), 0.0),
                 length = std::accumulate(lengths.begin(), lengths.end(), 0.0);
    for (std::size_t i = 0; i < steps.size(); ++i)
        steps[i] = std::max(steps[i], kOfLength * whole * lengths[i] / length);
}

/// Where the vertices of one loop stand along its curve.
class LoopPlaces {
  public:
    LoopPlaces(const Surface& source, const CircleDomainChart& domain, const MixedBoundary& boundary, int loop,
               const Similarity& similarity)
        : vertices_(source.topology.boundary_loops[loop]),
          held_(boundary.held[loop]),
          curve_(*boundary.curves[loop]),
          images_(vertices_.size()) {
        for (std::size_t i = 0; i < boundary.prescribed.vertices.size(); ++i) {
            const auto at = std::find(vertices_.begin(), vertices_.end(), boundary.prescribed.vertices[i]);
            if (at != vertices_.end()) images_[at - vertices_.begin()] = boundary.prescribed.images[i];
        }
        const int n = static_cast<int>(vertices_.size());
        const Complex centre = domain.circle(loop).centre;
        // Angles in the direction of the loop, ascending, once around and back to the first vertex.
        const double sign = loop == domain.outer_loop() ? 1 : -1;
        std::vector<double> steps;
        for (int i = 0; i < n; ++i) {
            const Complex z = domain.chart.vertices[vertices_[i]] - centre,
                          next = domain.chart.vertices[vertices_[(i + 1) % n]] - centre;
            steps.push_back(std::max(sign * std::arg(next / z), 0.0));
        }
        raise_crowded(source.boundary_edge_lengths[loop], steps);
        turns_.push_back(0);
        for (const double step : steps) turns_.push_back(turns_.back() + step);
        parameters_.assign(n, 0);
        const auto first = std::find(held_.begin(), held_.end(), 1);
        if (first == held_.end()) {
            place_freely(similarity.a * (domain.chart.vertices[vertices_[0]] - centre));
        } else {
            place_between(static_cast<int>(first - held_.begin()));
        }
    }
    SlidingLoop sliding(int loop) const { return {loop, curve_, parameters_, held_}; }

  private:
    double turn(int i) const {
        const int n = static_cast<int>(vertices_.size());
        return turns_[i % n] + (i >= n ? turns_[n] : 0);
    }
    /// The first vertex goes to a direction seen from the middle of the curve.
    void place_freely(Complex direction) {
        Complex middle = 0;
        constexpr int kPoints = 64;
        for (int i = 0; i < kPoints; ++i) middle += curve_.point(curve_.length() * i / kPoints) / double(kPoints);
        const double s = curve_.nearest(middle + curve_.diameter() * direction / std::abs(direction));
        for (std::size_t i = 0; i < vertices_.size(); ++i)
            parameters_[i] = s + curve_.length() * turns_[i] / turns_.back();
    }
    double parameter_of(int i) const {
        const double s = curve_.nearest(images_[i]);
        if (std::abs(curve_.point(s) - images_[i]) > kOnMixedCurve * curve_.diameter())
            throw Error(Cause::bad_boundary,
                        "the image of vertex " + std::to_string(vertices_[i]) +
                            ", beside vertices that slide, does not lie on the curve along which they do",
                        "ends of sliding arcs and marks go to the curve", {Things::vertices, {vertices_[i]}});
        return s;
    }
    void place_between(int first) {
        const int n = static_cast<int>(vertices_.size());
        // From one end of an arc to the next.
        while (!ends_arc(held_, first)) ++first;
        std::vector<double> unwound(n + 1, 0.0);  // by positions from first on
        unwound[0] = parameter_of(first);
        for (int i = 0; i < n;) {
            int j = i + 1;
            while (!ends_arc(held_, (first + j) % n)) ++j;
            const int from = (first + i) % n, to = (first + j) % n;
            const double begin = unwound[i];
            const double length = j == n && i == 0 ? curve_.length() : curve_.ahead(begin, parameter_of(to));
            const double whole = turn(from + j - i) - turn(from);
            // Prescribed vertices between stand where they are told to; evenly will do.
            const bool slides = !held_[(from + 1) % n];
            for (int m = i + 1; m <= j; ++m)
                unwound[m] = begin + length * (slides || j == i + 1 ? (turn(from + m - i) - turn(from)) / whole
                                                                    : static_cast<double>(m - i) / (j - i));
            i = j;
        }
        const double around = unwound[n] - unwound[0];
        if (std::abs(around - curve_.length()) > 1e-6 * curve_.length())
            throw Error(Cause::bad_boundary,
                        "the prescribed vertices of a loop follow each other along its curve in another order than "
                        "along the loop",
                        "a one-to-one map keeps the order, the surface on the left on both sides",
                        {Things::vertices, {vertices_[first]}});
        for (int m = 0; m < n; ++m) parameters_[(first + m) % n] = unwound[m] - (first + m >= n ? around : 0);
    }

    const std::vector<int>& vertices_;
    std::vector<char> held_;
    const TargetCurve& curve_;
    std::vector<Complex> images_;
    std::vector<double> turns_, parameters_;
};

/// Everything prescribed, sliding vertices where they stand.
BoundaryCondition all_prescribed(const Surface& source, const MixedBoundary& boundary,
                                 const std::vector<SlidingLoop>& loops) {
    BoundaryCondition result = boundary.prescribed;
    for (const SlidingLoop& sliding : loops) {
        const auto& vertices = source.topology.boundary_loops[sliding.loop];
        for (std::size_t i = 0; i < vertices.size(); ++i)
            if (!sliding.held[i]) result.pin(vertices[i], sliding.curve.point(sliding.parameters[i]));
    }
    return result;
}

/// The part of a condition that is about the boundary.
BoundaryCondition rim_of(const Surface& source, const BoundaryCondition& boundary) {
    BoundaryCondition result;
    for (std::size_t i = 0; i < boundary.vertices.size(); ++i)
        if (source.topology.on_boundary[boundary.vertices[i]]) result.pin(boundary.vertices[i], boundary.images[i]);
    return result;
}

int folded(const Surface& source, const Eigen::VectorXcd& map) {
    return static_cast<int>(distortion(source.operators, map).flipped.size());
}

/// Carries a map's inner vertices so that those in question come to their places and none of their surroundings folds:
/// each is pushed straight to its place, a disk about it that holds no other one and no boundary along with it, less
/// towards the rim of the disk. A harmonic map with such vertices would fold around them.
/// @param vertices, places of those
/// @return whether all have come
bool push(const Surface& source, const std::vector<int>& vertices, const std::vector<Complex>& places,
          Eigen::VectorXcd& map) {
    std::vector<int> rim;
    for (const auto& loop : source.topology.boundary_loops) rim.insert(rim.end(), loop.begin(), loop.end());
    const std::size_t n = vertices.size();
    for (int step = 0; step < kPushes; ++step) {
        std::vector<Complex> at(n), by(n);
        std::vector<double> reach(n, std::numeric_limits<double>::infinity());
        double largest = 0;  // of what is left, as part of the disk
        for (std::size_t i = 0; i < n; ++i) {
            at[i] = map[vertices[i]];
            by[i] = places[i] - at[i];
        }
        for (std::size_t i = 0; i < n; ++i) {
            for (std::size_t j = 0; j < n; ++j)
                if (j != i) reach[i] = std::min(reach[i], std::abs(at[j] - at[i]));
            for (const int v : rim) reach[i] = std::min(reach[i], std::abs(map[v] - at[i]));
            reach[i] *= kPushReach;
            if (!(reach[i] > 0)) return false;
            largest = std::max(largest, std::abs(by[i]) / reach[i]);
        }
        if (largest == 0) return true;
        const double part = std::min(1.0, kPush / largest);
        // One after another: each of these pushes is one-to-one.
        for (std::size_t i = 0; i < n; ++i) {
            const double square = reach[i] * reach[i];
            for (Eigen::Index v = 0; v < map.size(); ++v) {
                const double far = std::norm(map[v] - at[i]) / square;
                if (far < 1 && !source.topology.on_boundary[v]) map[v] += part * by[i] * (1 - far) * (1 - far);
            }
            if (part == 1) map[vertices[i]] = places[i];
        }
    }
    return false;
}

/// Opens the folds of a start, if it can, with what has no freedom where it is.
void open(const Surface& source, const std::vector<Freedom>& freedom, SlidingStart& start) {
    FoldFreeOptions options;
    options.max_iterations = kOpeningSteps;
    const FoldFreeMap opened =
        fold_free_map(source, freedom, Eigen::VectorXcd::Zero(source.operators.sample_count()), start.map, options);
    start.factorizations += opened.factorizations;
    if (opened.fold_free) {
        start.map = opened.map;
        start.unfolded = true;
        return;
    }
    // In crowded parts, smaller than what an energy of the whole sees.
    LocalUnfolding by_parts = unfold_locally(source, freedom, start.map);
    start.factorizations += by_parts.factorizations;
    if (!by_parts.fold_free) return;
    start.map = std::move(by_parts.map);
    start.unfolded = true;
}

/// Brings what is constrained inside to its places; folds that come of it are opened.
void place_inside(const Surface& source, const BoundaryCondition& prescribed, SlidingStart& start) {
    std::vector<int> inside;
    std::vector<Complex> places;
    for (std::size_t i = 0; i < prescribed.vertices.size(); ++i)
        if (!source.topology.on_boundary[prescribed.vertices[i]]) {
            inside.push_back(prescribed.vertices[i]);
            places.push_back(prescribed.images[i]);
        }
    for (const auto& line : prescribed.lines) {
        const Complex along = line.direction / std::abs(line.direction);
        inside.push_back(line.vertex);
        places.push_back(line.point + along * std::real(std::conj(along) * (start.map[line.vertex] - line.point)));
    }
    if (inside.empty()) return;
    push(source, inside, places, start.map);
    for (std::size_t i = 0; i < inside.size(); ++i) start.map[inside[i]] = places[i];
    if (folded(source, start.map) == 0) return;
    std::vector<Freedom> freedom = dirichlet_freedoms(source);
    for (const int v : inside) freedom[v] = Freedom::fixed;
    open(source, freedom, start);
}

/// Turns the loops without held vertices to where the harmonic map has least energy; whether any was.
bool turn_loops(const Surface& source, const MixedBoundary& boundary, SlidingStart& start) {
    const auto is_free = [](const SlidingLoop& loop) {
        return std::find(loop.held.begin(), loop.held.end(), 1) == loop.held.end();
    };
    // Without anything prescribed on the boundary there is nothing to turn against.
    if (std::none_of(start.loops.begin(), start.loops.end(), is_free) ||
        std::none_of(boundary.held.begin(), boundary.held.end(),
                     [](const auto& held) { return std::find(held.begin(), held.end(), 1) != held.end(); }))
        return false;
    SlidingBoundary sliding(source, start.loops, rim_of(source, boundary.prescribed));
    SlidingMapStep step(source, sliding, start.map, kTurningSteps);
    const Eigen::VectorXcd nu = Eigen::VectorXcd::Zero(source.operators.sample_count());
    bool settled = false;
    for (int i = 0; i < kTurningSteps && !settled; ++i) {
        step.solve(nu, kTurningTolerance);
        settled = step.movement() < kTurnedBelow;
    }
    start.factorizations += step.factorization_count();
    if (!settled) return false;
    for (std::size_t l = 0; l < start.loops.size(); ++l) {
        if (!is_free(start.loops[l])) continue;
        const auto n = static_cast<double>(start.loops[l].parameters.size());
        double ahead = 0;
        for (std::size_t i = 0; i < start.loops[l].parameters.size(); ++i)
            ahead += (sliding.loops()[l].parameters[i] - start.loops[l].parameters[i]) / n;
        for (double& s : start.loops[l].parameters) s += ahead;
    }
    return true;
}

}  // namespace

bool MixedBoundary::slides(int loop) const {
    return std::find(held[loop].begin(), held[loop].end(), 0) != held[loop].end();
}

MixedBoundary mixed_boundary(const Surface& source, const MixedConditions& conditions) {
    const auto& loops = source.topology.boundary_loops;
    validate(conditions.prescribed, source);
    if (conditions.curves.size() != loops.size())
        throw Error(Cause::bad_option,
                    "curves are given for " + std::to_string(conditions.curves.size()) +
                        " boundary loops, the source has " + std::to_string(loops.size()),
                    "give one entry for every loop");
    std::vector<char> slides(source.mesh.vertex_count(), 0);
    for (const SlidingArc& arc : conditions.arcs) {
        bool found = false;
        for (const auto& loop : loops) {
            const auto first = std::find(loop.begin(), loop.end(), arc.first);
            if (first == loop.end() || std::find(loop.begin(), loop.end(), arc.last) == loop.end()) continue;
            found = true;
            auto at = static_cast<std::size_t>(first - loop.begin());
            for (at = (at + 1) % loop.size(); loop[at] != arc.last; at = (at + 1) % loop.size()) slides[loop[at]] = 1;
        }
        if (!found)
            throw Error(Cause::bad_boundary,
                        "the arc from vertex " + std::to_string(arc.first) + " to vertex " + std::to_string(arc.last) +
                            " does not lie on a boundary loop",
                        "name two vertices of one loop", {Things::vertices, {arc.first, arc.last}});
    }
    MixedBoundary result;
    std::vector<char> is_prescribed(source.mesh.vertex_count(), 0);
    for (std::size_t i = 0; i < conditions.prescribed.vertices.size(); ++i) {
        const int v = conditions.prescribed.vertices[i];
        if (slides[v]) continue;
        is_prescribed[v] = 1;
        result.prescribed.pin(v, conditions.prescribed.images[i]);
    }
    result.prescribed.lines = conditions.prescribed.lines;
    for (std::size_t l = 0; l < loops.size(); ++l) {
        std::vector<char>& held = result.held.emplace_back();
        for (const int v : loops[l]) held.push_back(is_prescribed[v]);
        std::optional<TargetCurve>& curve = result.curves.emplace_back(conditions.curves[l]);
        const auto free = std::find(held.begin(), held.end(), 0);
        if (free == held.end()) {
            curve.reset();
            continue;
        }
        const int vertex = loops[l][static_cast<std::size_t>(free - held.begin())];
        if (!curve)
            throw Error(Cause::bad_boundary,
                        "vertex " + std::to_string(vertex) + " of boundary loop " + std::to_string(l) +
                            " is not prescribed, and its loop has no curve along which it could slide",
                        "prescribe the whole loop, or give it a curve", {Things::vertices, {vertex}});
        if (curve->counter_clockwise() != (static_cast<int>(l) == conditions.outer_loop)) *curve = curve->reversed();
    }
    return result;
}

bool has_arc(const std::vector<char>& held) {
    for (std::size_t i = 0; i < held.size(); ++i)
        if (held[i] && held[(i + 1) % held.size()]) return true;
    return false;
}

std::vector<SlidingLoop> places_on_curves(const Surface& source, const CircleDomainChart& domain,
                                          const MixedBoundary& boundary) {
    std::vector<SlidingLoop> result;
    const Similarity similarity = fitted(domain.chart.vertices, boundary.prescribed);
    for (int l = 0; l < static_cast<int>(boundary.held.size()); ++l)
        if (boundary.slides(l)) result.push_back(LoopPlaces(source, domain, boundary, l, similarity).sliding(l));
    return result;
}

SlidingStart mixed_start(const Surface& source, const CircleDomainChart& domain, const MixedBoundary& boundary) {
    SlidingStart result;
    result.loops = places_on_curves(source, domain, boundary);
    const auto harmonic = [&] {
        ++result.factorizations;
        result.map = harmonic_map(source, rim_of(source, all_prescribed(source, boundary, result.loops)));
        return folded(source, result.map);
    };
    result.flips = harmonic();
    if (result.flips > 0) {
        const bool still = !turn_loops(source, boundary, result) || harmonic() > 0;
        if (still) open(source, dirichlet_freedoms(source), result);
    }
    place_inside(source, boundary.prescribed, result);
    return result;
}

SlidingStart mixed_start(const Surface& source, const MixedBoundary& boundary, const Eigen::VectorXcd& map) {
    SlidingStart result;
    require_values(source, map);
    result.map = map;
    const BoundaryCondition& prescribed = boundary.prescribed;
    const BoundaryCondition rim = rim_of(source, prescribed);
    for (std::size_t i = 0; i < rim.vertices.size(); ++i) result.map[rim.vertices[i]] = rim.images[i];
    for (int l = 0; l < static_cast<int>(boundary.held.size()); ++l) {
        if (!boundary.slides(l)) continue;
        const auto& loop = source.topology.boundary_loops[l];
        const TargetCurve& curve = *boundary.curves[l];
        // Inside prescribed arcs vertices need not lie on the curve.
        std::vector<std::pair<std::size_t, double>> places;
        for (std::size_t i = 0; i < loop.size(); ++i)
            if (ends_arc(boundary.held[l], i)) places.emplace_back(i, curve.nearest(result.map[loop[i]]));
        SlidingLoop sliding = given_loop(source, l, curve, result.map, places);
        sliding.held = boundary.held[l];
        for (std::size_t i = 0; i < loop.size(); ++i)
            if (!sliding.held[i]) result.map[loop[i]] = curve.point(sliding.parameters[i]);
        result.loops.push_back(std::move(sliding));
    }
    result.flips = folded(source, result.map);
    place_inside(source, prescribed, result);
    return result;
}

}  // namespace beltrami
