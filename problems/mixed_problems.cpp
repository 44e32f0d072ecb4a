#include "problems/mixed_problems.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <beltrami/base/constants.h>
#include <beltrami/charts/boundary_values.h>
#include <beltrami/charts/circle_domain_chart.h>

#include "problems/construct.h"
#include "problems/elliptic.h"
#include "problems/graded_domain.h"

namespace beltrami::bench {

namespace {

/// Edges at the hole of a ring, as part of the others.
constexpr double kHoleEdge = 0.4;

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

/// The affine map of K = 2 that the exact maps are made of, and back.
Complex stretched(Complex w) {
    return {2 * w.real(), w.imag()};
}
Complex shrunk(Complex w) {
    return {w.real() / 2, w.imag()};
}

/// A zero of a holomorphic function by Newton's method.
Complex inverted(Complex start, const PlaneMap& function, const PlaneMap& derivative) {
    Complex z = start;
    for (int i = 0; i < 50; ++i) {
        const Complex step = function(z) / derivative(z);
        z -= step;
        if (std::abs(step) < 1e-15) break;
    }
    return z;
}

std::vector<Complex> on_circle(const std::array<double, 4>& angles) {
    std::vector<Complex> result;
    for (const double t : angles) result.push_back(std::polar(1.0, t));
    return result;
}

}  // namespace

MixedProblemCase sliding_inner_circle(double h, bool back) {
    const double r = 0.5, alpha = 0.2;
    const auto f = [=](Complex z) { return std::exp(stretched(std::log(z) + alpha * (z / r - r / z))); };
    const auto inverse = [=](Complex p) {
        // Of e^w, whose logarithm near 0 has no branch.
        const Complex at = std::exp(shrunk(std::log(p)));
        return inverted(
            at, [=](Complex z) { return std::log(z * std::exp(alpha * (z / r - r / z)) / at); },
            [=](Complex z) { return 1.0 / z + alpha * (1 / r + r / (z * z)); });
    };
    MixedProblemCase result{"ring, outer circle prescribed, inner one slides", {}, {}};
    result.exact_k = 1.0 / 3;
    const double hole = back ? r * r : r;
    if (back) {
        const OuterCurve outer{[=](double t) { return f(std::polar(1.0, kTurn * t)); }};
        result.mesh = graded_mesh(h, outer, {{}, {}, {{0, hole}}, kHoleEdge});
        result.exact = values(result.mesh, inverse);
    } else {
        DomainOptions options;
        options.edge_length = h;
        options.hole_edge_length = kHoleEdge * h;
        result.mesh = circle_domain({}, {{{0, 0}, r}}, options);
        result.exact = values(result.mesh, f);
    }
    for (const auto& loop : topology(result.mesh).boundary_loops) {
        const bool slides = std::abs(place(result.mesh, loop[0])) < hole + 1e-9;
        result.conditions.curves.emplace_back();
        if (slides) result.conditions.curves.back() = TargetCurve::circle(0, back ? r : r * r);
        if (!slides)
            for (const int v : loop) result.conditions.prescribed.pin(v, (*result.exact)[v]);
    }
    return result;
}

MixedProblemCase two_sliding_holes(double h, bool back, bool pinned) {
    const std::vector<RoundHoleOf> one{{{-0.4, 0.1}, 0.2}, {0.35, 0.25}}, two{{{-0.5, -0.2}, 0.15}, {{0.3, 0.3}, 0.3}};
    const auto &from = back ? two : one, &to = back ? one : two;
    const CircleMotion motion{0.4, 0.5};
    const std::array<Complex, 2> pin{Complex(-0.05, -0.55), Complex(0.1, -0.45)};
    MixedProblemCase result{
        pinned ? "two holes slide, outer circle prescribed, a pin inside" : "two holes slide, outer circle prescribed",
        {},
        {}};
    result.mesh =
        graded_mesh(h, unit_circle(), {pinned ? std::vector<Complex>{pin[back]} : std::vector<Complex>{}, {}, from});
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
    MixedProblemCase result{
        std::to_string(from.size()) + " pins in a sliding disk", graded_mesh(h, unit_circle(), {from, {}, {}}), {}};
    for (std::size_t i = 0; i < from.size(); ++i) result.conditions.prescribed.pin(static_cast<int>(i), to[i]);
    result.conditions.curves = {TargetCurve::circle(0, 1)};
    if (pins == 2) {
        const double ratio = groetzsch(hyperbolic(from[0], from[1])) / groetzsch(hyperbolic(to[0], to[1]));
        const double K = std::max(ratio, 1 / ratio);
        result.exact_k = k_of(K);
    }
    return result;
}

MixedProblemCase two_sliding_sides(double h, bool back) {
    const auto inner = [](Complex z) { return z + 0.04 / std::numbers::pi * std::sinh(std::numbers::pi * z); };
    const auto f = [=](Complex z) { return stretched(inner(z)); };
    const auto inverse = [=](Complex p) {
        const Complex w = shrunk(p);
        return inverted(
            w, [=](Complex z) { return inner(z) - w; },
            [](Complex z) { return 1.0 + 0.04 * std::cosh(std::numbers::pi * z); });
    };
    MixedProblemCase result{"square, two sides prescribed, two slide", {}, {}};
    result.exact_k = 1.0 / 3;
    const std::array<Complex, 4> corners{Complex(0, 0), Complex(1, 0), Complex(1, 1), Complex(0, 1)};
    const auto around = [=](double t) {
        const auto side = static_cast<std::size_t>(std::clamp(std::floor(4 * t), 0.0, 3.0));
        return corners[side] + (4 * t - static_cast<double>(side)) * (corners[(side + 1) % 4] - corners[side]);
    };
    if (back) {
        result.mesh = graded_mesh(h, {[=](double t) { return f(around(t)); }, {0, 0.25, 0.5, 0.75}}, {});
        result.exact = values(result.mesh, inverse);
    } else {
        result.mesh = polygon_domain({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {}, {.edge_length = h});
        result.exact = values(result.mesh, f);
    }
    const auto loops = topology(result.mesh).boundary_loops;
    for (const int v : loops[0]) {
        const double x = (back ? (*result.exact)[v] : place(result.mesh, v)).real();
        if (x < 1e-9 || x > 1 - 1e-9) result.conditions.prescribed.pin(v, (*result.exact)[v]);
    }
    result.conditions.curves = {polygon_through(result.mesh, loops[0], result.conditions.prescribed)};
    return result;
}

namespace {

/// The upper half plane to the disk's, 0 to −1 and ∞ to 1; its square root takes the upper half of the circle to the
/// diameter of the upper half disk.
Complex opened_half_disk(Complex z) {
    if (std::abs(z - 1.0) < 1e-14) return 1;
    Complex w = kI * (1.0 + z) / (1.0 - z);
    if (std::abs(z) > 1 - 1e-12) w = Complex(w.real(), 0.0);
    const Complex s = std::sqrt(w);
    return (s - kI) / (s + kI);
}
Complex closed_half_disk(Complex t) {
    if (std::abs(t - 1.0) < 1e-14) return 1;
    const Complex s = kI * (1.0 + t) / (1.0 - t), w = s * s;
    return (w - kI) / (w + kI);
}

}  // namespace

MixedProblemCase sliding_half_circle(double h, bool back) {
    // Along the diameter 2 Re (t + .2 t²) runs from −1.6 to 2.4.
    const double bend = 0.2, middle = 0.4, half = 2;
    const auto f = [=](Complex z) {
        const Complex t = opened_half_disk(z);
        return std::sin(0.25 * kTurn * (stretched(t + bend * t * t) - middle) / half);
    };
    const auto inverse = [=](Complex p) {
        if (std::abs(p * p - 1.0) < 1e-14) return Complex(p.real(), 0.0);
        const Complex zeta = shrunk(half * std::asin(p) / (0.25 * kTurn) + middle);
        const Complex t = (std::sqrt(1.0 + 4 * bend * zeta) - 1.0) / (2 * bend);
        return closed_half_disk(t);
    };
    MixedProblemCase result{"upper half circle slides, lower prescribed", {}, {}};
    result.exact_k = 1.0 / 3;
    const OuterCurve circle = unit_circle({0, std::numbers::pi});
    const GradedPlaces fine{{}, {1, -1}, {}};
    if (back) {
        result.mesh = graded_mesh(h, {[=](double t) { return f(circle.at(t)); }, circle.ends}, fine);
        result.exact = values(result.mesh, inverse);
    } else {
        result.mesh = graded_mesh(h, circle, fine);
        result.exact = values(result.mesh, f);
    }
    const auto loops = topology(result.mesh).boundary_loops;
    const Eigen::VectorXcd& image = *result.exact;
    for (const int v : loops[0]) {
        const Complex on_disk = back ? image[v] : place(result.mesh, v);
        if (on_disk.imag() < 1e-12) result.conditions.prescribed.pin(v, image[v]);
    }
    result.conditions.curves = {back ? TargetCurve::circle(0, 1)
                                     : polygon_through(result.mesh, loops[0], result.conditions.prescribed)};
    return result;
}

MixedProblemCase two_prescribed_arcs(double h, bool back, bool pinned) {
    const CircleMotion motion{0.3, 0.4};
    std::array<double, 4> ends{0.3, 1.5, 2.5, 4.4};
    if (back)
        for (double& t : ends) t = motion.forward(t);
    const std::array<Complex, 2> pin{Complex(-0.2, 0.1), Complex(0.05, -0.1)};
    MixedProblemCase result{
        pinned ? "two arcs of the disk prescribed, a pin inside" : "two arcs of the disk prescribed", {}, {}};
    result.mesh = graded_mesh(h, unit_circle({ends.begin(), ends.end()}),
                              {pinned ? std::vector<Complex>{pin[back]} : std::vector<Complex>{}, on_circle(ends), {}});
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

namespace {

/// Angles along a circle that go to others, both ascending, once around: piecewise linear between.
class CircleCorrespondence {
  public:
    CircleCorrespondence(std::vector<double> from, std::vector<double> to)
        : from_(std::move(from)), to_(std::move(to)) {
        for (std::vector<double>* angles : {&from_, &to_}) {
            for (std::size_t i = 1; i < angles->size(); ++i)
                (*angles)[i] = (*angles)[i - 1] + positive((*angles)[i] - (*angles)[i - 1]);
            angles->push_back((*angles)[0] + kTurn);
        }
    }
    double operator()(double t) const {
        t = from_[0] + positive(t - from_[0]);
        const auto next = std::upper_bound(from_.begin(), from_.end() - 1, t);
        const auto i = static_cast<std::size_t>(next - from_.begin());
        return to_[i - 1] + (t - from_[i - 1]) / (from_[i] - from_[i - 1]) * (to_[i] - to_[i - 1]);
    }

  private:
    static double positive(double t) { return t - kTurn * std::floor(t / kTurn); }
    std::vector<double> from_, to_;
};

}  // namespace

MixedProblemCase sliding_holes_of_face(const Mesh& face, double h, bool back) {
    const Surface source(face);
    const BoundaryCondition outline = boundary_to_disk(source, 0.5);
    const CircleDomainChart domain = circle_domain_chart(source);
    Complex turn = 0;
    std::vector<double> on_chart, on_image;
    for (std::size_t i = 0; i < outline.vertices.size(); ++i) {
        const Complex z = domain.chart.vertices[outline.vertices[i]];
        turn += outline.images[i] * std::conj(z);
        on_chart.push_back(std::arg(z));
        on_image.push_back(std::arg(outline.images[i]));
    }
    turn /= std::abs(turn);
    MixedProblemCase result{"face, outline prescribed (disk:0.5), holes slide", face, {}};
    const auto curves_of = [&](Complex by, const Surface& from, auto hole_of) {
        for (const auto& loop : from.topology.boundary_loops) {
            const std::optional<RoundHole> hole = hole_of(loop);
            result.conditions.curves.emplace_back();
            if (hole) result.conditions.curves.back() = TargetCurve::circle(by * hole->centre, hole->radius);
        }
    };
    if (!back) {
        result.conditions.prescribed = outline;
        curves_of(turn, source, [&](const std::vector<int>& loop) -> std::optional<RoundHole> {
            for (const RoundHole& hole : domain.holes)
                if (source.topology.boundary_loops[hole.loop] == loop) return hole;
            return {};
        });
        return result;
    }
    GradedPlaces fine;
    for (const RoundHole& hole : domain.holes) fine.holes.push_back({turn * hole.centre, hole.radius});
    result.mesh = graded_mesh(h, unit_circle(), fine);
    const CircleCorrespondence angle(on_image, on_chart);
    const Surface image(result.mesh);
    for (const auto& loop : image.topology.boundary_loops)
        for (const int v : loop)
            if (const Complex z = place(result.mesh, v); std::abs(z) > 1 - 1e-9)
                result.conditions.prescribed.pin(v, std::polar(1.0, angle(std::arg(z))));
    curves_of(1, image, [&](const std::vector<int>& loop) -> std::optional<RoundHole> {
        const Complex z = place(result.mesh, loop[0]);
        for (const RoundHole& hole : domain.holes)
            if (std::abs(std::abs(z - turn * hole.centre) - hole.radius) < 1e-9) return hole;
        return {};
    });
    return result;
}

}  // namespace beltrami::bench
