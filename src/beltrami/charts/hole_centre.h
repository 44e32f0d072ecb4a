#pragma once

#include <vector>

#include <beltrami/mesh/mesh.h>

namespace beltrami {

/// A place well inside a polygon and its distances from the corners.
struct HoleCentre {
    Complex centre = 0;
    double radius = 0;  ///< of the circle through the corners, if round; else the smaller of the mean distance and
                        ///< twice the smallest
    double ratio = 1;   ///< largest over smallest distance of a corner from the centre
};

/// The centre of the best circle if the polygon is nearly round; else the centre of its area if that lies well inside;
/// else a place as far from the sides as can be. Turns and scales with the polygon.
/// @pre at least three corners, not all equal; in either direction
HoleCentre hole_centre(const std::vector<Complex>& polygon);

}  // namespace beltrami
