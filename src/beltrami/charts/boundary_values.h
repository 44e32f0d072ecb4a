#pragma once

#include <array>
#include <optional>

#include <beltrami/base/public.h>
#include <beltrami/constraints/boundary_condition.h>

namespace beltrami BELTRAMI_PUBLIC {

/// How fast a boundary loop of a source runs along the boundary of its target.
enum class BoundarySpeed {
    arclength,  ///< proportionally to length
    conformal,  ///< as the conformal map does: gentle at corners, where arc length forces a large dilatation
};

class Shape;

/// Which boundary loop is prescribed, run through with the faces on the left (counter-clockwise in the image), and how.
struct BoundaryPlacement {
    std::optional<int> start;  ///< the boundary vertex that goes to angle 0, the first corner or the first point;
                               ///< default: the smallest
    /// Conformal: of the round disk, or, where there are further loops, of the disk with holes (domain_chart.h).
    BoundarySpeed speed = BoundarySpeed::arclength;
    int loop = 0;                  ///< of topology.boundary_loops: the one whose image is to enclose the others
    const Shape* shape = nullptr;  ///< the source with its charts, of which the conformal speed then takes one
};

/// The unit circle: the point at t = 2π · arc length / total (or conformal angle) goes to e^{i(t + amplitude sin t)}.
/// @throw Error bad_option if |amplitude| ≥ 1 (the boundary would run backwards) or there is no such loop; bad_boundary
///        if start is not on the loop
BoundaryCondition boundary_to_disk(const Surface& source, double amplitude, const BoundaryPlacement& placement = {});

/// The rectangle [0,width]×[0,height]: four boundary vertices, in counter-clockwise order, go to (0,0), (width,0),
/// (width,height), (0,height), the sides in between by arc length, or as the conformal map of the quadrilateral,
/// stretched to the rectangle. Without corners the boundary is cut at vertices nearest to the rectangle's own
/// proportions.
/// @throw Error bad_option, bad_boundary
BoundaryCondition boundary_to_rectangle(const Surface& source, double width, double height,
                                        const std::optional<std::array<int, 4>>& corners,
                                        const BoundaryPlacement& placement = {});

/// A simple closed polygon, counter-clockwise. The start goes to its first point; by arc length, each further corner
/// that turns by more than 10 degrees receives the nearest vertex, so that the image has the polygon's corners. With
/// conformal speed the polygon's inside is meshed and mapped to the round disk, as the source is.
/// @throw Error bad_boundary for a polygon with fewer than 3 points, clockwise, or crossing itself (with the two edges)
BoundaryCondition boundary_to_polygon(const Surface& source, const std::vector<Complex>& polygon,
                                      const BoundaryPlacement& placement = {});

/// A hole to a circle by arc length: clockwise, as the edge of a hole runs with the faces on the left, its smallest
/// vertex at @p start_angle.
/// @param loop of topology.boundary_loops, not the one whose image encloses the others
/// @throw Error bad_option if there is no such loop, the radius is not positive or a number is not finite
BoundaryCondition hole_to_circle(const Surface& source, int loop, Complex centre, double radius,
                                 double start_angle = 0);

}  // namespace beltrami
