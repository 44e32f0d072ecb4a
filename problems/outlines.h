#pragma once

#include <beltrami/meshing/planar_domains.h>

namespace beltrami::bench {

/// Outlines of planar domains, counter-clockwise.
/// A gear about 0: teeth with flanks that lean a little; from the root radius to the outer one.
Polygon gear(int teeth, double root_radius, double outer_radius);
/// A disk about 0 of corner_count corners with thin notches cut in from its rim, tips at tip_radius.
Polygon notched_circle(int notches, double width, double tip_radius, int corner_count);
/// A regular polygon, its first corner at the given angle.
Polygon regular(int corners, Eigen::Vector2d centre, double radius, double angle);

}  // namespace beltrami::bench
