#include <beltrami/homotopy/continuation.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include <beltrami/base/constants.h>
#include <beltrami/base/error.h>
#include <beltrami/homotopy/homotopy.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/plane/inside_polygon.h>
#include <beltrami/solve/beltrami_solver.h>
#include <beltrami/unfold/fold_free.h>

namespace beltrami {

namespace {

/// Centres nearer than this part of the outer loop's diameter count as meeting.
constexpr double kMeeting = 1e-3;
/// A loop is not shrunk below this part of its size.
constexpr double kSmallest = 0.02;
/// The coefficient of the last map is held below this, as a solver needs it; lower and nearly flat faces lose the
/// class.
constexpr double kLargestCoefficient = 0.99;
/// The gap that is kept, as part of the distance of two centres (or of a centre from the outer loop): narrower gaps
/// than this that the ends of the way have themselves are kept there.
constexpr double kGap = 0.1;

double distance(Complex p, Complex a, Complex b) {
    const double square = std::norm(b - a);
    const double t = square > 0 ? std::clamp(std::real(std::conj(b - a) * (p - a)) / square, 0.0, 1.0) : 0.0;
    return std::abs(p - a - t * (b - a));
}

/// Least distance of the points of one closed polygon from the edges of another.
double distance(const std::vector<Complex>& points, const std::vector<Complex>& polygon) {
    double least = std::numeric_limits<double>::infinity();
    for (const Complex p : points)
        for (std::size_t i = 0; i < polygon.size(); ++i)
            least = std::min(least, distance(p, polygon[i], polygon[(i + 1) % polygon.size()]));
    return least;
}

double radius(const std::vector<Complex>& shape) {
    double r = 0;
    for (const Complex p : shape) r = std::max(r, std::abs(p));
    return r;
}

std::vector<Complex> placed(const std::vector<Complex>& shape, Complex centre, double size) {
    std::vector<Complex> result;
    result.reserve(shape.size());
    for (const Complex p : shape) result.push_back(centre + size * p);
    return result;
}

/// Continuous branch of the logarithm of the directions from a centre along a loop.
std::vector<Complex> logarithms(const std::vector<Complex>& loop, Complex centre) {
    std::vector<Complex> result;
    double argument = std::arg(loop[0] - centre);
    for (std::size_t i = 0; i < loop.size(); ++i) {
        if (i > 0) argument += std::arg((loop[i] - centre) / (loop[i - 1] - centre));
        result.emplace_back(std::log(std::abs(loop[i] - centre)), argument);
    }
    return result;
}

/// The similarity that takes points to images best, with the lengths of the images' polygon as weights.
std::array<Complex, 2> best_similarity(const std::vector<Complex>& points, const std::vector<Complex>& images) {
    const std::size_t n = points.size();
    double total = 0;
    Complex p = 0, q = 0;
    std::vector<double> weights(n);
    for (std::size_t i = 0; i < n; ++i) {
        weights[i] = std::abs(images[(i + 1) % n] - images[i]) + std::abs(images[i] - images[(i + n - 1) % n]);
        total += weights[i];
        p += weights[i] * points[i];
        q += weights[i] * images[i];
    }
    p /= total;
    q /= total;
    Complex product = 0;
    double square = 0;
    for (std::size_t i = 0; i < n; ++i) {
        product += weights[i] * std::conj(points[i] - p) * (images[i] - q);
        square += weights[i] * std::norm(points[i] - p);
    }
    const Complex a = product / square;
    return {a, q - a * p};
}

/// The largest size up to 1 with which @p gap stays at least @p wanted; 0 if there is none.
template <class Gap>
double largest_size(const Gap& gap, double wanted) {
    if (gap(1.0) >= wanted) return 1;
    double low = 0, high = 1;
    for (int i = 0; i < 20; ++i) {
        const double middle = 0.5 * (low + high);
        (gap(middle) >= wanted ? low : high) = middle;
    }
    return low;
}

}  // namespace

Continuation::Continuation(const Surface& source, const Eigen::VectorXcd& positions, int outer_loop,
                           const BoundaryCondition& boundary, const std::vector<Waypoint>& waypoints)
    : vertices_(source.topology.boundary_loops), outer_loop_(outer_loop), boundary_(boundary) {
    validate(boundary, source);
    require_whole_boundary(boundary, source);
    const int count = static_cast<int>(vertices_.size());
    if (outer_loop < 0 || outer_loop >= count)
        throw Error(Cause::bad_option, "the outer loop is given as " + std::to_string(outer_loop) + ", but there are " +
                                           std::to_string(count) + " boundary loops");
    for (const Waypoint& waypoint : waypoints) {
        if (waypoint.loop < 0 || waypoint.loop >= count || waypoint.loop == outer_loop || waypoint.step < 1 ||
            !std::isfinite(std::abs(waypoint.position)))
            throw Error(Cause::bad_option,
                        "there is no waypoint of loop " + std::to_string(waypoint.loop) + " at step " +
                            std::to_string(waypoint.step),
                        "give steps from 1 on and the number of a hole's loop", {Things::loops, {waypoint.loop}});
        pieces_ = std::max(pieces_, waypoint.step + 1);
    }

    const Eigen::VectorXcd images = prescribed_values(boundary, source);
    const std::vector<Complex> outer = loop_images(vertices_[outer_loop], images);
    const auto [a, b] = best_similarity(loop_images(vertices_[outer_loop], positions), outer);
    start_ = (a * positions.array() + b).matrix();
    for (const Complex p : outer) diameter_ = std::max(diameter_, std::abs(p - outer[0]));

    for (int l = 0; l < count; ++l) {
        const std::vector<Complex> from = loop_images(vertices_[l], start_), to = loop_images(vertices_[l], images);
        const Complex first = point_inside(from), last = point_inside(to);
        if (winding_number(from, first) != winding_number(to, last))
            throw Error(Cause::bad_boundary,
                        "the prescribed images of boundary loop " + std::to_string(l) + " run " +
                            std::to_string(winding_number(to, last)) + " times around their inside, the loop itself " +
                            std::to_string(winding_number(from, first)) + " times",
                        "run through the images in the direction of the loop", {Things::loops, {l}});
        Loop loop;
        std::vector<std::optional<Complex>> at(pieces_ + 1);
        at.front() = first;
        at.back() = last;
        for (const Waypoint& waypoint : waypoints)
            if (waypoint.loop == l) at[waypoint.step] = waypoint.position;
        for (int i = 0, before = 0; i <= pieces_;
             ++i) {  // a step without a waypoint lies on the line of its neighbours
            if (at[i]) {
                before = i;
            } else {
                int after = i;
                while (!at[after]) ++after;
                at[i] = *at[before] + (*at[after] - *at[before]) * (double(i - before) / (after - before));
                before = i;
            }
            loop.centres.push_back(*at[i]);
        }
        loop.logarithms = logarithms(from, first);
        loop.change = logarithms(to, last);
        double turn = 0;
        for (std::size_t i = 0; i < from.size(); ++i) {
            loop.change[i] -= loop.logarithms[i];
            turn += loop.change[i].imag();
        }
        // The way of least turning.
        const double whole = kTurn * std::round(turn / static_cast<double>(from.size()) / kTurn);
        for (Complex& change : loop.change) change -= Complex(0, whole);
        loops_.push_back(std::move(loop));
    }
    require_free_ways();
}

Complex Continuation::centre(int loop, double t) const {
    const double at = std::clamp(t, 0.0, 1.0) * pieces_;
    const int i = std::min(static_cast<int>(at), pieces_ - 1);
    return loops_[loop].centres[i] + (at - i) * (loops_[loop].centres[i + 1] - loops_[loop].centres[i]);
}

std::vector<Complex> Continuation::shape(int loop, double t) const {
    std::vector<Complex> result;
    for (std::size_t i = 0; i < loops_[loop].logarithms.size(); ++i)
        result.push_back(std::exp(loops_[loop].logarithms[i] + t * loops_[loop].change[i]));
    return result;
}

void Continuation::require_free_ways() const {
    const int count = static_cast<int>(loops_.size());
    for (int piece = 0; piece < pieces_; ++piece)
        for (int h = 0; h < count; ++h)
            for (int g = h + 1; g < count; ++g) {
                if (h == outer_loop_ || g == outer_loop_) continue;
                // Both move evenly, so their difference moves along a straight line.
                const Complex from = loops_[h].centres[piece] - loops_[g].centres[piece],
                              to = loops_[h].centres[piece + 1] - loops_[g].centres[piece + 1];
                if (distance(0, from, to) < kMeeting * diameter_)
                    throw Error(Cause::bad_boundary,
                                "the ways of boundary loops " + std::to_string(h) + " and " + std::to_string(g) +
                                    " meet between steps " + std::to_string(piece) + " and " +
                                    std::to_string(piece + 1),
                                "lead one around the other by a waypoint: on which side decides the homotopy class",
                                {Things::loops, {h, g}});
            }
}

BoundaryCondition Continuation::at(double t) const {
    t = std::clamp(t, 0.0, 1.0);
    if (t == 1) return boundary_;
    const int count = static_cast<int>(loops_.size());
    std::vector<std::vector<Complex>> shapes;
    std::vector<double> radii, sizes(count, 1.0);
    for (int l = 0; l < count; ++l) {
        shapes.push_back(shape(l, t));
        radii.push_back(radius(shapes.back()));
    }
    const std::vector<Complex> outer = placed(shapes[outer_loop_], centre(outer_loop_, t), 1.0);
    const auto no_room = [&](int h, int g) {
        throw Error(Cause::bad_boundary,
                    "there is no room between boundary loops " + std::to_string(h) + " and " + std::to_string(g) +
                        " at step " + std::to_string(t * pieces_) + " of " + std::to_string(pieces_),
                    "lead the hole elsewhere by a waypoint", {Things::loops, {h, g}});
    };
    // At both ends of the way the gaps are what they are; between them at least kGap, faded in.
    const double wanted_gap = kGap * 4 * t * (1 - t);
    for (int h = 0; h < count; ++h) {
        if (h == outer_loop_) continue;
        const Complex at_h = centre(h, t);
        const double room = winding_number(outer, at_h) != 0 ? distance({at_h}, outer) : 0.0;
        if (!(room > kMeeting * diameter_)) no_room(h, outer_loop_);
        if (room < radii[h] * (1 + wanted_gap) / (1 - wanted_gap)) {
            const auto gap = [&](double size) {
                const std::vector<Complex> loop = placed(shapes[h], at_h, size);
                const bool inside =
                    std::all_of(loop.begin(), loop.end(), [&](Complex p) { return winding_number(outer, p) != 0; });
                return inside ? std::min(distance(loop, outer), distance(outer, loop)) : 0.0;
            };
            sizes[h] = std::min(sizes[h], largest_size(gap, wanted_gap * room));
        }
        for (int g = h + 1; g < count; ++g) {
            if (g == outer_loop_) continue;
            const Complex at_g = centre(g, t);
            const double apart = std::abs(at_h - at_g);
            if (apart * (1 - wanted_gap) >= radii[h] + radii[g]) continue;
            const auto gap = [&](double size) {
                const std::vector<Complex> one = placed(shapes[h], at_h, size), two = placed(shapes[g], at_g, size);
                if (winding_number(one, two[0]) != 0 || winding_number(two, one[0]) != 0) return 0.0;
                return std::min(distance(one, two), distance(two, one));
            };
            const double size = largest_size(gap, wanted_gap * apart);
            sizes[h] = std::min(sizes[h], size);
            sizes[g] = std::min(sizes[g], size);
            if (size < kSmallest) no_room(h, g);
        }
        if (sizes[h] < kSmallest) no_room(h, outer_loop_);
    }
    BoundaryCondition result;
    for (int l = 0; l < count; ++l) {
        const std::vector<Complex> loop = placed(shapes[l], centre(l, t), sizes[l]);
        for (std::size_t i = 0; i < loop.size(); ++i) result.pin(vertices_[l][i], loop[i]);
    }
    return result;
}

FollowedMap follow(const Surface& source, const Continuation& continuation, double largest_step, double smallest_step) {
    FollowedMap result;
    result.map = continuation.start();
    const std::vector<Freedom> fixed = freedoms(continuation.at(0), source);
    BeltramiSolver solver(source, fixed, static_cast<int>(continuation.pieces() / largest_step));
    double t = 0, step = largest_step;
    while (t < 1) {
        // Rounding must leave no last step of no length.
        const double next = t + step / continuation.pieces() > 1 - 1e-9 ? 1.0 : t + step / continuation.pieces();
        Eigen::VectorXcd nu = beltrami_coefficient(source.operators, result.map);
        for (Complex& value : nu) value *= std::min(1.0, kLargestCoefficient / std::max(std::abs(value), 1e-300));
        solver.factorize(nu);
        const BoundaryCondition boundary = continuation.at(next);
        Eigen::VectorXcd map = solver.solve(prescribed_values(boundary, source));
        if (!distortion(source.operators, map).flipped.empty()) {
            if (step > smallest_step) {
                step = std::max(0.5 * step, smallest_step);
                continue;
            }
            FoldFreeOptions options;
            options.max_iterations = 30;  // folds open in few steps or not at all; how well it ends does not matter
            FoldFreeMap opened = fold_free_map(source, fixed, Eigen::VectorXcd::Zero(nu.size()), map, options);
            if (!opened.fold_free)
                throw Error(Cause::not_solved,
                            "the map folds at step " + std::to_string(next * continuation.pieces()) + " of " +
                                std::to_string(continuation.pieces()) + " and the folds do not open",
                            source.topology.boundary_loops.size() > 1
                                ? "refine the mesh around the holes, or give waypoints that keep them apart"
                                : "refine the mesh where it is crowded: at thin limbs and notches of the outline");
            map = std::move(opened.map);
            ++result.repaired_steps;
        }
        result.map = std::move(map);
        ++result.steps;
        t = next;
        step = std::min(1.5 * step, largest_step);
    }
    return result;
}

std::vector<BoundaryCondition> continuation_steps(const Surface& source, const Eigen::VectorXcd& positions,
                                                  int outer_loop, const BoundaryCondition& boundary,
                                                  const std::vector<Waypoint>& waypoints, int substeps) {
    if (substeps < 1)
        throw Error(Cause::bad_option,
                    "a continuation with " + std::to_string(substeps) + " steps a piece is impossible",
                    "give at least 1");
    const Continuation continuation(source, positions, outer_loop, boundary, waypoints);
    const int steps = continuation.pieces() * substeps;
    std::vector<BoundaryCondition> result;
    for (int i = 1; i <= steps; ++i) result.push_back(continuation.at(i == steps ? 1.0 : double(i) / steps));
    return result;
}

}  // namespace beltrami
