#include <beltrami/teichmuller/boundary_slack.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <beltrami/base/constants.h>
#include <beltrami/base/error.h>
#include <beltrami/base/parallel.h>
#include <beltrami/linear/element_system.h>
#include <beltrami/plane/circle_fit.h>
#include <beltrami/plane/increasing.h>
#include <beltrami/plane/target_curve.h>

namespace beltrami {

namespace {

/// Edges farther apart are not coupled in the steps; and the energy of loops with more edges is that of these pairs.
constexpr int kBand = 16, kMostFullEdges = 1000;
/// Gauss-Newton steps, the part of an edge below which they end, and that from which on they are exact.
constexpr int kSteps = 8;
constexpr double kSettled = 1e-3, kNearlySettled = 0.02;
/// A point moves at most so far towards the next one in a step, as part of the edge between them.
constexpr double kMostOfEdge = 0.4;
/// A point that does not move may do so by this part of an edge, for the interior point method.
constexpr double kHeld = 1e-6;
/// Where the images turn by more (radians) the target has a corner.
constexpr double kCorner = 0.35;
constexpr int kInteriorSteps = 60;
/// Of the gap, as a part of the largest force by the mean room: points are then exact to far less than kSettled; and in
/// steps after which others come.
constexpr double kInteriorTolerance = 1e-9, kRoughInteriorTolerance = 1e-5;
/// The matrix is made definite by this part of its mean diagonal: a shift of all points changes no u.
constexpr double kShift = 1e-10;
/// So many of the edges may run backwards in the chart, which get at least this part of the mean of those around them.
constexpr double kMostBackward = 0.05, kOfNeighbours = 0.1;
/// Edges whose pairs a thread takes at once.
constexpr int kEdgesAtOnce = 32;
/// Edges of a block.
constexpr int kBlock = 4;

/// The target as a curve, and the parameters of the images on it, increasing.
struct Track {
    TargetCurve curve;
    Eigen::VectorXd place;
    std::vector<char> held;
};

Track track_of(const std::vector<Complex>& images) {
    const auto n = static_cast<Eigen::Index>(images.size());
    Eigen::VectorXd place(n);
    std::vector<char> held(images.size(), 0);
    const CircleFit circle = fit_circle(images);
    if (circle.exact()) {
        double angle = std::arg(images[0] - circle.centre);
        for (Eigen::Index i = 0; i < n; ++i) {
            place[i] = circle.radius * angle;
            angle += std::arg((images[(i + 1) % n] - circle.centre) / (images[i] - circle.centre));
        }
        return {TargetCurve::circle(circle.centre, circle.radius), std::move(place), std::move(held)};
    }
    bool corners = false;
    for (Eigen::Index i = 0; i < n; ++i) {
        const Complex before = images[i] - images[(i + n - 1) % n], after = images[(i + 1) % n] - images[i];
        held[i] = std::abs(std::arg(after / before)) > kCorner;
        corners = corners || held[i];
    }
    const TargetCurve curve = corners ? TargetCurve::polygon(images) : TargetCurve::spline(images);
    for (Eigen::Index i = 0; i < n; ++i) place[i] = curve.knots()[i];
    return {curve, std::move(place), std::move(held)};
}

/// The weights w_ij of edges of a circle: the logarithms of the cross ratios of their ends, as log(1 + x) of what keeps
/// its digits where edges are parts of 1e-12 of the circle.
class PairWeights {
  public:
    explicit PairWeights(const Eigen::VectorXd& edges) : edges_(edges), half_sines_(edges.size()) {
        for (Eigen::Index i = 0; i < edges.size(); ++i) half_sines_[i] = half_sine(edges[i]);
    }
    int size() const { return static_cast<int>(edges_.size()); }
    /// Of the edge i and the one that comes so many edges after it, for 1, 2, … up to a number of them, in turn.
    template <class Take>
    void each(int i, int most, Take&& take) const {
        const int n = size();
        double between = 0;
        for (int steps = 1; steps <= most; ++steps) {
            const int j = (i + steps) % n;
            take(j, std::min(steps, n - steps) <= 1 ? of_neighbours(i, j) : apart(i, j, between));
            between += edges_[j];
        }
    }

