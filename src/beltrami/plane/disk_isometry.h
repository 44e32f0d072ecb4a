#pragma once

#include <algorithm>
#include <cmath>

#include <Eigen/Core>

#include <beltrami/base/complex.h>
#include <beltrami/base/public.h>

namespace beltrami BELTRAMI_PUBLIC {

/// An isometry z ↦ (a z + b)/(b̄ z + ā), |a|² − |b|² = 1, of the hyperbolic plane, the unit disk with the metric
/// 2|dz|/(1 − |z|²). It is also a place and a frame: where 0 goes, and the direction 1 there. (a, b) and (−a, −b) are
/// the same isometry. Lengths are told by b without cancellation.
struct DiskIsometry {
    Complex a = 1, b = 0;

    /// The translation along the axis through 0 that takes 0 to the distance |ξ| in the direction of ξ.
    static DiskIsometry translation(Complex xi) {
        const double length = std::abs(xi);
        if (length == 0) return {};
        return {std::cosh(0.5 * length), std::sinh(0.5 * length) / length * xi};
    }
    /// The rotation about 0.
    static DiskIsometry rotation(double angle) { return {std::polar(1.0, 0.5 * angle), 0}; }

    Complex operator()(Complex z) const { return (a * z + b) / (std::conj(b) * z + std::conj(a)); }
    /// First the other one, then this one.
    DiskIsometry operator*(const DiskIsometry& other) const {
        return {a * other.a + b * std::conj(other.b), a * other.b + b * std::conj(other.a)};
    }
    DiskIsometry inverse() const { return {std::conj(a), -b}; }
    /// The same seen in the mirror, the real axis.
    DiskIsometry mirrored() const { return {std::conj(a), std::conj(b)}; }
    /// Where 0 goes.
    Complex place() const { return b / std::conj(a); }
    /// How far 0 is moved.
    double distance() const { return 2 * std::asinh(std::abs(b)); }
    /// The direction, of length 1, in which 0 is moved; any where it stays.
    Complex direction() const {
        const Complex product = (std::abs(b) > 1e-14 ? b : std::conj(a)) * a;
        return product / std::abs(product);
    }
    /// Rounding removed from |a|² − |b|² = 1.
    DiskIsometry normalized() const {
        const double size = std::sqrt(std::norm(a) - std::norm(b));
        return {a / size, b / size};
    }
    /// How far it is from the identity: 0 for (±1, 0).
    double from_identity() const { return std::min(std::abs(a - 1.0), std::abs(a + 1.0)) + std::abs(b); }
    /// Length of the closed geodesic, where it is hyperbolic; 0 else.
    double translation_length() const { return 2 * std::acosh(std::max(1.0, std::abs(a.real()))); }
    /// As an isometry of the upper half-plane, with i for 0: a matrix of determinant 1.
    Eigen::Matrix2d on_half_plane() const {
        Eigen::Matrix2d matrix;
        matrix << a.real() + b.real(), a.imag() - b.imag(), -a.imag() - b.imag(), a.real() - b.real();
        return matrix;
    }
};

}  // namespace beltrami
