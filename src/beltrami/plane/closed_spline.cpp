#include <beltrami/plane/closed_spline.h>

#include <cmath>
#include <utility>

namespace beltrami::detail {

namespace {

/// Gauss's rule on [−1, 1]: the positive nodes and their weights.
constexpr std::array<double, 4> kNodes{0.18343464249564980494, 0.52553240991632898582, 0.79666647741362673959,
                                       0.96028985649753623168};
constexpr std::array<double, 4> kWeights{0.36268378337836198297, 0.31370664587788728734, 0.22238103445337447054,
                                         0.10122853629037625915};

/// ∫ f over 0 … u.
template <class F>
double integral(double u, const F& f) {
    double sum = 0;
    for (std::size_t i = 0; i < kNodes.size(); ++i)
        sum += kWeights[i] * (f(0.5 * u * (1 - kNodes[i])) + f(0.5 * u * (1 + kNodes[i])));
    return 0.5 * u * sum;
}

/// Solves the cyclic system low_i x_{i−1} + diagonal_i x_i + high_i x_{i+1} = right_i with low_i = high_{i−1}:
/// a tridiagonal one plus a matrix of rank one (Sherman and Morrison).
/// @pre diagonally dominant, at least 3 rows
std::vector<Complex> solve_cyclic(const std::vector<double>& high, std::vector<double> diagonal,
                                  std::vector<Complex> right) {
    const std::size_t n = diagonal.size();
    const double corner = high[n - 1], gamma = -diagonal[0];
    diagonal[0] -= gamma;
    diagonal[n - 1] -= corner * corner / gamma;
    std::vector<double> other(n, 0.0);
    other[0] = gamma, other[n - 1] = corner;
    for (std::size_t i = 1; i < n; ++i) {
        const double factor = high[i - 1] / diagonal[i - 1];
        diagonal[i] -= factor * high[i - 1];
        right[i] -= factor * right[i - 1];
        other[i] -= factor * other[i - 1];
    }
    right[n - 1] /= diagonal[n - 1];
    other[n - 1] /= diagonal[n - 1];
    for (std::size_t i = n - 1; i-- > 0;) {
        right[i] = (right[i] - high[i] * right[i + 1]) / diagonal[i];
        other[i] = (other[i] - high[i] * other[i + 1]) / diagonal[i];
    }
    const double ratio = corner / gamma;
    const Complex factor = (right[0] + ratio * right[n - 1]) / (1 + other[0] + ratio * other[n - 1]);
    for (std::size_t i = 0; i < n; ++i) right[i] -= factor * other[i];
    return right;
}

bool is_even(const Cubic& cubic) {
    const Complex chord = cubic.control[3] - cubic.control[0];
    constexpr double kTangentOf30 = 0.57735026918962576;
    for (int i = 0; i < 3; ++i) {
        const Complex along = std::conj(chord) * (cubic.control[i + 1] - cubic.control[i]);
        if (!(std::abs(along.imag()) < kTangentOf30 * along.real())) return false;
    }
    const auto halves = cubic.halves();
    const double whole = cubic.arc_length(1);
    // What rounding of the coordinates themselves changes.
    const double rounding = 4e-15 * (whole + std::abs(cubic.control[0]));
    return std::abs(halves[0].arc_length(1) + halves[1].arc_length(1) - whole) <= rounding;
}

bool cut(const Cubic& cubic, int depth, std::vector<Cubic>& pieces) {
    if (is_even(cubic)) {
        pieces.push_back(cubic);
        return true;
    }
    if (depth == 40) return false;
    const auto halves = cubic.halves();
    return cut(halves[0], depth + 1, pieces) && cut(halves[1], depth + 1, pieces);
}

}  // namespace

Complex Cubic::point(double u) const {
    const double v = 1 - u;
    return v * v * (v * control[0] + 3 * u * control[1]) + u * u * (3 * v * control[2] + u * control[3]);
}

Complex Cubic::velocity(double u) const {
    const double v = 1 - u;
    return 3.0 * (v * v * (control[1] - control[0]) + 2 * u * v * (control[2] - control[1]) +
                  u * u * (control[3] - control[2]));
}

Complex Cubic::acceleration(double u) const {
    return 6.0 *
           ((1 - u) * (control[2] - 2.0 * control[1] + control[0]) + u * (control[3] - 2.0 * control[2] + control[1]));
}

std::array<Cubic, 2> Cubic::halves() const {
    const Complex a = 0.5 * (control[0] + control[1]), b = 0.5 * (control[1] + control[2]),
                  c = 0.5 * (control[2] + control[3]);
    const Complex ab = 0.5 * (a + b), bc = 0.5 * (b + c), middle = 0.5 * (ab + bc);
    return {Cubic{{control[0], a, ab, middle}}, Cubic{{middle, bc, c, control[3]}}};
}

double Cubic::arc_length(double u) const {
    return integral(u, [&](double t) { return std::abs(velocity(t)); });
}

double Cubic::swept_area(Complex origin) const {
    return integral(1.0, [&](double t) { return 0.5 * std::imag(std::conj(point(t) - origin) * velocity(t)); });
}

std::vector<Cubic> closed_spline(const std::vector<Complex>& points) {
    const std::size_t n = points.size();
    std::vector<double> step(n), diagonal(n);
    std::vector<Complex> right(n);
    for (std::size_t i = 0; i < n; ++i) step[i] = std::abs(points[(i + 1) % n] - points[i]);
    for (std::size_t i = 0; i < n; ++i) {
        const std::size_t before = (i + n - 1) % n;
        diagonal[i] = 2 * (step[before] + step[i]);
        right[i] = 6.0 * ((points[(i + 1) % n] - points[i]) / step[i] - (points[i] - points[before]) / step[before]);
    }
    const std::vector<Complex> second = solve_cyclic(step, diagonal, right);
    std::vector<Cubic> cubics(n);
    for (std::size_t i = 0; i < n; ++i) {
        const std::size_t next = (i + 1) % n;
        const Complex chord = (points[next] - points[i]) / 3.0;
        const double bend = step[i] * step[i] / 18;
        cubics[i] = {{points[i], points[i] + chord - bend * (2.0 * second[i] + second[next]),
                      points[next] - chord - bend * (second[i] + 2.0 * second[next]), points[next]}};
    }
    return cubics;
}

std::vector<Cubic> even_pieces(const Cubic& cubic) {
    std::vector<Cubic> pieces;
    if (!cut(cubic, 0, pieces)) pieces.clear();
    return pieces;
}

}  // namespace beltrami::detail