  private:
    static double half_sine(double angle) { return std::abs(std::sin(0.5 * angle)); }
    /// The integral diverges: by the midpoints.
    double of_neighbours(int i, int j) const {
        const double sine = half_sine(0.5 * (edges_[i] + edges_[j]));
        return edges_[i] * edges_[j] / (4 * sine * sine);
    }
    double apart(int i, int j, double between) const {
        return std::log1p(half_sines_[i] * half_sines_[j] /
                          (half_sine(between) * half_sine(between + edges_[i] + edges_[j])));
    }
    const Eigen::VectorXd& edges_;
    Eigen::VectorXd half_sines_;
};

double energy(const PairWeights& weights, const Eigen::VectorXd& u) {
    const int n = weights.size(), reach = n <= kMostFullEdges ? n / 2 : kBand;
    return parallel_sum<double>(
        n, 0.0,
        [&](int first, int last) {
            double sum = 0;
            for (int i = first; i < last; ++i)
                weights.each(i, reach, [&](int j, double weight) {
                    if (2 * reach == n && j < i && (i + reach) % n == j) return;  // opposite edges once
                    sum += weight * (u[i] - u[j]) * (u[i] - u[j]);
                });
            return sum;
        },
        kEdgesAtOnce);
}

/// The quadratic form Σ w_ij (v_i − v_j)² / 2 over the pairs of edges at most kBand apart, of v = dlog(increment),
/// where the point i moves by x_i: an increment runs from its point to the next. A little of its mean diagonal makes it
/// definite.
class SlackForm {
  public:
    explicit SlackForm(const PairWeights& weights) : SlackForm(weights.size(), pairs_of(weights.size()), weights) {}

    /// Linearises at the increments.
    void set(const Eigen::VectorXd& increment) {
        increment_ = increment;
        hessian_.clear();
        for (std::size_t p = 0; p < pairs_.size(); ++p) {
            const std::array<double, 4> row = row_of(pairs_[p]);
            std::array<double, 10> lower;
            std::size_t entries = 0;
            for (std::size_t a = 0; a < system_.nodes(static_cast<int>(p)).size(); ++a)
                for (std::size_t b = 0; b <= a; ++b) lower[entries++] = weights_[p] * row[a] * row[b];
            system_.add(static_cast<int>(p), {lower.data(), entries}, hessian_);
        }
        system_.set(hessian_);
        double sum = 0;
        for (int i = 0; i < size_; ++i) sum += system_.diagonal(i);
        shift_ = kShift * sum / size_;
    }
    /// H x.
    Eigen::VectorXd apply(const Eigen::VectorXd& x) const {
        Eigen::VectorXd v(size_);
        for (int i = 0; i < size_; ++i) v[i] = (x[(i + 1) % size_] - x[i]) / increment_[i];
        return pull(v) + shift_ * x;
    }
    /// The derivatives by the moves of Σ w_ij (u_i + v_i − u_j − v_j)² / 2 at v = 0.
    Eigen::VectorXd pull(const Eigen::VectorXd& u) const {
        Eigen::VectorXd of_edges = Eigen::VectorXd::Zero(size_), result(size_);
        for (std::size_t p = 0; p < pairs_.size(); ++p) {
            const auto [i, j] = pairs_[p];
            const double force = weights_[p] * (u[i] - u[j]);
            of_edges[i] += force;
            of_edges[j] -= force;
        }
        of_edges.array() /= increment_.array();
        for (int i = 0; i < size_; ++i) result[i] = of_edges[(i + size_ - 1) % size_] - of_edges[i];
        return result;
    }
    /// (H + diag(barrier))⁻¹ rhs.
    Eigen::VectorXd solve(const Eigen::ArrayXd& barrier, const Eigen::VectorXd& rhs) {
        system_.set(hessian_);
        for (int i = 0; i < size_; ++i) system_.add_to_diagonal(i, shift_ + barrier[i]);
        system_.factorize();
        return system_.solve(rhs);
    }

  private:
    using Pairs = std::vector<std::array<int, 2>>;  // of edges, the second after the first

    SlackForm(int size, Pairs pairs, const PairWeights& weights)
        : size_(size), pairs_(std::move(pairs)), system_(system_of(size, pairs_)), hessian_(system_) {
        weights_.reserve(pairs_.size());
        for (int i = 0; i < size; ++i)
            weights.each(i, reach_of(size), [&](int, double weight) { weights_.push_back(weight); });
    }

    static int reach_of(int size) { return std::min(kBand, (size - 1) / 2); }
    static Pairs pairs_of(int size) {
        Pairs pairs;
        for (int i = 0; i < size; ++i)
            for (int step = 1; step <= reach_of(size); ++step) pairs.push_back({i, (i + step) % size});
        return pairs;
    }
    /// The ends of both edges; the one that neighbours share once.
    static ElementSystem system_of(int size, const Pairs& pairs) {
        std::vector<int> offsets{0}, points;
        for (const auto& [i, j] : pairs) {
            points.insert(points.end(), {i, (i + 1) % size});
            if (j != (i + 1) % size) points.push_back(j);
            points.push_back((j + 1) % size);
            offsets.push_back(static_cast<int>(points.size()));
        }
        return {std::move(offsets), std::move(points), size, kSteps * kInteriorSteps};
    }
    /// v_i − v_j by the moves of the pair's points, as system_of lists them.
    std::array<double, 4> row_of(const std::array<int, 2>& pair) const {
        const auto [i, j] = pair;
        const double a = 1 / increment_[i], b = 1 / increment_[j];
        std::array<double, 4> row{-a, a, 0, 0};
        std::size_t count = 2;
        (j == (i + 1) % size_ ? row[1] : row[count++]) += b;
        row[count] -= b;
        return row;
    }

