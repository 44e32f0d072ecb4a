#include <beltrami/plane/predicates.h>

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

// Both predicates evaluate in double first and accept the sign if it exceeds a bound of the rounding error; otherwise
// they evaluate exactly with expansions: unevaluated sums of doubles whose bits do not overlap (Shewchuk, "Adaptive
// precision floating-point arithmetic and fast robust geometric predicates", 1997; the bounds are his "A" bounds).

namespace beltrami {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon() / 2.0;
constexpr double orient_bound = (3.0 + 16.0 * epsilon) * epsilon;
constexpr double incircle_bound = (10.0 + 96.0 * epsilon) * epsilon;

/// Components in order of increasing magnitude, none of them zero; empty is zero.
using Expansion = std::vector<double>;

/// a + b as rounded sum and exact rest.
std::pair<double, double> two_sum(double a, double b) {
    const double sum = a + b;
    const double virtual_b = sum - a;
    return {sum, (a - (sum - virtual_b)) + (b - virtual_b)};
}

std::pair<double, double> two_product(double a, double b) {
    const double product = a * b;
    return {product, std::fma(a, b, -product)};
}

void append(Expansion& e, double component) {
    if (component != 0.0) e.push_back(component);
}

Expansion difference(double a, double b) {
    const auto [sum, rest] = two_sum(a, -b);
    Expansion e;
    append(e, rest);
    append(e, sum);
    return e;
}

Expansion sum(const Expansion& e, const Expansion& f) {
    Expansion result;
    result.reserve(e.size() + f.size());
    double carry = 0.0;
    for (std::size_t i = 0, j = 0; i < e.size() || j < f.size();) {
        const bool from_e = j == f.size() || (i < e.size() && std::abs(e[i]) < std::abs(f[j]));
        const auto [next, rest] = two_sum(carry, from_e ? e[i++] : f[j++]);
        append(result, rest);
        carry = next;
    }
    append(result, carry);
    return result;
}

Expansion scaled(const Expansion& e, double factor) {
    Expansion result;
    result.reserve(2 * e.size());
    double carry = 0.0;
    for (const double component : e) {
        const auto [high, low] = two_product(component, factor);
        const auto [middle, rest] = two_sum(carry, low);
        append(result, rest);
        const auto [next, next_rest] = two_sum(high, middle);
        append(result, next_rest);
        carry = next;
    }
    append(result, carry);
    return result;
}

Expansion product(const Expansion& e, const Expansion& f) {
    Expansion result;
    for (const double component : f) result = sum(result, scaled(e, component));
    return result;
}

Expansion negative(Expansion e) {
    for (double& component : e) component = -component;
    return e;
}

/// The largest component carries the sign.
double estimate(const Expansion& e) {
    return e.empty() ? 0.0 : e.back();
}

double orient2d_exact(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
    const Expansion left = product(difference(a.x(), c.x()), difference(b.y(), c.y()));
    const Expansion right = product(difference(a.y(), c.y()), difference(b.x(), c.x()));
    return estimate(sum(left, negative(right)));
}

double incircle_exact(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
                      const Eigen::Vector2d& d) {
    const Expansion ax = difference(a.x(), d.x()), ay = difference(a.y(), d.y());
    const Expansion bx = difference(b.x(), d.x()), by = difference(b.y(), d.y());
    const Expansion cx = difference(c.x(), d.x()), cy = difference(c.y(), d.y());
    const auto cross = [](const Expansion& px, const Expansion& py, const Expansion& qx, const Expansion& qy) {
        return sum(product(px, qy), negative(product(py, qx)));
    };
    const auto lift = [](const Expansion& x, const Expansion& y) { return sum(product(x, x), product(y, y)); };
    return estimate(sum(sum(product(cross(bx, by, cx, cy), lift(ax, ay)), product(cross(cx, cy, ax, ay), lift(bx, by))),
                        product(cross(ax, ay, bx, by), lift(cx, cy))));
}

}  // namespace

double orient2d(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
    const double left = (a.x() - c.x()) * (b.y() - c.y());
    const double right = (a.y() - c.y()) * (b.x() - c.x());
    const double determinant = left - right;
    if (std::abs(determinant) > orient_bound * (std::abs(left) + std::abs(right))) return determinant;
    return orient2d_exact(a, b, c);
}

double incircle(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
                const Eigen::Vector2d& d) {
    const double ax = a.x() - d.x(), ay = a.y() - d.y();
    const double bx = b.x() - d.x(), by = b.y() - d.y();
    const double cx = c.x() - d.x(), cy = c.y() - d.y();
    const double lift_a = ax * ax + ay * ay, lift_b = bx * bx + by * by, lift_c = cx * cx + cy * cy;
    const double determinant =
        lift_a * (bx * cy - by * cx) + lift_b * (cx * ay - cy * ax) + lift_c * (ax * by - ay * bx);
    const double permanent = lift_a * (std::abs(bx * cy) + std::abs(by * cx)) +
                             lift_b * (std::abs(cx * ay) + std::abs(cy * ax)) +
                             lift_c * (std::abs(ax * by) + std::abs(ay * bx));
    if (std::abs(determinant) > incircle_bound * permanent) return determinant;
    return incircle_exact(a, b, c, d);
}

}  // namespace beltrami
