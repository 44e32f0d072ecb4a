#include <beltrami/charts/hole_centre.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <beltrami/plane/circle_fit.h>
#include <beltrami/plane/polygon.h>

namespace beltrami {

namespace {

constexpr double kNearlyRound = 1.2;

/// Distance from the sides, negative outside.
double depth(const std::vector<Complex>& polygon, Complex p) {
    double nearest = std::numeric_limits<double>::infinity();
    bool inside = false;
    Complex a = polygon.back() - p;
    for (const Complex corner : polygon) {
        const Complex b = corner - p, side = b - a;
        const double length = std::norm(side);
        const double t = length > 0 ? std::clamp(-std::real(std::conj(side) * a) / length, 0.0, 1.0) : 0;
        nearest = std::min(nearest, std::norm(a + t * side));
        if ((a.imag() > 0) != (b.imag() > 0) && a.real() - a.imag() * side.real() / side.imag() > 0) inside = !inside;
        a = b;
    }
    return inside ? std::sqrt(nearest) : -std::sqrt(nearest);
}

/// Centre of the polygon's area.
Complex area_centre(const std::vector<Complex>& polygon) {
    Complex moment = 0;
    double total = 0;
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
        const double area = signed_area(polygon[0], polygon[i], polygon[i + 1]);
        moment += area / 3 * ((polygon[i] - polygon[0]) + (polygon[i + 1] - polygon[0]));
        total += area;
    }
    return polygon[0] + (total != 0 ? moment / total : 0);
}

/// Grids that are searched, each a fifth of the one before.
constexpr int kLevels = 5;

/// Grid search with shrinking cells, in a frame tied to the polygon.
Complex deepest(const std::vector<Complex>& polygon, Complex start) {
    Complex axis = 0;
    for (const Complex z : polygon)
        if (std::abs(z - start) > std::abs(axis)) axis = z - start;
    Complex best = start;
    if (axis == 0.0) return best;
    double best_depth = depth(polygon, start), half = std::abs(axis);
    for (int level = 0; level < kLevels; ++level, half *= 0.2) {
        const Complex middle = best, step = axis / std::abs(axis) * (half / 8);
        for (int i = -8; i <= 8; ++i)
            for (int j = -8; j <= 8; ++j) {
                const Complex p = middle + step * Complex(i, j);
                const double d = depth(polygon, p);
                if (d > best_depth) {
                    best_depth = d;
                    best = p;
                }
            }
    }
    return best;
}

struct Distances {
    double smallest, mean, largest;
};

Distances distances(const std::vector<Complex>& polygon, Complex centre) {
    Distances d{std::numeric_limits<double>::infinity(), 0, 0};
    for (const Complex z : polygon) {
        const double r = std::abs(z - centre);
        d.smallest = std::min(d.smallest, r);
        d.mean += r / static_cast<double>(polygon.size());
        d.largest = std::max(d.largest, r);
    }
    return d;
}

}  // namespace

HoleCentre hole_centre(const std::vector<Complex>& polygon) {
    const CircleFit circle = fit_circle(polygon);
    if (circle.ratio() <= kNearlyRound && depth(polygon, circle.centre) > 0)
        return {circle.centre, circle.radius, circle.ratio()};
    HoleCentre result;
    result.centre = area_centre(polygon);
    Distances d = distances(polygon, result.centre);
    if (!(depth(polygon, result.centre) > 0.4 * d.mean)) {
        result.centre = deepest(polygon, result.centre);
        d = distances(polygon, result.centre);
    }
    result.radius = std::min(d.mean, 2 * d.smallest);
    result.ratio = d.smallest > 0 ? d.largest / d.smallest : std::numeric_limits<double>::infinity();
    return result;
}

}  // namespace beltrami
