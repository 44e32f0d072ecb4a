#include <beltrami/uniformize/ideal_triangulation.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace beltrami {

namespace {

// Margins within which an edge counts as Delaunay: of a sum of two cosines, of one beyond −1, of an arc's convexity.
constexpr double kFiniteTie = 1e-9, kLinkTie = 1e-10, kArcTie = 1e-9;
constexpr double kTight = 1e-9;        // a_i below which the bound is met
constexpr double kLeastGain = 1e-12;   // of a flip, so that rounding cannot make two diagonals replace each other
constexpr double kAngleTie = 1e-7;     // radians beyond which an arc is released
constexpr long long kMostFlips = 200;  // per half-edge: a guard against rounding only

}  // namespace

IdealTriangulation::IdealTriangulation(IntrinsicTriangulation triangulation, int ideal_vertex)
    : triangulation_(std::move(triangulation)),
      ideal_(ideal_vertex),
      cosines_(static_cast<std::size_t>(triangulation_.halfedge_count()), 0.0) {
    int arcs = 0;
    for (int h = 0; h < triangulation_.halfedge_count(); ++h) {
        if (tail(h) != ideal_) continue;
        log_constant_ += triangulation_.log_length(h);
        ++arcs;
    }
    log_constant_ /= std::max(arcs, 1);
    find_link();
}

void IdealTriangulation::find_link() {
    on_link_.assign(static_cast<std::size_t>(triangulation_.vertex_count()), 0);
    for (int h = 0; h < triangulation_.halfedge_count(); ++h)
        if (tail(h) == ideal_) on_link_[head(h)] = 1;
    on_link_[ideal_] = 0;
}

Eigen::VectorXd IdealTriangulation::start() const {
    Eigen::VectorXd u = Eigen::VectorXd::Zero(triangulation_.vertex_count());
    for (int h = 0; h < triangulation_.halfedge_count(); ++h)
        if (tail(h) == ideal_) u[head(h)] = 2 * (log_constant_ - triangulation_.log_length(h));
    return u;
}

void IdealTriangulation::measure(int triangle, const Eigen::VectorXd& u) {
    if (!is_finite(triangle)) return;
    const std::array<double, 3> cosines = triangle_cosines(triangulation_.log_lengths(triangle, u));
    std::copy(cosines.begin(), cosines.end(), cosines_.begin() + 3 * triangle);
}

IdealTriangulation::Violation IdealTriangulation::violation(int h, const Eigen::VectorXd& u) const {
    const int g = twin(h);
    if (h / 3 == g / 3) return Violation::none;
    const bool left = is_finite(h / 3), right = is_finite(g / 3);
    if (left && right) return cosines_[h] + cosines_[g] < -kFiniteTie ? Violation::finite : Violation::none;
    if (is_arc(h)) return arc_violates(h, u) ? Violation::arc : Violation::none;
    if (!left && !right) return Violation::none;
    return link_violates(left ? h : g, left ? g : h, u) ? Violation::link : Violation::none;
}

bool IdealTriangulation::link_violates(int finite_side, int ideal_side, const Eigen::VectorXd& u) const {
    if (tail(previous(ideal_side)) != ideal_) return false;
    const double difference = excess(next(ideal_side), u) - excess(previous(ideal_side), u);
    return cosines_[finite_side] < -std::cosh(difference) - kLinkTie;
}

bool IdealTriangulation::arc_violates(int h, const Eigen::VectorXd& u) const {
    if (tail(h) == ideal_ && head(h) == ideal_) return false;
    // Outward ∞→i, with the triangle (∞, i, k) on its left and (i, ∞, j) on its right.
    const int outward = tail(h) == ideal_ ? h : twin(h), inward = twin(outward);
    if (tail(previous(outward)) == ideal_ || tail(previous(inward)) == ideal_) return false;
    const double a = excess(outward, u);
    if (a < kTight) return false;
    const double to_k = triangulation_.log_length(next(outward), u);
    const double to_j = triangulation_.log_length(previous(inward), u);
    const double nearer = std::min(to_k, to_j);
    const auto term = [&](int arc, double log_length) {
        const double other = excess(arc, u);
        return (std::exp(2 * other) - std::exp(2 * a)) * std::exp(nearer - log_length - other);
    };
    return term(previous(outward), to_k) + term(next(inward), to_j) < -kArcTie;
}

bool IdealTriangulation::flip_finite(int h, const Eigen::VectorXd& u) {
    const int g = twin(h);
    const double old_length = triangulation_.log_length(h), new_length = triangulation_.ptolemy_log_length(h);
    if (!std::isfinite(new_length)) return false;
    const double before = cosines_[h] + cosines_[g];
    triangulation_.flip(h, new_length);
    measure(h / 3, u);
    measure(g / 3, u);
    if (cosines_[h] + cosines_[g] > before + kLeastGain) return true;
    for (int turn = 0; turn < 3; ++turn) triangulation_.flip(h, turn == 2 ? old_length : new_length);
    measure(h / 3, u);
    measure(g / 3, u);
    return false;
}

