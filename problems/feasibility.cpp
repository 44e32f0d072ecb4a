#include "problems/feasibility.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <beltrami/mesh/topology.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/plane/polygon.h>
#include <beltrami/plane/predicates.h>

#include "problems/construct.h"

namespace beltrami::bench {

namespace {

struct Segment {
    Complex a, b;
    int loop, index;
    double left() const { return std::min(a.real(), b.real()); }
    double right() const { return std::max(a.real(), b.real()); }
    double low() const { return std::min(a.imag(), b.imag()); }
    double high() const { return std::max(a.imag(), b.imag()); }
};

double side(Complex a, Complex b, Complex c) {
    return orient2d(point(a), point(b), point(c));
}

bool in_box(const Segment& s, Complex p) {
    return s.left() <= p.real() && p.real() <= s.right() && s.low() <= p.imag() && p.imag() <= s.high();
}

/// Whether two segments without a common end meet, decided exactly.
bool meet(const Segment& s, const Segment& t) {
    const double c = side(s.a, s.b, t.a), d = side(s.a, s.b, t.b), a = side(t.a, t.b, s.a), b = side(t.a, t.b, s.b);
    if (((c > 0 && d < 0) || (c < 0 && d > 0)) && ((a > 0 && b < 0) || (a < 0 && b > 0))) return true;
    return (c == 0 && in_box(s, t.a)) || (d == 0 && in_box(s, t.b)) || (a == 0 && in_box(t, s.a)) ||
           (b == 0 && in_box(t, s.b));
}

bool encloses(const std::vector<Complex>& polygon, Complex p) {
    bool inside = false;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Complex a = polygon[i], b = polygon[(i + 1) % polygon.size()];
        if ((a.imag() > p.imag()) != (b.imag() > p.imag()) && (side(a, b, p) > 0) == (b.imag() > a.imag()))
            inside = !inside;
    }
    return inside;
}

}  // namespace

std::string infeasibility(const Problem& problem) {
    const Topology shape = topology(problem.mesh);
    const double none = std::numeric_limits<double>::quiet_NaN();
    std::vector<Complex> image(problem.mesh.vertex_count(), Complex(none, none));
    for (std::size_t i = 0; i < problem.boundary.vertices.size(); ++i)
        image[problem.boundary.vertices[i]] = problem.boundary.images[i];

    std::vector<std::vector<Complex>> loops;
    std::vector<Segment> segments;
    for (const auto& loop : shape.boundary_loops) {
        const int l = static_cast<int>(loops.size());
        std::vector<Complex> polygon;
        for (const int v : loop) {
            if (!std::isfinite(std::abs(image[v]))) return "vertex " + std::to_string(v) + " has no image";
            polygon.push_back(image[v]);
        }
        for (std::size_t i = 0; i < polygon.size(); ++i)
            segments.push_back({polygon[i], polygon[(i + 1) % polygon.size()], l, static_cast<int>(i)});
        const double area = signed_area(polygon);
        if (!(l == 0 ? area > 0 : area < 0)) return "the image of loop " + std::to_string(l) + " runs the wrong way";
        loops.push_back(std::move(polygon));
    }
    std::sort(segments.begin(), segments.end(), [](const Segment& s, const Segment& t) { return s.left() < t.left(); });
    for (std::size_t i = 0; i < segments.size(); ++i)
        for (std::size_t j = i + 1; j < segments.size() && segments[j].left() <= segments[i].right(); ++j) {
            Segment s = segments[i], t = segments[j];
            const std::string where = "edges " + std::to_string(s.index) + " of loop " + std::to_string(s.loop) +
                                      " and " + std::to_string(t.index) + " of loop " + std::to_string(t.loop) +
                                      " meet";
            if (s.a == s.b) return "an edge of loop " + std::to_string(s.loop) + " has no length";
            if (s.low() > t.high() || t.low() > s.high()) continue;
            const int n = static_cast<int>(loops[s.loop].size());
            if (s.loop == t.loop && (s.index + 1) % n == t.index) {
                if (side(s.a, s.b, t.b) == 0 && std::real(std::conj(s.b - s.a) * (t.b - t.a)) < 0) return where;
            } else if (s.loop == t.loop && (t.index + 1) % n == s.index) {
                if (side(t.a, t.b, s.b) == 0 && std::real(std::conj(t.b - t.a) * (s.b - s.a)) < 0) return where;
            } else if (meet(s, t)) {
                return where;
            }
        }
    for (std::size_t l = 1; l < loops.size(); ++l) {
        if (!encloses(loops[0], loops[l][0])) return "hole " + std::to_string(l) + " lies outside";
        for (std::size_t m = 1; m < loops.size(); ++m)
            if (m != l && encloses(loops[m], loops[l][0]))
                return "hole " + std::to_string(l) + " lies in hole " + std::to_string(m);
    }
    return "";
}

