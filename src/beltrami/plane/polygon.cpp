#include <beltrami/plane/polygon.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include <beltrami/base/error.h>

namespace beltrami {

namespace {

bool within(Complex a, Complex b, Complex p) {
    return std::min(a.real(), b.real()) <= p.real() && p.real() <= std::max(a.real(), b.real()) &&
           std::min(a.imag(), b.imag()) <= p.imag() && p.imag() <= std::max(a.imag(), b.imag());
}

/// Whether two closed segments have a point in common.
bool segments_meet(Complex a, Complex b, Complex c, Complex d) {
    const double c_side = signed_area(a, b, c), d_side = signed_area(a, b, d);
    const double a_side = signed_area(c, d, a), b_side = signed_area(c, d, b);
    if (((c_side > 0 && d_side < 0) || (c_side < 0 && d_side > 0)) &&
        ((a_side > 0 && b_side < 0) || (a_side < 0 && b_side > 0)))
        return true;
    return (c_side == 0 && within(a, b, c)) || (d_side == 0 && within(a, b, d)) || (a_side == 0 && within(c, d, a)) ||
           (b_side == 0 && within(c, d, b));
}

}  // namespace

double signed_area(const std::vector<Complex>& polygon) {
    double area = 0;
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i) area += signed_area(polygon[0], polygon[i], polygon[i + 1]);
    return area;
}

void require_simple_polygon(const std::vector<Complex>& polygon) {
    const int n = static_cast<int>(polygon.size());
    if (n < 3)
        throw Error(Cause::bad_boundary, "the polygon has only " + std::to_string(n) + " points",
                    "give at least three, a line `x y` each");
    for (int i = 0; i < n; ++i)
        if (polygon[i] == polygon[(i + 1) % n])
            throw Error(
                Cause::bad_boundary,
                "points " + std::to_string(i) + " and " + std::to_string((i + 1) % n) + " of the polygon coincide",
                "list every point once; the polygon closes by itself", {Things::points, {i, (i + 1) % n}});
    if (!(signed_area(polygon) > 0))
        throw Error(Cause::bad_boundary, "the polygon is clockwise or has no area",
                    "list its points counter-clockwise");
    // Edges sorted by their left end: only those that overlap in x are compared.
    std::vector<int> order(n);
    std::iota(order.begin(), order.end(), 0);
    const auto left = [&](int e) { return std::min(polygon[e].real(), polygon[(e + 1) % n].real()); };
    const auto right = [&](int e) { return std::max(polygon[e].real(), polygon[(e + 1) % n].real()); };
    std::sort(order.begin(), order.end(), [&](int a, int b) { return left(a) != left(b) ? left(a) < left(b) : a < b; });
    for (int i = 0; i < n; ++i)
        for (int j = i + 1; j < n && left(order[j]) <= right(order[i]); ++j) {
            const int e = std::min(order[i], order[j]), f = std::max(order[i], order[j]);
            const Complex a = polygon[e], b = polygon[(e + 1) % n], c = polygon[f], d = polygon[(f + 1) % n];
            bool meet;
            if (f == e + 1) {
                meet = signed_area(a, b, d) == 0 && std::real(std::conj(b - a) * (d - b)) < 0;  // turning straight back
            } else if (e == 0 && f == n - 1) {
                meet = signed_area(a, b, c) == 0 && std::real(std::conj(b - a) * (c - a)) > 0;
            } else {
                meet = segments_meet(a, b, c, d);
            }
            if (meet)
                throw Error(Cause::bad_boundary,
                            "edges " + std::to_string(e) + " and " + std::to_string(f) +
                                " of the polygon meet: it is not simple",
                            "an edge is counted by its first point, from 0", {Things::points, {e, f}});
        }
}

}  // namespace beltrami
