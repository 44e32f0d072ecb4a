#include <beltrami/uniformize/intrinsic_triangulation.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <beltrami/mesh/edge_table.h>

namespace beltrami {

namespace {

// Edges whose opposite angles sum to π within this margin (measured in cosines) are left alone: both diagonals are then
// Delaunay, the energy is twice differentiable across the tie, and grids do not flip back and forth.
constexpr double kDelaunayTie = 1e-9;
// A flip must gain this much, so that rounding in needles cannot make two diagonals replace each other for ever.
constexpr double kLeastGainOfFlip = 1e-12;
constexpr double kSmallestLogRatio = -300.0;  // keeps products of two relative lengths above underflow

/// Lengths of a triangle relative to the longest, and what Heron's formula is made of.
struct Sides {
    std::array<double, 3> lengths;
    std::array<double, 3> excess;  // excess[k] = sum of the other two − length k; negative: the inequality is violated
    double perimeter;
};

Sides sides(const std::array<double, 3>& log_lengths) {
    const double largest = std::max({log_lengths[0], log_lengths[1], log_lengths[2]});
    Sides s;
    for (int k = 0; k < 3; ++k) s.lengths[k] = std::exp(std::max(log_lengths[k] - largest, kSmallestLogRatio));
    const auto& [a, b, c] = s.lengths;
    // Subtract neighbours in size first: those differences are exact (Kahan, "Miscalculating area and angles of a
    // needle-like triangle").
    const auto excess = [](double other, double another, double length) {
        return other > another ? another - (length - other) : other - (length - another);
    };
    s.excess = {excess(b, c, a), excess(c, a, b), excess(a, b, c)};
    s.perimeter = a + b + c;
    return s;
}

/// Cosine of the angle opposite length k; beyond ±1 where the triangle inequality fails.
double cosine(const Sides& s, int k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    return (s.perimeter * s.excess[k] - s.excess[i] * s.excess[j]) / (4 * s.lengths[i] * s.lengths[j]);
}

double log_add(double x, double y) {
    return std::max(x, y) + std::log1p(std::exp(-std::abs(x - y)));
}

}  // namespace

TriangleAngles triangle_angles(const std::array<double, 3>& log_lengths) {
    const Sides s = sides(log_lengths);
    TriangleAngles result;
    for (int k = 0; k < 3; ++k) {
        if (s.excess[k] > 0) continue;
        result.angles = {0, 0, 0};
        result.angles[k] = std::numbers::pi;
        result.cotangents = {0, 0, 0};
        result.degenerate = true;
        return result;
    }
    for (int k = 0; k < 3; ++k) {
        const double opposite = s.excess[(k + 1) % 3] * s.excess[(k + 2) % 3];
        const double adjacent = s.perimeter * s.excess[k];
        const double area = std::sqrt(opposite * adjacent);  // four times the area
        result.angles[k] = 2 * std::atan2(std::sqrt(opposite), std::sqrt(adjacent));
        result.cotangents[k] = (adjacent - opposite) / (2 * area);
    }
    return result;
}

std::array<double, 3> triangle_cosines(const std::array<double, 3>& log_lengths) {
    const Sides s = sides(log_lengths);
    return {cosine(s, 0), cosine(s, 1), cosine(s, 2)};
}

IntrinsicTriangulation::IntrinsicTriangulation(const FaceList& triangles, int vertex_count,
                                               std::vector<double> log_lengths)
    : vertex_count_(vertex_count),
      tails_(triangles.vertices()),
      twins_(triangles.vertices().size(), -1),
      log_lengths_(std::move(log_lengths)) {
    const EdgeTable table = edge_table(triangles, vertex_count);
    for (int edge = 0; edge < table.edge_count(); ++edge) {
        const std::span<const int> corners = table.corners_of(edge);
        if (corners.size() == 2) glue(corners[0], corners[1]);
    }
}

void IntrinsicTriangulation::glue(int h, int twin) {
    if (h >= 0) twins_[h] = twin;
    if (twin >= 0) twins_[twin] = h;
}

std::vector<EdgeFlip> IntrinsicTriangulation::delaunay_flips() {
    return flip_to_delaunay<Rule::unfold>(Eigen::VectorXd::Zero(vertex_count_));
}

std::vector<EdgeFlip> IntrinsicTriangulation::delaunay_flips(const Eigen::VectorXd& u) {
    return flip_to_delaunay<Rule::ptolemy>(u);
}

template <IntrinsicTriangulation::Rule rule>
std::vector<EdgeFlip> IntrinsicTriangulation::flip_to_delaunay(const Eigen::VectorXd& u) {
    const auto measure = [&](int triangle) {
        const std::array<double, 3> cosines = triangle_cosines(log_lengths(triangle, u));
        std::copy(cosines.begin(), cosines.end(), cosines_.begin() + 3 * triangle);
    };
    // α + β ≤ π exactly when cos α + cos β ≥ 0, which makes sense without the triangle inequality too.
    const auto violates = [&](int h) {
        const int twin = twins_[h];
        return twin >= 0 && h / 3 != twin / 3 && cosines_[h] + cosines_[twin] < -kDelaunayTie;
    };

    cosines_.resize(tails_.size());
    for (int t = 0; t < triangle_count(); ++t) measure(t);
    std::vector<int> waiting;
    for (int h = halfedge_count() - 1; h >= 0; --h)
        if (h > twins_[h] && violates(h)) waiting.push_back(h);

    std::vector<EdgeFlip> flips;
    // The algorithm ends by itself; the cap only guards against rounding and leaves a triangulation that is still
    // valid.
    const auto most_flips = 100 * static_cast<std::size_t>(halfedge_count());
    while (!waiting.empty() && flips.size() < most_flips) {
        const int h = waiting.back();
        waiting.pop_back();
        if (!violates(h)) continue;
        const double old_log_length = log_lengths_[h];
        const double new_log_length = flipped_log_length(h, rule);
        if (!std::isfinite(new_log_length)) continue;
        const int twin = twins_[h];
        const double before = cosines_[h] + cosines_[twin];
        flip(h, new_log_length);
        measure(h / 3);
        measure(twin / 3);
        if (!(cosines_[h] + cosines_[twin] > before + kLeastGainOfFlip)) {
            for (int turn = 0; turn < 3; ++turn) flip(h, turn == 2 ? old_log_length : new_log_length);
            measure(h / 3);
            measure(twin / 3);
            continue;
        }
        flips.push_back({h, twin, old_log_length});
        for (const int side : {next(h), previous(h), next(twin), previous(twin)})
            if (violates(side)) waiting.push_back(side);
    }
    return flips;
}

double IntrinsicTriangulation::flipped_log_length(int h, Rule rule) const {
    const int twin = twins_[h];
    const double diagonal = log_lengths_[h];
    // The quadrilateral i l j k around h = i→j: sides j→k, k→i on the left, i→l, l→j on the right.
    const double jk = log_lengths_[next(h)], ki = log_lengths_[previous(h)];
    const double il = log_lengths_[next(twin)], lj = log_lengths_[previous(twin)];
    if (rule == Rule::ptolemy) return log_add(jk + il, ki + lj) - diagonal;

    // |kl|² = (|ki| − |il|)² + 4 |ki||il| sin²(θ/2), θ the angle at i: no cancellation.
    const double at_i = triangle_angles({diagonal, jk, ki}).angles[1] + triangle_angles({diagonal, il, lj}).angles[2];
    const double longer = std::max(ki, il), ratio = std::exp(std::min(ki, il) - longer);
    const double sine = std::sin(0.5 * at_i);
    return longer + 0.5 * std::log((1 - ratio) * (1 - ratio) + 4 * ratio * sine * sine);
}

void IntrinsicTriangulation::flip(int h, double log_length) {
    const int g = twins_[h];
    const int from[4] = {previous(h), next(g), previous(g), next(h)};
    const int to[4] = {next(h), previous(h), next(g), previous(g)};
    const int i = tails_[h], j = tails_[g], k = tails_[previous(h)], l = tails_[previous(g)];
    int twins[4];
    double lengths[4];
    for (int s = 0; s < 4; ++s) {
        twins[s] = twins_[from[s]];
        // Two sides of the quadrilateral may be glued to each other: then the partner moves as well.
        const auto moved = std::find(from, from + 4, twins[s]);
        if (twins[s] >= 0 && moved != from + 4) twins[s] = to[moved - from];
        lengths[s] = log_lengths_[from[s]];
    }
    for (int s = 0; s < 4; ++s) {
        glue(to[s], twins[s]);
        log_lengths_[to[s]] = lengths[s];
    }
    log_lengths_[h] = log_lengths_[g] = log_length;
    tails_[h] = l, tails_[next(h)] = k, tails_[previous(h)] = i;
    tails_[g] = k, tails_[next(g)] = l, tails_[previous(g)] = j;
}

IntrinsicTriangulation IntrinsicTriangulation::without(int vertex) const {
    std::vector<int> numbers(tails_.size(), -1);
    int count = 0;
    for (int t = 0; t < triangle_count(); ++t) {
        const int h = 3 * t;
        if (tails_[h] == vertex || tails_[h + 1] == vertex || tails_[h + 2] == vertex) continue;
        for (int k = 0; k < 3; ++k) numbers[h + k] = count++;
    }
    IntrinsicTriangulation part;
    part.vertex_count_ = vertex_count_;
    for (int h = 0; h < halfedge_count(); ++h) {
        if (numbers[h] < 0) continue;
        part.tails_.push_back(tails_[h]);
        part.twins_.push_back(twins_[h] < 0 ? -1 : numbers[twins_[h]]);
        part.log_lengths_.push_back(log_lengths_[h]);
    }
    return part;
}

IntrinsicTriangulation IntrinsicTriangulation::doubled() const {
    const int own = halfedge_count();
    std::vector<char> inside(static_cast<std::size_t>(vertex_count_), 0);
    for (int h = 0; h < own; ++h) inside[tail(h)] = 1;
    for (int h = 0; h < own; ++h)
        if (twin(h) < 0) inside[tail(h)] = inside[head(h)] = 0;
    IntrinsicTriangulation result = *this;
    std::vector<int> images(inside.size());
    for (int v = 0; v < vertex_count_; ++v) images[v] = inside[v] ? result.vertex_count_++ : v;
    result.tails_.resize(2 * tails_.size());
    result.twins_.resize(2 * tails_.size());
    result.log_lengths_.resize(2 * tails_.size());
    for (int h = 0; h < own; ++h) {
        const int image = mirrored(h, own);
        result.tails_[image] = images[head(h)];
        result.log_lengths_[image] = log_length(h);
        if (twin(h) < 0)
            result.glue(h, image);
        else
            result.twins_[image] = mirrored(twin(h), own);
    }
    return result;
}

int IntrinsicTriangulation::split_boundary(int h) {
    const int n = next(h), p = previous(h);
    const double base = log_lengths_[h], left = log_lengths_[p], right = log_lengths_[n];
    const Sides s = sides({base, right, left});
    // The foot lies |ki| cos(angle at i) from i, as a share of the base.
    constexpr double margin = 1e-3;
    double share = s.lengths[2] * cosine(s, 1) / s.lengths[0];
    if (!(share > margin && share < 1 - margin)) share = 0.5;
    // |mk|² by Stewart's theorem, as the sum of squares of distance along and across the base.
    const double along = s.lengths[2] * cosine(s, 1) - share * s.lengths[0];
    const double product = s.perimeter * s.excess[0] * s.excess[1] * s.excess[2];
    const double height = std::sqrt(std::max(product, 0.0)) / (2 * s.lengths[0]);
    const double scale = base - std::log(s.lengths[0]);
    const double new_edge = scale + std::log(std::hypot(along, height));

    // The old triangle keeps i m k; m j k is new. The half-edge from m to k is the old j→k slot.
    const int vertex = vertex_count_++;
    const int added = halfedge_count();
    const int j = tails_[n], k = tails_[p], outer = twins_[n];
    tails_.insert(tails_.end(), {vertex, j, k});
    twins_.insert(twins_.end(), {-1, -1, -1});
    log_lengths_.insert(log_lengths_.end(), {base + std::log1p(-share), right, new_edge});
    glue(added + 1, outer);
    glue(added + 2, n);
    tails_[n] = vertex;
    log_lengths_[n] = new_edge;
    log_lengths_[h] = base + std::log(share);
    return vertex;
}

}  // namespace beltrami
