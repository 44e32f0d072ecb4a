#include <beltrami/applications/fitting_grid.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>

#include <beltrami/base/error.h>

namespace beltrami {

namespace {

/// Centres and right angles agree to this part of the domain.
constexpr double kEqual = 1e-9;

bool is_circle(const TargetCurve& curve) {
    return curve.kind() == TargetCurve::Kind::circle;
}

/// The hole of a ring between two circles of one centre.
const TargetCurve* hole_of_ring(const TargetDomain& domain) {
    if (domain.holes.size() != 1 || !is_circle(domain.outer) || !is_circle(domain.holes[0])) return nullptr;
    const bool same = std::abs(domain.holes[0].centre() - domain.outer.centre()) <= kEqual * domain.outer.radius();
    return same ? &domain.holes[0] : nullptr;
}

/// A corner and the two sides from it, the second counter-clockwise from the first.
struct Rectangle {
    Complex corner, along, up;
};

std::optional<Rectangle> rectangle(const TargetCurve& outer) {
    const std::vector<double> at = outer.corners();
    if (outer.kind() != TargetCurve::Kind::polygon || at.size() != 4) return {};
    const Complex a = outer.point(at[0]), along = outer.point(at[1]) - a, up = outer.point(at[3]) - a,
                  across = outer.point(at[2]) - a;
    const double size = std::abs(across);
    if (std::abs(along + up - across) > kEqual * size ||
        std::abs(std::real(std::conj(along) * up)) > kEqual * std::abs(along) * std::abs(up))
        return {};
    return Rectangle{a, along, up};
}

Rectangle box(const TargetCurve& outer) {
    constexpr int kPlaces = 1024;
    double left = std::numeric_limits<double>::infinity(), low = left, right = -left, high = -left;
    const auto include = [&](Complex p) {
        left = std::min(left, p.real()), right = std::max(right, p.real());
        low = std::min(low, p.imag()), high = std::max(high, p.imag());
    };
    if (is_circle(outer)) {
        include(outer.centre() - outer.radius() * Complex(1, 1));
        include(outer.centre() + outer.radius() * Complex(1, 1));
    } else {
        for (const Complex p : outer.points()) include(p);
        for (int i = 0; i < kPlaces; ++i) include(outer.point(outer.length() * i / kPlaces));
    }
    return {{left, low}, right - left, Complex(0, high - low)};
}

RectangularGrid rectangular(const TargetDomain& domain, int cells) {
    const Rectangle sides = rectangle(domain.outer).value_or(box(domain.outer));
    const double width = std::abs(sides.along), height = std::abs(sides.up), edge = std::max(width, height) / cells;
    RectangularGrid grid;
    grid.spacing = width / std::max(1.0, std::round(width / edge));
    grid.spacing_up = height / std::max(1.0, std::round(height / edge));
    grid.origin = sides.corner;
    grid.angle = std::arg(sides.along);
    return grid;
}

}  // namespace

const char* to_string(GridLines lines) {
    switch (lines) {
        case GridLines::automatic:
            return "automatic";
        case GridLines::rectangular:
            return "rectangular";
        case GridLines::polar:
            return "polar";
        case GridLines::log_polar:
            return "log-polar";
    }
    return "";
}

PlaneGrid fitting_grid(const TargetDomain& domain, int cells, GridLines lines) {
    const TargetCurve* ring = hole_of_ring(domain);
    if (lines == GridLines::automatic) lines = ring ? GridLines::log_polar : GridLines::rectangular;
    if (cells < (lines == GridLines::rectangular ? 1 : 3))
        throw Error(Cause::bad_option, "a grid of " + std::to_string(cells) + " cells is none",
                    lines == GridLines::rectangular ? "give at least 1" : "give at least 3 around");
    if (lines == GridLines::rectangular) return rectangular(domain, cells);
    if (!is_circle(domain.outer))
        throw Error(Cause::bad_option, std::string(to_string(lines)) + " lines need an outer curve that is a circle",
                    "choose rectangular lines");
    const Complex centre = domain.outer.centre();
    const double radius = domain.outer.radius();
    if (lines == GridLines::polar) {
        const double circles = std::max(1.0, std::round(cells / (2 * std::numbers::pi)));
        return PolarGrid{.centre = centre, .spacing = radius / circles, .sectors = cells};
    }
    if (ring)
        return LogPolarGrid{
            .centre = ring->centre(), .inner_radius = ring->radius(), .outer_radius = radius, .sectors = cells};
    if (std::none_of(domain.holes.begin(), domain.holes.end(),
                     [&](const TargetCurve& hole) { return hole.contains(centre); }))
        throw Error(Cause::bad_option, "log-polar lines need a hole at the centre of the outer circle",
                    "choose polar or rectangular lines");
    return LogPolarGrid{.centre = centre, .inner_radius = radius, .sectors = cells};
}

GridLines lines_of(const PlaneGrid& grid) {
    if (std::holds_alternative<RectangularGrid>(grid)) return GridLines::rectangular;
    return std::holds_alternative<PolarGrid>(grid) ? GridLines::polar : GridLines::log_polar;
}

}  // namespace beltrami
