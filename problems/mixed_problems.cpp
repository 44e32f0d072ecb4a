#include "problems/mixed_problems.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <beltrami/meshing/delaunay.h>

#include "problems/construct.h"
#include "problems/elliptic.h"

namespace beltrami::bench {

namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr Complex kI(0, 1);
/// Edges at pins and where the condition changes, as part of the others; from this far they grow like the root of the
/// distance: there maps are like |z|, which has the interpolation error h²/|z| on edges h.
constexpr double kFinest = 0.03, kGradedFrom = 0.25, kGradedFromOnBoundary = 1;

struct RoundHoleOf {
    Complex centre;
    double radius;
};

/// The disk less round holes, fine at given places: pins inside, the first vertices of the mesh, and places on the unit
/// circle, which are vertices too.
Mesh graded_disk(double h, const std::vector<Complex>& pins, std::vector<double> angles,
                 const std::vector<RoundHoleOf>& holes = {}) {
    std::sort(angles.begin(), angles.end());
    const SizeField size = [&](const Eigen::Vector2d& p) {
        double wanted = h;
        const auto finer_at = [&](Complex z, double from) {
            const double far = std::abs(Complex(p.x(), p.y()) - z);
            wanted = std::min(wanted, kFinest * h + std::min(0.3 * far, h * std::sqrt(far / from)));
        };
        for (const Complex z : pins) finer_at(z, kGradedFrom);
        for (const double t : angles) finer_at(std::polar(1.0, t), kGradedFromOnBoundary);
        for (const auto& hole : holes)
            wanted =
                std::min(wanted, std::min(h, kTurn * hole.radius / 40) +
                                     0.3 * std::max(0.0, std::abs(Complex(p.x(), p.y()) - hole.centre) - hole.radius));
        return wanted;
    };
    PlanarDomain domain;
    for (const Complex z : pins) domain.points.push_back(point(z));
    const auto add_circle = [&](int curve, Complex centre, double radius, const std::vector<double>& ends) {
        const int first = static_cast<int>(domain.points.size());
        for (std::size_t a = 0; a < ends.size(); ++a) {
            const double from = ends[a], to = a + 1 < ends.size() ? ends[a + 1] : ends[0] + kTurn;
            const auto at = [&](double s) { return centre + std::polar(radius, from + s * (to - from)); };
            const std::vector<double> t = spread(
                radius * (to - from), [&](double s) { return size(point(at(s))); }, ends.size() > 1 ? 2 : 32);
            for (std::size_t k = 0; k + 1 < t.size(); ++k) domain.points.push_back(point(at(t[k])));
        }
        const int n = static_cast<int>(domain.points.size()) - first;
        for (int k = 0; k < n; ++k) {
            domain.segments.push_back({first + k, first + (k + 1) % n});
            domain.curves.push_back(curve);
        }
    };
    add_circle(0, 0, 1, angles.empty() ? std::vector<double>{0} : angles);
    for (std::size_t i = 0; i < holes.size(); ++i)
        add_circle(static_cast<int>(i) + 1, holes[i].centre, holes[i].radius, {0});
    domain.project = [&](int curve, const Eigen::Vector2d& p) {
        const RoundHoleOf circle = curve == 0 ? RoundHoleOf{0, 1} : holes[curve - 1];
        const Complex from = Complex(p.x(), p.y()) - circle.centre;
        return point(circle.centre + circle.radius * from / std::abs(from));
    };
    TriangulateOptions options;
    options.size = size;
    return triangulate(domain, options);
}

/// The closed polygon through what is prescribed on a loop; sliding arcs are its straight sides between.
TargetCurve polygon_through(const Mesh& mesh, const std::vector<int>& loop, const BoundaryCondition& prescribed) {
    std::vector<Complex> corners;
    std::vector<int> position(mesh.vertex_count(), -1);
    for (std::size_t i = 0; i < prescribed.vertices.size(); ++i) position[prescribed.vertices[i]] = static_cast<int>(i);
    for (const int v : loop)
        if (position[v] >= 0) corners.push_back(prescribed.images[position[v]]);
    return TargetCurve::polygon(corners);
}

/// Moves along the circle by t + amplitude sin(t + shift), or back.
struct CircleMotion {
    double amplitude, shift;
    double forward(double t) const { return t + amplitude * std::sin(t + shift); }
    double back(double t) const {
        double x = t;
        for (int i = 0; i < 60; ++i) x -= (forward(x) - t) / (1 + amplitude * std::cos(x + shift));
        return x;
    }
    double operator()(double t, bool backwards) const { return backwards ? back(t) : forward(t); }
};

/// The modulus of the disk less the segment from 0 to r, times π/2.
double groetzsch(double r) {
    return 0.25 * kTurn * complete_elliptic(std::sqrt(1 - r * r)) / complete_elliptic(r);
}

double hyperbolic(Complex a, Complex b) {
    return std::abs((a - b) / (1.0 - std::conj(a) * b));
}

}  // namespace

