#include <beltrami/meshing/refinement.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <beltrami/base/error.h>
#include <beltrami/plane/predicates.h>

namespace beltrami {
namespace {

/// A triangle may have this circumradius per wanted edge length; with it the mean edge comes out as wanted.
constexpr double radius_per_size = 0.75;
/// A segment is split when longer than this times the wanted edge length.
constexpr double longest_segment = 1.5;

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.x() * b.y() - a.y() * b.x();
}

Eigen::Vector2d circumcentre(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
    const Eigen::Vector2d u = b - a, v = c - a;
    const double d = 2.0 * cross(u, v);
    const double uu = u.squaredNorm(), vv = v.squaredNorm();
    return a + Eigen::Vector2d(v.y() * uu - u.y() * vv, u.x() * vv - v.x() * uu) / d;
}

}  // namespace

Refinement::Refinement(Triangulation& triangulation, const PlanarDomain& domain, const TriangulateOptions& options,
                       std::vector<std::array<int, 2>> curve_ends)
    : mesh_(triangulation),
      domain_(domain),
      options_(options),
      curve_ends_(std::move(curve_ends)),
      curve_of_(triangulation.points().size(), interior),
      input_count_(static_cast<int>(triangulation.points().size())) {
    Eigen::AlignedBox2d box;
    for (const Eigen::Vector2d& p : domain.points) box.extend(p);
    floor_ = 1e-7 * box.diagonal().norm();
    ratio_limit_ = std::pow(2.0 * std::sin(options.min_angle), 2);

    for (int t = 0; t < static_cast<int>(mesh_.triangles().size()); ++t) {
        const Triangulation::Triangle& triangle = mesh_.triangle(t);
        for (int i = 0; i < 3; ++i) {
            const int curve = triangle.curves[i];
            if (curve < 0) continue;
            for (const int v :
                 {triangle.vertices[Triangulation::next(i)], triangle.vertices[Triangulation::previous(i)]}) {
                const auto& ends = curve_ends_[curve];
                curve_of_[v] = v == ends[0] || v == ends[1] ? corner : curve;
            }
        }
    }
    sharp_.assign(input_count_, 0);
    for (int v = Triangulation::corner_count; v < input_count_; ++v) {
        if (curve_of_[v] == corner) sharp_[v] = is_sharp(v);
    }
}

/// True if two segments at a corner enclose less than 60 degrees of the domain.
bool Refinement::is_sharp(int v) const {
    mesh_.star(v, star_);
    // Runs of inside triangles between constrained edges, found by their total angle.
    for (std::size_t start = 0; start < star_.size(); ++start) {
        const Triangulation::Triangle& first = mesh_.triangle(star_[start]);
        const int i = first.vertices[0] == v ? 0 : first.vertices[1] == v ? 1 : 2;
        if (!first.inside || first.curves[Triangulation::previous(i)] < 0) continue;
        double angle = 0.0;
        for (std::size_t k = 0; k < star_.size(); ++k) {
            const Triangulation::Triangle& here = mesh_.triangle(star_[(start + k) % star_.size()]);
            const int j = here.vertices[0] == v ? 0 : here.vertices[1] == v ? 1 : 2;
            const Eigen::Vector2d a = mesh_.point(here.vertices[Triangulation::next(j)]) - mesh_.point(v);
            const Eigen::Vector2d b = mesh_.point(here.vertices[Triangulation::previous(j)]) - mesh_.point(v);
            angle += std::atan2(cross(a, b), a.dot(b));
            if (here.curves[Triangulation::next(j)] >= 0) break;
        }
        if (angle < std::acos(0.5) + 1e-9) return true;
    }
    return false;
}

double Refinement::wanted_size(const Eigen::Vector2d& p) const {
    return options_.size ? options_.size(p) : std::numeric_limits<double>::infinity();
}

/// True if u and v lie at the same distance from a sharp corner, on its two sides: the edge between them is as short as
/// the corner makes it, and splitting beside it would go on for ever.
bool Refinement::is_across_sharp_corner(int u, int v) const {
    const int a = curve_of_[u], b = curve_of_[v];
    if (a < 0 || b < 0 || a == b) return false;
    for (const int c : curve_ends_[a]) {
        if (c < 0 || !sharp_[c] || (c != curve_ends_[b][0] && c != curve_ends_[b][1])) continue;
        const double du = (mesh_.point(u) - mesh_.point(c)).norm(), dv = (mesh_.point(v) - mesh_.point(c)).norm();
        if (std::abs(du - dv) < 1e-3 * du) return true;
    }
    return false;
}

