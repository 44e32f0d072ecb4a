#pragma once

#include <vector>

#include <beltrami/base/complex.h>

namespace beltrami {

/// The angle by which the direction from @p centre turns along the chain p_0, p_1, …: every straight piece turns it by
/// less than π. @pre no piece passes through @p centre
double turning_angle(const std::vector<Complex>& chain, Complex centre);

/// How often a closed polygon runs around a point, counter-clockwise. @pre the point is not on the polygon
int winding_number(const std::vector<Complex>& polygon, Complex point);

/// A point well inside a polygon (winding number not 0), in either orientation: the centre of its area where that is
/// inside, else the middle of the longest piece that a horizontal line has inside. The mean of the points where the
/// polygon encloses nothing.
Complex point_inside(const std::vector<Complex>& polygon);

}  // namespace beltrami