MixedProblemCase sliding_inner_circle(double h) {
    const double r = 0.5, alpha = 0.2;
    DomainOptions options;
    options.edge_length = h;
    options.hole_edge_length = 0.4 * h;
    MixedProblemCase result{
        "ring, outer circle prescribed, inner one slides", circle_domain({}, {{{0, 0}, r}}, options), {}};
    const auto f = [=](Complex z) {
        const Complex w = std::log(z) + alpha * (z / r - r / z);
        return std::exp(Complex(2 * w.real(), w.imag()));
    };
    result.exact = values(result.mesh, f);
    result.exact_k = 1.0 / 3;
    const auto loops = topology(result.mesh).boundary_loops;
    for (const int v : loops[0]) result.conditions.prescribed.pin(v, (*result.exact)[v]);
    result.conditions.curves = {std::nullopt, TargetCurve::circle(0, r * r)};
    return result;
}

MixedProblemCase two_sliding_holes(double h, bool back, bool pinned) {
    const std::vector<RoundHoleOf> one{{{-0.4, 0.1}, 0.2}, {0.35, 0.25}}, two{{{-0.5, -0.2}, 0.15}, {{0.3, 0.3}, 0.3}};
    const auto &from = back ? two : one, &to = back ? one : two;
    const CircleMotion motion{0.4, 0.5};
    const std::array<Complex, 2> pin{Complex(-0.05, -0.55), Complex(0.1, -0.45)};
    MixedProblemCase result{"two holes slide, outer circle prescribed", {}, {}};
    result.mesh = graded_disk(h, pinned ? std::vector<Complex>{pin[back]} : std::vector<Complex>{}, {}, from);
    if (pinned) result.conditions.prescribed.pin(0, pin[!back]);
    const auto loops = topology(result.mesh).boundary_loops;
    for (const auto& loop : loops) {
        const Complex z = place(result.mesh, loop[0]);
        if (std::abs(z) > 1 - 1e-9) {
            for (const int v : loop)
                result.conditions.prescribed.pin(v, std::polar(1.0, motion(std::arg(place(result.mesh, v)), back)));
            result.conditions.curves.emplace_back();
            continue;
        }
        const int hole = std::abs(z - from[0].centre) < from[0].radius + 1e-9 ? 0 : 1;
        result.conditions.curves.emplace_back(TargetCurve::circle(to[hole].centre, to[hole].radius));
    }
    return result;
}

MixedProblemCase pins_in_sliding_disk(double h, int pins, bool back) {
    std::vector<Complex> from, to;
    if (pins == 2) {
        from = {{-0.3, 0.1}, 0.4};
        to = {-0.5, {0.5, 0.1}};
    } else if (pins == 3) {
        from = {0.5, {-0.2, 0.4}, {-0.3, -0.4}};
        to = {{0.4, 0.2}, {-0.2, 0.5}, {-0.1, -0.3}};
    } else {
        from = {0.6, {0.1, 0.5}, {-0.5, 0.3}, {-0.4, -0.4}, {0.2, -0.5}};
        to = {{0.5, 0.2}, {0, 0.6}, {-0.5, 0.1}, {-0.3, -0.4}, {0.3, -0.4}};
    }
    if (back) std::swap(from, to);
    MixedProblemCase result{std::to_string(from.size()) + " pins in a sliding disk", graded_disk(h, from, {}), {}};
    for (std::size_t i = 0; i < from.size(); ++i) result.conditions.prescribed.pin(static_cast<int>(i), to[i]);
    result.conditions.curves = {TargetCurve::circle(0, 1)};
    if (pins == 2) {
        const double ratio = groetzsch(hyperbolic(from[0], from[1])) / groetzsch(hyperbolic(to[0], to[1]));
        const double K = std::max(ratio, 1 / ratio);
        result.exact_k = (K - 1) / (K + 1);
    }
    return result;
}