/// How urgently a triangle must be split; 0 = not at all. Too large ones come first, the largest of them at the top.
double Refinement::badness(int t) const {
    const Triangulation::Triangle& triangle = mesh_.triangle(t);
    if (!triangle.inside) return 0.0;
    const auto& [u, v, w] = triangle.vertices;
    const Eigen::Vector2d a = mesh_.point(u), b = mesh_.point(v), c = mesh_.point(w);
    const std::array<double, 3> squares{(c - b).squaredNorm(), (a - c).squaredNorm(), (b - a).squaredNorm()};
    const double twice_area = cross(b - a, c - a);
    const double shortest = *std::min_element(squares.begin(), squares.end());
    if (std::max({squares[0], squares[1], squares[2]}) < floor_ * floor_) return 0.0;
    // R = abc / 2·(2A)
    const double radius_square = squares[0] * squares[1] * squares[2] / (4.0 * twice_area * twice_area);
    const double size = wanted_size((a + b + c) / 3.0);
    const double excess = radius_square / std::pow(radius_per_size * size, 2);
    if (excess > 1.0) return 1e6 * excess;
    if (shortest >= ratio_limit_ * radius_square) return 0.0;
    if (shortest < floor_ * floor_) return 0.0;
    const int i = static_cast<int>(std::min_element(squares.begin(), squares.end()) - squares.begin());
    if (is_across_sharp_corner(triangle.vertices[Triangulation::next(i)],
                               triangle.vertices[Triangulation::previous(i)])) {
        return 0.0;
    }
    return ratio_limit_ * radius_square / shortest;
}

bool Refinement::encroaches(const Eigen::Vector2d& p, int a, int b) const {
    return (mesh_.point(a) - p).dot(mesh_.point(b) - p) < 0.0;
}

/// Queues a triangle, and its segments, if they must be split.
void Refinement::examine(int t) {
    const Triangulation::Triangle& triangle = mesh_.triangle(t);
    if (!triangle.inside) return;
    for (int i = 0; i < 3; ++i) {
        if (triangle.curves[i] < 0) continue;
        const int a = triangle.vertices[Triangulation::next(i)], b = triangle.vertices[Triangulation::previous(i)];
        const Eigen::Vector2d middle = 0.5 * (mesh_.point(a) + mesh_.point(b));
        const double length = (mesh_.point(a) - mesh_.point(b)).norm();
        if (encroaches(mesh_.point(triangle.vertices[i]), a, b) || length > longest_segment * wanted_size(middle)) {
            bad_segments_.emplace_back(a, b);
        }
    }
    const double value = badness(t);
    if (value > 0.0) bad_triangles_.push({value, t, triangle.vertices});
}

void Refinement::examine_star(int vertex) {
    std::vector<int> around;
    mesh_.star(vertex, around);
    for (const int t : around) examine(t);
}

void Refinement::require_room() const {
    if (static_cast<int>(mesh_.points().size()) < options_.max_vertices) return;
    throw Error(Cause::not_solved,
                "the refinement reached " + std::to_string(options_.max_vertices) + " vertices without an end",
                "ask for longer edges or a smaller min_angle");
}

bool Refinement::split_segment(Edge edge) {
    const Triangulation::Triangle& triangle = mesh_.triangle(edge.triangle);
    const int a = triangle.vertices[Triangulation::next(edge.index)];
    const int b = triangle.vertices[Triangulation::previous(edge.index)];
    const int curve = triangle.curves[edge.index];
    const Eigen::Vector2d pa = mesh_.point(a), pb = mesh_.point(b);
    const double length = (pb - pa).norm();
    if (length < floor_) return false;
    require_room();
    double t = 0.5;
    const bool sharp_a = a < input_count_ && sharp_[a], sharp_b = b < input_count_ && sharp_[b];
    if (sharp_a != sharp_b) {
        // A power of two near the middle: both sides of the corner are split at the same distances.
        const double distance = std::exp2(std::round(std::log2(0.5 * length)));
        t = sharp_a ? distance / length : 1.0 - distance / length;
    }
    const Eigen::Vector2d straight = pa + t * (pb - pa);
    int vertex = mesh_.split_edge(edge, domain_.project ? domain_.project(curve, straight) : straight);
    if (vertex < 0) vertex = mesh_.split_edge(edge, straight);
    if (vertex < 0) return false;
    curve_of_.push_back(curve);
    examine_star(vertex);
    return true;
}

void Refinement::split_segments() {
    while (!bad_segments_.empty()) {
        const auto [a, b] = bad_segments_.back();
        bad_segments_.pop_back();
        const Edge edge = mesh_.find_edge(a, b);
        if (edge.triangle < 0 || mesh_.triangle(edge.triangle).curves[edge.index] < 0) continue;
        split_segment(edge);
    }
}

