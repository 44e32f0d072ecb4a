#pragma once

#include <Eigen/Core>

namespace beltrami {

/// Positive if a, b, c turn counter-clockwise, negative if clockwise, 0 exactly if they are collinear. The sign is
/// exact (barring underflow); the magnitude approximates twice the area of the triangle.
double orient2d(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c);

/// Positive if d lies inside the circle through a, b, c, negative if outside, 0 exactly if the four are cocircular. The
/// sign is exact (barring underflow).
/// @pre a, b, c are counter-clockwise
double incircle(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c, const Eigen::Vector2d& d);

}  // namespace beltrami
