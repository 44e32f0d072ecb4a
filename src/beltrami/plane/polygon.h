#pragma once

#include <vector>

#include <beltrami/base/complex.h>

namespace beltrami {

/// Signed area of the parallelogram that two vectors span, positive if the second lies to the left of the first.
inline double cross(Complex a, Complex b) {
    return std::imag(std::conj(a) * b);
}

/// Signed area of a triangle, positive if counter-clockwise.
inline double signed_area(Complex a, Complex b, Complex c) {
    return 0.5 * cross(b - a, c - a);
}

/// Signed area of a closed polygon, positive if counter-clockwise. Summed relative to its first point, so that a place
/// far from the origin costs no digits.
double signed_area(const std::vector<Complex>& polygon);

/// @throw Error bad_boundary for fewer than 3 points, repeated neighbours, clockwise order, or edges that meet (both
/// named)
void require_simple_polygon(const std::vector<Complex>& polygon);

}  // namespace beltrami