/// Walks straight from the centre of t to the target.
/// @return the first constrained edge on the way, or triangle -1; @p last is the triangle where the walk ended
Refinement::Edge Refinement::first_segment_towards(int t, const Eigen::Vector2d& target, int& last) const {
    const auto p = [&](int triangle, int i) { return mesh_.point(mesh_.triangle(triangle).vertices[i]); };
    const Eigen::Vector2d start = (p(t, 0) + p(t, 1) + p(t, 2)) / 3.0;
    last = t;
    int exit = -1;
    for (int i = 0; i < 3; ++i) {
        if (orient2d(start, target, p(t, Triangulation::next(i))) <= 0.0 &&
            orient2d(start, target, p(t, Triangulation::previous(i))) > 0.0) {
            exit = i;
        }
    }
    while (exit >= 0 &&
           orient2d(p(last, Triangulation::next(exit)), p(last, Triangulation::previous(exit)), target) < 0.0) {
        if (mesh_.triangle(last).curves[exit] >= 0) return {last, exit};
        const Edge back = mesh_.twin({last, exit});
        if (back.triangle < 0) break;
        last = back.triangle;
        exit = orient2d(start, target, p(last, back.index)) > 0.0 ? Triangulation::next(back.index)
                                                                  : Triangulation::previous(back.index);
    }
    return {};
}

/// Inserts the circumcentre, or splits the segments that it would encroach upon.
/// @return false if the triangle must be left as it is
bool Refinement::split_triangle(const Candidate& candidate) {
    const auto& [u, v, w] = candidate.vertices;
    const Eigen::Vector2d centre = circumcentre(mesh_.point(u), mesh_.point(v), mesh_.point(w));
    if (!centre.allFinite()) return false;
    int home = -1;
    const Edge blocked = first_segment_towards(candidate.triangle, centre, home);
    if (blocked.triangle >= 0) return split_segment(blocked);

    for (int i = 0; i < 3; ++i) {  // the walk may fail only by rounding of its start
        const auto& h = mesh_.triangle(home).vertices;
        if (orient2d(mesh_.point(h[i]), mesh_.point(h[(i + 1) % 3]), centre) < 0.0) return false;
    }

    // The triangles whose circumcircle contains the centre are those that it will replace; segments on their border may
    // be encroached upon.
    std::vector<int> cavity{home};
    std::vector<std::pair<int, int>> encroached;
    for (std::size_t head = 0; head < cavity.size(); ++head) {
        const Triangulation::Triangle& triangle = mesh_.triangle(cavity[head]);
        for (int i = 0; i < 3; ++i) {
            if (triangle.curves[i] >= 0) {
                const int a = triangle.vertices[Triangulation::next(i)],
                          b = triangle.vertices[Triangulation::previous(i)];
                if (encroaches(centre, a, b)) encroached.emplace_back(a, b);
                continue;
            }
            const int other = triangle.neighbours[i];
            if (other < 0 || std::find(cavity.begin(), cavity.end(), other) != cavity.end()) continue;
            const auto& o = mesh_.triangle(other).vertices;
            if (incircle(mesh_.point(o[0]), mesh_.point(o[1]), mesh_.point(o[2]), centre) > 0.0)
                cavity.push_back(other);
        }
    }
    if (!encroached.empty()) {
        bool changed = false;
        for (const auto& [a, b] : encroached) {
            const Edge edge = mesh_.find_edge(a, b);
            if (edge.triangle >= 0 && mesh_.triangle(edge.triangle).curves[edge.index] >= 0) {
                changed = split_segment(edge) || changed;
            }
        }
        return changed;
    }
    if (!mesh_.triangle(home).inside) return false;
    require_room();
    const std::size_t before = mesh_.points().size();
    const int vertex = mesh_.insert(centre, home);
    if (mesh_.points().size() == before) return false;
    curve_of_.push_back(interior);
    examine_star(vertex);
    return true;
}

void Refinement::refine() {
    for (int t = 0; t < static_cast<int>(mesh_.triangles().size()); ++t) examine(t);
    split_segments();
    while (!bad_triangles_.empty()) {
        const Candidate candidate = bad_triangles_.top();
        bad_triangles_.pop();
        if (mesh_.triangle(candidate.triangle).vertices != candidate.vertices) continue;
        if (!split_triangle(candidate)) continue;
        split_segments();
        // Splitting a segment may have left the triangle itself alone.
        if (mesh_.triangle(candidate.triangle).vertices == candidate.vertices) bad_triangles_.push(candidate);
    }
}