    int size_;
    Pairs pairs_;
    ElementSystem system_;
    ElementSystem::Values hessian_;
    std::vector<double> weights_;
    Eigen::VectorXd increment_;
    double shift_ = 0;
};

/// Minimises ½ xᵀHx + qᵀx between bounds by a primal-dual interior point method.
Eigen::VectorXd minimum_in_box(SlackForm& hessian, const Eigen::VectorXd& q, const Eigen::VectorXd& low,
                               const Eigen::VectorXd& high, double tolerance) {
    Eigen::VectorXd x = 0.5 * (low + high);
    const double force = std::max((hessian.apply(x) + q).cwiseAbs().maxCoeff(), 1e-300);
    Eigen::VectorXd at_low = Eigen::VectorXd::Constant(x.size(), force), at_high = at_low;  // multipliers
    const double last = tolerance * force * (high - low).mean();
    for (int step = 0; step < kInteriorSteps; ++step) {
        const Eigen::ArrayXd above = x - low, below = high - x;
        const double gap = (above * at_low.array() + below * at_high.array()).mean() / 2;
        if (gap < last) break;
        const double centred = (step == 0 ? 0.5 : 0.1) * gap;
        const Eigen::ArrayXd barrier = at_low.array() / above + at_high.array() / below;
        const Eigen::VectorXd rhs = -(hessian.apply(x) + q) + (centred / above - centred / below).matrix();
        const Eigen::ArrayXd move = hessian.solve(barrier, rhs).array();
        const Eigen::ArrayXd low_move = centred / above - at_low.array() - at_low.array() / above * move,
                             high_move = centred / below - at_high.array() + at_high.array() / below * move;
        double length = 1;
        const auto limit = [&](const Eigen::ArrayXd& value, const Eigen::ArrayXd& change) {
            for (Eigen::Index i = 0; i < value.size(); ++i)
                if (change[i] < 0) length = std::min(length, -0.95 * value[i] / change[i]);
        };
        limit(above, move);
        limit(below, -move);
        limit(at_low.array(), low_move);
        limit(at_high.array(), high_move);
        x += length * move.matrix();
        at_low += length * low_move.matrix();
        at_high += length * high_move.matrix();
    }
    return x;
}

/// Angles of the rim's edges in the chart. The few that teeth and folded faces of a scan turn back are taken from their
/// neighbours.
Eigen::VectorXd rim_angles(const std::vector<int>& rim, const Chart& chart) {
    const std::size_t n = rim.size();
    std::vector<double> angles;
    std::size_t backward = 0, first = 0;
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const double angle = std::arg(chart.vertices[rim[(i + 1) % n]] / chart.vertices[rim[i]]);
        sum += angle;
        if (!(angle > 0) && backward++ == 0) first = i;
        angles.push_back(std::max(angle, 0.0));
    }
    if (static_cast<double>(backward) > kMostBackward * static_cast<double>(n) || !(std::abs(sum - kTurn) < 1e-6))
        throw Error(Cause::bad_boundary,
                    "the boundary does not run forward in the conformal chart at vertex " + std::to_string(rim[first]) +
                        ", so its points cannot be moved against their noise",
                    "use no slack, or mend the mesh there", {Things::vertices, {rim[first]}});
    if (backward > 0) raise_to_neighbours(angles, kOfNeighbours);
    const Eigen::Map<const Eigen::VectorXd> result(angles.data(), static_cast<Eigen::Index>(n));
    return result * (kTurn / result.sum());
}

/// The rim in the chart and along the target.
struct Rim {
    Track track;
    double length;           ///< of the target
    Eigen::VectorXd angles;  ///< of its edges in the chart

    Rim(const std::vector<int>& loop, const Chart& chart, const Eigen::VectorXcd& values)
        : track(track_of(images_of(loop, values))), length(track.curve.length()), angles(rim_angles(loop, chart)) {}