MapQuality map_quality(const Problem& problem, const Eigen::VectorXcd& map) {
    MapQuality result;
    const Eigen::VectorXcd mu = beltrami_coefficient(operators(problem.mesh), map);
    std::vector<double> sizes;
    for (Eigen::Index s = 0; s < mu.size(); ++s) {
        const double size = std::abs(mu[s]);
        sizes.push_back(std::isfinite(size) ? size : 1e300);
        // Written so that NaN counts.
        if (!(size < 1)) ++result.flipped;
    }
    std::sort(sizes.begin(), sizes.end());
    result.max_mu = sizes.back();
    result.p95_mu = sizes[static_cast<std::size_t>(0.95 * static_cast<double>(sizes.size() - 1))];
    for (std::size_t i = 0; i < problem.boundary.vertices.size(); ++i)
        result.pin_error =
            std::max(result.pin_error, std::abs(map[problem.boundary.vertices[i]] - problem.boundary.images[i]));
    return result;
}

namespace {

/// A point inside a simple polygon: the middle of its two leftmost crossings with a horizontal line.
Complex inside_point(const std::vector<Complex>& polygon) {
    std::vector<double> heights;
    for (const Complex z : polygon) heights.push_back(z.imag());
    std::sort(heights.begin(), heights.end());
    // Through the widest gap of the corners' heights.
    std::size_t widest = 0;
    for (std::size_t i = 0; i + 1 < heights.size(); ++i)
        if (heights[i + 1] - heights[i] > heights[widest + 1] - heights[widest]) widest = i;
    const double y = (heights[widest] + heights[widest + 1]) / 2;
    std::vector<double> crossings;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Complex a = polygon[i], b = polygon[(i + 1) % polygon.size()];
        if ((a.imag() > y) != (b.imag() > y))
            crossings.push_back(a.real() + (y - a.imag()) / (b.imag() - a.imag()) * (b.real() - a.real()));
    }
    std::sort(crossings.begin(), crossings.end());
    return {(crossings[0] + crossings[1]) / 2, y};
}

}  // namespace

std::vector<int> relative_turns(const Problem& problem, const Eigen::VectorXcd& map, const Eigen::VectorXcd& other) {
    const Topology shape = topology(problem.mesh);
    std::vector<std::vector<int>> neighbours(problem.mesh.vertex_count());
    for (const auto& [a, b] : shape.edges) {
        neighbours[a].push_back(b);
        neighbours[b].push_back(a);
    }
    // Paths of edges to the first vertex of the outer loop.
    std::vector<int> next(problem.mesh.vertex_count(), -1), queue{shape.boundary_loops[0][0]};
    next[queue[0]] = queue[0];
    for (std::size_t i = 0; i < queue.size(); ++i)
        for (const int v : neighbours[queue[i]])
            if (next[v] < 0) {
                next[v] = queue[i];
                queue.push_back(v);
            }
    std::vector<int> result{0};
    for (std::size_t l = 1; l < shape.boundary_loops.size(); ++l) {
        std::vector<Complex> image;
        for (const int v : shape.boundary_loops[l]) image.push_back(map[v]);
        const Complex centre = inside_point(image);
        // No edge crosses the hole, so each turns by less than half a turn about a point in it.
        double turned = 0;
        for (int v = shape.boundary_loops[l][0]; next[v] != v; v = next[v])
            turned += std::arg((other[next[v]] - centre) / (other[v] - centre)) -
                      std::arg((map[next[v]] - centre) / (map[v] - centre));
        result.push_back(static_cast<int>(std::lround(turned / (2 * std::numbers::pi))));
    }
    return result;
}

}  // namespace beltrami::bench
