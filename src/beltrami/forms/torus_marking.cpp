#include <beltrami/forms/torus_marking.h>

#include <array>
#include <cmath>
#include <numeric>
#include <utility>

namespace beltrami {

namespace {

constexpr double kTie = 1e-12;

/// Numbers x, y with a x + b y = 1.
/// @pre a and b are coprime
std::array<int, 2> bezout(int a, int b) {
    int x = 1, y = 0, next_x = 0, next_y = 1;
    while (b != 0) {
        const int quotient = a / b;
        a = std::exchange(b, a - quotient * b);
        x = std::exchange(next_x, x - quotient * next_x);
        y = std::exchange(next_y, y - quotient * next_y);
    }
    return {a * x, a * y};  // the greatest common divisor comes out as 1 or −1
}

TorusMarking columns(int a, int c, int b, int d) {
    TorusMarking result;
    result << a, b, c, d;
    return result;
}

}  // namespace

Complex tau_in_basis(Complex tau, const TorusMarking& basis) {
    const auto period = [&](int column) {
        return static_cast<double>(basis(0, column)) + static_cast<double>(basis(1, column)) * tau;
    };
    return period(1) / period(0);
}

TorusMarking reducing_basis(Complex tau) {
    TorusMarking basis = TorusMarking::Identity();
    while (true) {
        const Complex here = tau_in_basis(tau, basis);
        const auto shift = static_cast<int>(std::lround(here.real()));
        if (shift != 0 && std::abs(here.real()) > 0.5 + kTie) {
            basis.col(1) -= shift * basis.col(0);
            continue;
        }
        if (std::norm(here) >= 1 - kTie) return basis;
        basis = columns(basis(0, 1), basis(1, 1), -basis(0, 0), -basis(1, 0));
    }
}

double hyperbolic_distance(Complex a, Complex b) {
    return 2 * std::asinh(std::abs(a - b) / (2 * std::sqrt(a.imag() * b.imag())));
}

TorusMarking nearest_marking(Complex from, Complex to) {
    TorusMarking best = TorusMarking::Identity();
    double least = hyperbolic_distance(from, to);
    // Im of the new τ is Im τ / |m₀₀ + m₁₀ τ|²; where it is e^d times smaller than that of `from`, the distance is
    // above d. The first column that may be nearer is short therefore, and the second is determined by it up to
    // multiples.
    const auto longest = [&] { return std::sqrt(to.imag() / from.imag() * std::exp(least)); };
    for (int c = 0; c * to.imag() <= longest(); ++c) {
        const double reach = longest();
        const auto first = static_cast<int>(std::floor(-reach - c * to.real())),
                   last = static_cast<int>(std::ceil(reach - c * to.real()));
        for (int a = first; a <= last; ++a) {
            if (std::gcd(a, c) != 1 || (c == 0 && a != 1)) continue;
            const auto [x, y] = bezout(a, c);  // a d − c b = 1 for d = x, b = −y
            TorusMarking candidate = columns(a, c, -y, x);
            const double offset = (from - tau_in_basis(to, candidate)).real();
            candidate.col(1) += static_cast<int>(std::lround(offset)) * candidate.col(0);
            const double distance = hyperbolic_distance(from, tau_in_basis(to, candidate));
            if (distance < least - kTie) {
                least = distance;
                best = a < 0 ? TorusMarking(-candidate) : candidate;
            }
        }
    }
    return best;
}

}  // namespace beltrami
