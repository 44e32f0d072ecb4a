#pragma once

#include <vector>

#include <beltrami/base/complex.h>

namespace beltrami {

/// A circle near given points: the least-squares solution of |z|² = 2 Re(conj(centre) z) + d.
struct CircleFit {
    Complex centre = 0;
    double radius = 0;
    double smallest = 0;  ///< least distance of a point from the centre
    double largest = 0;   ///< largest one

    /// All points lie on the circle, up to @p tolerance times its radius.
    bool exact(double tolerance = 1e-7) const {
        return radius > 0 && largest - radius <= tolerance * radius && radius - smallest <= tolerance * radius;
    }
    /// Largest distance from the centre over the smallest one; infinite if the centre is a point.
    double ratio() const;
};

/// @pre at least three points, not all equal
CircleFit fit_circle(const std::vector<Complex>& points);

}  // namespace beltrami