void IdealTriangulation::flip_link(int h, Eigen::VectorXd& u, std::vector<int>& changed) {
    const int g = twin(h), finite_side = is_finite(h / 3) ? h : g;
    const int joins = tail(previous(finite_side));
    const double length = triangulation_.ptolemy_log_length(h);
    if (!std::isfinite(length)) return;
    triangulation_.flip(h, length);
    u[joins] = std::max(u[joins], 2 * (log_constant_ - length));
    // Its u may have changed, and with it the whole star.
    const int first = tail(h) == joins ? h : g;
    for (int s = first;;) {
        measure(s / 3, u);
        changed.insert(changed.end(), {s, next(s), previous(s)});
        s = twin(previous(s));
        if (s == first) break;
    }
}

int IdealTriangulation::make_delaunay(Eigen::VectorXd& u) {
    // A vertex that came to the link in a trial that was rejected has its u of before.
    for (int h = 0; h < triangulation_.halfedge_count(); ++h)
        if (tail(h) == ideal_) u[head(h)] = std::max(u[head(h)], 2 * (log_constant_ - triangulation_.log_length(h)));
    for (int t = 0; t < triangulation_.triangle_count(); ++t) measure(t, u);
    std::vector<int> waiting, changed;
    for (int h = triangulation_.halfedge_count() - 1; h >= 0; --h)
        if (h > twin(h) && violation(h, u) != Violation::none) waiting.push_back(h);

    int flips = 0;
    bool at_infinity = false;
    const long long most_flips = kMostFlips * triangulation_.halfedge_count();
    while (!waiting.empty() && flips < most_flips) {
        const int h = waiting.back();
        waiting.pop_back();
        const int g = twin(h);
        changed.clear();
        switch (violation(h, u)) {
            case Violation::none:
                continue;
            case Violation::finite:
                if (!flip_finite(h, u)) continue;
                changed = {next(h), previous(h), next(g), previous(g)};
                break;
            case Violation::link:
                flip_link(h, u, changed);
                if (changed.empty()) continue;
                at_infinity = true;
                break;
            case Violation::arc: {
                const double length = triangulation_.ptolemy_log_length(h);
                if (!std::isfinite(length)) continue;
                triangulation_.flip(h, length);
                measure(h / 3, u);
                measure(g / 3, u);
                changed = {h, next(h), previous(h), next(g), previous(g)};
                at_infinity = true;
                break;
            }
        }
        ++flips;
        for (const int side : changed)
            if (violation(side, u) != Violation::none) waiting.push_back(side);
    }
    if (at_infinity) find_link();
    return flips;
}

int IdealTriangulation::release(const Eigen::VectorXd& u) {
    std::vector<double> angle_sums(on_link_.size(), 0.0);
    std::vector<int> arcs_at(on_link_.size(), 0), arcs;
    for (int t = 0; t < triangulation_.triangle_count(); ++t) {
        if (!is_finite(t)) continue;
        const TriangleAngles triangle = triangulation_.angles(t, u);
        for (int k = 0; k < 3; ++k) angle_sums[tail(previous(3 * t + k))] += triangle.angles[k];
    }
    for (int h = 0; h < triangulation_.halfedge_count(); ++h) {
        if (tail(h) != ideal_ || head(h) == ideal_) continue;
        arcs.push_back(h);
        ++arcs_at[head(h)];
    }
    int left = static_cast<int>(arcs.size()), released = 0;
    for (const int h : arcs) {
        // Flips move sides of quadrilaterals to other half-edges.
        if (left <= 3) break;
        if (tail(h) != ideal_ || head(h) == ideal_ || h / 3 == twin(h) / 3) continue;
        const int vertex = head(h);
        const double most = arcs_at[vertex] > 1 ? 0 : std::numbers::pi;
        if (!(angle_sums[vertex] > most + kAngleTie)) continue;
        if (tail(previous(h)) == ideal_ || tail(previous(twin(h))) == ideal_) continue;
        triangulation_.flip(h, triangulation_.ptolemy_log_length(h));
        --left;
        --arcs_at[vertex];
        ++released;
    }
    if (released > 0) find_link();
    return released;
}

std::vector<char> simple_stars(const IntrinsicTriangulation& triangulation) {
    const int vertices = triangulation.vertex_count();
    std::vector<int> seen_from(static_cast<std::size_t>(vertices), -1);
    std::vector<std::vector<int>> heads(static_cast<std::size_t>(vertices));
    for (int h = 0; h < triangulation.halfedge_count(); ++h)
        heads[triangulation.tail(h)].push_back(triangulation.head(h));
    std::vector<char> simple(static_cast<std::size_t>(vertices), 0);
    for (int v = 0; v < vertices; ++v) {
        simple[v] = heads[v].size() >= 3;
        for (const int w : heads[v]) {
            if (w == v || seen_from[w] == v) simple[v] = 0;
            seen_from[w] = v;
        }
    }
    return simple;
}

}  // namespace beltrami
