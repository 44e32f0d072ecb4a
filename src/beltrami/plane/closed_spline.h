#pragma once

#include <array>
#include <vector>

#include <beltrami/base/complex.h>

namespace beltrami::detail {

/// A cubic piece of a curve, 0 ≤ u ≤ 1, by its control points.
struct Cubic {
    std::array<Complex, 4> control;

    Complex point(double u) const;
    Complex velocity(double u) const;
    Complex acceleration(double u) const;
    std::array<Cubic, 2> halves() const;
    /// ∫ |γ'| over 0 … u by Gauss's rule with 8 points; exact to rounding for what even_pieces() returns.
    double arc_length(double u) const;
    /// ∫ ½ Im(conj(γ − origin) γ') over 0 … 1, exactly.
    double swept_area(Complex origin) const;
};

/// The closed C² cubic spline through the points, its knots spaced like the chords: one piece from every point to the
/// next, the last one back to the first.
/// @pre at least 3 points, neighbours distinct
std::vector<Cubic> closed_spline(const std::vector<Complex>& points);

/// A piece cut in halves until each turns by less than 30° on both sides of its chord and Gauss's rule gives its
/// length to rounding. Empty if 40 halvings do not suffice: the piece has a cusp.
std::vector<Cubic> even_pieces(const Cubic& cubic);

}  // namespace beltrami::detail
