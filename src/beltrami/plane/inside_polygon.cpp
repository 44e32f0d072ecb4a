#include <beltrami/plane/inside_polygon.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <beltrami/plane/polygon.h>

namespace beltrami {

namespace {

/// Lines tried where the centre of the area lies outside.
constexpr int kLines = 64;

Complex mean(const std::vector<Complex>& points) {
    Complex sum = 0;
    for (const Complex p : points) sum += p - points[0];
    return points[0] + sum / static_cast<double>(points.size());
}

/// Centre of the enclosed area; relative to the first point, so that a place far from the origin costs no digits.
Complex area_centre(const std::vector<Complex>& polygon, double area) {
    Complex sum = 0;
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
        sum += signed_area(polygon[0], polygon[i], polygon[i + 1]) *
               ((polygon[i] - polygon[0]) + (polygon[i + 1] - polygon[0])) / 3.0;
    return polygon[0] + sum / area;
}

double distance_to(const std::vector<Complex>& polygon, Complex point) {
    double least = std::abs(polygon[0] - point);
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Complex a = polygon[i], along = polygon[(i + 1) % polygon.size()] - a;
        const double square = std::norm(along);
        const double t = square > 0 ? std::clamp(std::real(std::conj(along) * (point - a)) / square, 0.0, 1.0) : 0.0;
        least = std::min(least, std::abs(a + t * along - point));
    }
    return least;
}

}  // namespace

double turning_angle(const std::vector<Complex>& chain, Complex centre) {
    double sum = 0;
    for (std::size_t i = 0; i + 1 < chain.size(); ++i) sum += std::arg((chain[i + 1] - centre) / (chain[i] - centre));
    return sum;
}

int winding_number(const std::vector<Complex>& polygon, Complex point) {
    if (polygon.empty()) return 0;
    const double sum = turning_angle(polygon, point) + std::arg((polygon.front() - point) / (polygon.back() - point));
    return static_cast<int>(std::lround(sum / (2 * std::numbers::pi)));
}

Complex point_inside(const std::vector<Complex>& polygon) {
    if (polygon.empty()) return 0;
    const double area = signed_area(polygon);
    double low = polygon[0].imag(), high = low, left = polygon[0].real(), right = left;
    for (const Complex p : polygon) {
        low = std::min(low, p.imag()), high = std::max(high, p.imag());
        left = std::min(left, p.real()), right = std::max(right, p.real());
    }
    const double size = std::max(high - low, right - left);
    if (!(std::abs(area) > 1e-14 * size * size)) return mean(polygon);
    const Complex centre = area_centre(polygon, area);
    if (distance_to(polygon, centre) > 1e-3 * size && winding_number(polygon, centre) != 0) return centre;

    Complex best = mean(polygon);
    double longest = 0;
    for (int line = 0; line < kLines; ++line) {
        const double y = low + (high - low) * (line + 0.5) / kLines;
        std::vector<double> crossings;
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            const Complex a = polygon[i], b = polygon[(i + 1) % polygon.size()];
            if ((a.imag() > y) == (b.imag() > y)) continue;
            crossings.push_back(a.real() + (b.real() - a.real()) * (y - a.imag()) / (b.imag() - a.imag()));
        }
        std::sort(crossings.begin(), crossings.end());
        for (std::size_t i = 0; i + 1 < crossings.size(); ++i) {
            const double length = crossings[i + 1] - crossings[i];
            const Complex middle(0.5 * (crossings[i] + crossings[i + 1]), y);
            if (length > longest && winding_number(polygon, middle) != 0) longest = length, best = middle;
        }
    }
    return best;
}

}  // namespace beltrami