/// The largest cosine of an angle, that is, the smallest angle; 2 if the triangle is turned over.
double Refinement::smallest_angle_cosine(const std::array<Eigen::Vector2d, 3>& p) const {
    if (orient2d(p[0], p[1], p[2]) <= 0.0) return 2.0;
    double largest = -1.0;
    for (int i = 0; i < 3; ++i) {
        const Eigen::Vector2d a = p[(i + 1) % 3] - p[i], b = p[(i + 2) % 3] - p[i];
        largest = std::max(largest, a.dot(b) / std::sqrt(a.squaredNorm() * b.squaredNorm()));
    }
    return largest;
}

/// Worst cosine over star_ if the vertex were at p.
double Refinement::star_quality(int vertex, const Eigen::Vector2d& p) const {
    double worst = -1.0;
    for (const int t : star_) {
        std::array<Eigen::Vector2d, 3> corners;
        for (int i = 0; i < 3; ++i) {
            const int v = mesh_.triangle(t).vertices[i];
            corners[i] = v == vertex ? p : mesh_.point(v);
        }
        worst = std::max(worst, smallest_angle_cosine(corners));
    }
    return worst;
}

/// Moves an interior vertex if that improves the smallest angle around it.
void Refinement::improve(int vertex) {
    mesh_.star(vertex, star_);
    // Optimal Delaunay: the mean of the circumcentres, weighted by area (Chen and Xu, 2004).
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    double area = 0.0;
    for (const int t : star_) {
        const auto& [a, b, c] = mesh_.triangle(t).vertices;
        const double weight = cross(mesh_.point(b) - mesh_.point(a), mesh_.point(c) - mesh_.point(a));
        sum += weight * circumcentre(mesh_.point(a), mesh_.point(b), mesh_.point(c));
        area += weight;
    }
    const Eigen::Vector2d better = sum / area;
    if (better.allFinite() && star_quality(vertex, better) < star_quality(vertex, mesh_.point(vertex))) {
        mesh_.move(vertex, better);
    }
}

void Refinement::smooth() {
    for (int pass = 0; pass < options_.smoothing_passes; ++pass) {
        for (int vertex = input_count_; vertex < static_cast<int>(mesh_.points().size()); ++vertex) {
            if (!is_on_boundary(vertex)) improve(vertex);
        }
        mesh_.restore_delaunay();
    }
}

void Refinement::split_ears() {
    const auto all_on_boundary = [&](const Triangulation::Triangle& triangle) {
        return std::all_of(triangle.vertices.begin(), triangle.vertices.end(),
                           [&](int v) { return is_on_boundary(v); });
    };
    const double least_cosine = std::cos(20.0 * std::acos(-1.0) / 180.0);
    // Triangles added on the way have an interior vertex, so one sweep over the old ones is enough.
    const int count = static_cast<int>(mesh_.triangles().size());
    const int first_added = static_cast<int>(mesh_.points().size());
    for (int t = 0; t < count; ++t) {
        const Triangulation::Triangle triangle = mesh_.triangle(t);
        if (!triangle.inside || !all_on_boundary(triangle)) continue;
        const auto& [a, b, c] = triangle.vertices;
        const std::array<Eigen::Vector2d, 3> p{mesh_.point(a), mesh_.point(b), mesh_.point(c)};
        const auto segments =
            std::count_if(triangle.curves.begin(), triangle.curves.end(), [](int k) { return k >= 0; });
        if (segments < 2) {
            require_room();
            mesh_.insert((p[0] + p[1] + p[2]) / 3.0, t);
            curve_of_.push_back(interior);
            continue;
        }
        if (segments == 3) continue;
        const int i = triangle.curves[0] < 0 ? 0 : triangle.curves[1] < 0 ? 1 : 2;
        const Edge back = mesh_.twin({t, i});
        const int apex = mesh_.triangle(back.triangle).vertices[back.index];
        if (is_on_boundary(apex) || !mesh_.is_convex({t, i})) continue;
        const Eigen::Vector2d q = mesh_.point(apex);
        if (std::max(smallest_angle_cosine({p[i], p[(i + 1) % 3], q}),
                     smallest_angle_cosine({p[i], q, p[(i + 2) % 3]})) < least_cosine) {
            mesh_.flip({t, i});
        }
    }
    for (int pass = 0; pass < options_.smoothing_passes; ++pass) {
        for (int vertex = first_added; vertex < static_cast<int>(mesh_.points().size()); ++vertex) improve(vertex);
    }
}

}  // namespace beltrami