MixedProblemCase two_sliding_sides(double h) {
    MixedProblemCase result{"square, two sides prescribed, two slide",
                            polygon_domain({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {}, {.edge_length = h}),
                            {}};
    const auto f = [](Complex z) {
        const Complex w = z + 0.04 / std::numbers::pi * std::sinh(std::numbers::pi * z);
        return Complex(2 * w.real(), w.imag());
    };
    result.exact = values(result.mesh, f);
    result.exact_k = 1.0 / 3;
    const auto loops = topology(result.mesh).boundary_loops;
    for (const int v : loops[0]) {
        const double x = place(result.mesh, v).real();
        if (x < 1e-12 || x > 1 - 1e-12) result.conditions.prescribed.pin(v, (*result.exact)[v]);
    }
    result.conditions.curves = {polygon_through(result.mesh, loops[0], result.conditions.prescribed)};
    return result;
}

MixedProblemCase sliding_half_circle(double h) {
    MixedProblemCase result{
        "upper half circle slides, lower prescribed", graded_disk(h, {}, {0, std::numbers::pi}), {}};
    const auto f = [](Complex z) {
        Complex t;
        if (std::abs(z - 1.0) < 1e-12) {
            t = 1;
        } else {
            Complex w = kI * (1.0 + z) / (1.0 - z);  // the upper half plane
            if (std::abs(z) > 1 - 1e-12) w = Complex(w.real(), 0.0);
            const Complex s = std::sqrt(w);
            t = (s - kI) / (s + kI);
        }
        const Complex zeta = t + 0.2 * t * t, w = Complex(2 * zeta.real(), zeta.imag());
        return std::sin(0.25 * kTurn * (w - 0.4) / 2.0);  // w runs from −1.6 to 2.4 on the diameter
    };
    result.exact = values(result.mesh, f);
    result.exact_k = 1.0 / 3;
    const auto loops = topology(result.mesh).boundary_loops;
    for (const int v : loops[0])
        if (place(result.mesh, v).imag() < 1e-12) result.conditions.prescribed.pin(v, (*result.exact)[v]);
    result.conditions.curves = {polygon_through(result.mesh, loops[0], result.conditions.prescribed)};
    return result;
}

MixedProblemCase two_prescribed_arcs(double h, bool back, bool pinned) {
    const CircleMotion motion{0.3, 0.4};
    std::array<double, 4> ends{0.3, 1.5, 2.5, 4.4};
    if (back)
        for (double& t : ends) t = motion.forward(t);
    const std::array<Complex, 2> pin{Complex(-0.2, 0.1), Complex(0.05, -0.1)};
    MixedProblemCase result{"two arcs of the disk prescribed", {}, {}};
    result.mesh =
        graded_disk(h, pinned ? std::vector<Complex>{pin[back]} : std::vector<Complex>{}, {ends.begin(), ends.end()});
    if (pinned) result.conditions.prescribed.pin(0, pin[!back]);
    const auto loops = topology(result.mesh).boundary_loops;
    for (const int v : loops[0]) {
        double t = std::arg(place(result.mesh, v));
        if (t < 0) t += kTurn;
        const auto within = [&](double a, double b) { return t > a - 1e-9 && t < b + 1e-9; };
        if (within(ends[0], ends[1]) || within(ends[2], ends[3]))
            result.conditions.prescribed.pin(v, std::polar(1.0, motion(t, back)));
    }
    result.conditions.curves = {TargetCurve::circle(0, 1)};
    return result;
}

}  // namespace beltrami::bench