    static std::vector<Complex> images_of(const std::vector<int>& loop, const Eigen::VectorXcd& values) {
        std::vector<Complex> images;
        images.reserve(loop.size());
        for (const int v : loop) images.push_back(values[v]);
        return images;
    }
    int size() const { return static_cast<int>(angles.size()); }
    /// Lengths of edges along the target, vertices at the places t.
    /// @throw Error bad_boundary if they do not run forward
    Eigen::VectorXd increments(const Eigen::VectorXd& t) const {
        const int n = size();
        Eigen::VectorXd result(n);
        for (int i = 0; i < n; ++i) result[i] = t[(i + 1) % n] - t[i] + (i == n - 1 ? length : 0.0);
        if (!(result.minCoeff() > 0))
            throw Error(Cause::bad_boundary, "the boundary values do not run forward along their target",
                        "use no slack, or give boundary values that do");
        return result;
    }
};

Eigen::VectorXd speeds(const Eigen::VectorXd& increments, const Eigen::VectorXd& angles) {
    return increments.cwiseQuotient(angles).array().log();
}

/// Sums of kBlock neighbours; the last block has the rest too.
Eigen::VectorXd in_blocks(const Eigen::VectorXd& of_edges) {
    const Eigen::Index blocks = of_edges.size() / kBlock;
    Eigen::VectorXd result(blocks);
    for (Eigen::Index b = 0; b < blocks; ++b) result[b] = of_edges.segment(b * kBlock, kBlock).sum();
    result[blocks - 1] += of_edges.tail(of_edges.size() - blocks * kBlock).sum();
    return result;
}

}  // namespace

SlackBoundary slacken(const Surface& source, const Chart& chart, const BoundaryCondition& boundary, double slack) {
    const std::vector<int>& loop = source.topology.boundary_loops[0];
    const Eigen::VectorXcd values = prescribed_values(boundary, source);
    const Rim rim(loop, chart, values);
    const Track& track = rim.track;
    const int n = rim.size();
    const PairWeights weights(rim.angles);
    const auto beside = [&](const Eigen::VectorXd& of_edges, int i) {
        return std::array{of_edges[(i + n - 1) % n], of_edges[i]};
    };
    Eigen::VectorXd t = track.place, increment = rim.increments(t), edge(n);
    for (int i = 0; i < n; ++i) edge[i] = 0.5 * (beside(increment, i)[0] + beside(increment, i)[1]);
    Eigen::VectorXd low(n), high(n);
    for (int i = 0; i < n; ++i) {
        const double room = (track.held[i] ? std::min(slack, kHeld) : slack) * edge[i];
        low[i] = t[i] - room;
        high[i] = t[i] + room;
    }

    SlackBoundary result{boundary, energy(weights, speeds(increment, rim.angles)), 0, 0};
    SlackForm form(weights);
    double tolerance = kRoughInteriorTolerance;
    for (int step = 0; step < kSteps; ++step) {
        if (step == kSteps - 1) tolerance = kInteriorTolerance;
        form.set(increment);
        // By moves from where the points stand, which may be far shorter than the curve is long.
        Eigen::VectorXd from(n), to(n);
        for (int i = 0; i < n; ++i) {
            const double room = kMostOfEdge * std::min(beside(increment, i)[0], beside(increment, i)[1]);
            from[i] = std::min(std::max(low[i] - t[i], -room), 0.0) - 1e-12 * edge[i];
            to[i] = std::max(std::min(high[i] - t[i], room), 0.0) + 1e-12 * edge[i];
        }
        const Eigen::VectorXd move =
            minimum_in_box(form, form.pull(speeds(increment, rim.angles)), from, to, tolerance);
        const double moved = move.cwiseQuotient(edge).cwiseAbs().maxCoeff();
        t += move;
        increment = rim.increments(t);
        if (moved < kSettled && tolerance == kInteriorTolerance) break;
        if (moved < kNearlySettled) tolerance = kInteriorTolerance;
    }
    result.energy_after = energy(weights, speeds(increment, rim.angles));
    if (!(result.energy_after < result.energy_before)) {
        result.energy_after = result.energy_before;
        return result;
    }
    result.largest_move = (t - track.place).cwiseQuotient(edge).cwiseAbs().maxCoeff();
    std::vector<int> position(values.size(), -1);
    for (int i = 0; i < n; ++i) position[loop[i]] = i;
    for (std::size_t i = 0; i < boundary.vertices.size(); ++i)
        if (const int at = position[boundary.vertices[i]]; at >= 0 && !track.held[at])
            result.boundary.images[i] = track.curve.point(t[at]);
    return result;
}

double energy_of_blocks(const Surface& source, const Chart& chart, const BoundaryCondition& boundary) {
    const Rim rim(source.topology.boundary_loops[0], chart, prescribed_values(boundary, source));
    const Eigen::VectorXd increments = rim.increments(rim.track.place);
    const double whole = energy(PairWeights(rim.angles), speeds(increments, rim.angles));
    if (rim.size() < kBlock || !(whole > 0)) return 1;
    const Eigen::VectorXd angles = in_blocks(rim.angles);
    return energy(PairWeights(angles), speeds(in_blocks(increments), angles)) / whole;
}

}  // namespace beltrami
