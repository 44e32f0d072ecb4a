#include "problems/elliptic.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace beltrami::bench {

using C = std::complex<double>;

C carlson_rf(C x, C y, C z) {
    C mean = (x + y + z) / 3.0;
    for (int step = 0; step < 60; ++step) {
        const double spread = std::max({std::abs(mean - x), std::abs(mean - y), std::abs(mean - z)});
        if (spread < 1e-3 * std::abs(mean)) break;
        const C rx = std::sqrt(x), ry = std::sqrt(y), rz = std::sqrt(z);
        const C lambda = rx * ry + ry * rz + rz * rx;
        x = (x + lambda) / 4.0;
        y = (y + lambda) / 4.0;
        z = (z + lambda) / 4.0;
        mean = (x + y + z) / 3.0;
    }
    const C a = 1.0 - x / mean, b = 1.0 - y / mean, c = -a - b;
    const C e2 = a * b - c * c, e3 = a * b * c;
    return (1.0 - e2 / 10.0 + e3 / 14.0 + e2 * e2 / 24.0 - 3.0 / 44.0 * e2 * e3) / std::sqrt(mean);
}

double complete_elliptic(double m) {
    double a = 1, b = std::sqrt(1 - m * m);
    while (std::abs(a - b) > 1e-15 * a) {
        const double mean = (a + b) / 2;
        b = std::sqrt(a * b);
        a = mean;
    }
    return std::numbers::pi / (2 * a);
}

namespace {

struct Jacobi {
    double sn, cn, dn;
};

/// By descending Landen transformations (Abramowitz & Stegun 16.12), |u| ≤ K(m).
Jacobi jacobi(double u, double m) {
    std::vector<double> a{1}, c{m};
    double b = std::sqrt(1 - m * m);
    while (std::abs(c.back()) > 1e-16 && a.size() < 20) {
        const double mean = (a.back() + b) / 2, difference = (a.back() - b) / 2;
        b = std::sqrt(a.back() * b);
        a.push_back(mean);
        c.push_back(difference);
    }
    double angle = std::ldexp(a.back() * u, static_cast<int>(a.size()) - 1);
    for (std::size_t n = a.size() - 1; n > 0; --n)
        angle = (angle + std::asin(std::clamp(c[n] * std::sin(angle) / a[n], -1.0, 1.0))) / 2;
    const double sn = std::sin(angle);
    return {sn, std::cos(angle), std::sqrt((1 - m * sn) * (1 + m * sn))};
}

/// sn(x + iy) (Abramowitz & Stegun 16.21.2).
C complex_sn(C u, double m) {
    const Jacobi p = jacobi(u.real(), m), q = jacobi(u.imag(), std::sqrt(1 - m * m));
    const double denominator = q.cn * q.cn + m * m * p.sn * p.sn * q.sn * q.sn;
    return C{p.sn * q.dn, p.cn * p.dn * q.sn * q.cn} / denominator;
}

}  // namespace

// With z = (1 + ix)/(1 − ix) the unit disk is the half-plane Im x > 0 (x = tan(θ/2) on the circle, seen from 0 as i);
// the four points are ±t and ±1/t, t = tan(phi/2). sn of modulus t² takes the rectangle |Re u| ≤ K, 0 ≤ Im u ≤ K′
// there; a quarter turn makes its lower side the right one.
DiskRectangle::DiskRectangle(double phi) : scale_(std::tan(phi / 2)), modulus_(scale_ * scale_) {
    height_ = 2 * complete_elliptic(modulus_);
    width_ = complete_elliptic(std::sqrt(1 - modulus_ * modulus_));
}

C DiskRectangle::to_rectangle(C z) const {
    const C i(0, 1);
    // By symmetry in the imaginary axis, x ↦ 1/conj(x), only |x| ≤ 1 is needed, where nothing is near infinity.
    const bool mirrored = z.real() < 0;
    if (mirrored) z = -std::conj(z);
    C x = i * (1.0 - z) / (1.0 + z) / scale_;
    x = {x.real(), std::max(x.imag(), 0.0)};
    // Just above the real axis, so that R_F sees the side from which the half-plane comes.
    if (x.imag() == 0) x = {x.real(), 1e-300};
    const C square = x * x, m = modulus_;
    const C u = x * carlson_rf(1.0 - square, 1.0 - m * m * square, 1.0);
    C placed = i * u + width_ / 2;
    if (mirrored) placed = -std::conj(placed);
    return placed;
}

C DiskRectangle::to_disk(C w) const {
    const C i(0, 1);
    const bool mirrored = w.real() < 0;
    if (mirrored) w = -std::conj(w);
    const C u(w.imag(), width_ / 2 - w.real());
    const C x = scale_ * complex_sn(u, modulus_);
    C z = (1.0 + i * x) / (1.0 - i * x);
    if (mirrored) z = -std::conj(z);
    return z;
}

}  // namespace beltrami::bench
