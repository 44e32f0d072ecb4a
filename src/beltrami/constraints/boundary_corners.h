#pragma once

#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/constraints/boundary_condition.h>

namespace beltrami BELTRAMI_PUBLIC {

/// A boundary vertex at which the source, the image or the speed of the boundary values is not smooth.
struct BoundaryCorner {
    int loop = 0;      ///< of topology.boundary_loops
    int position = 0;  ///< in that loop
    int vertex = 0;
    double source_angle = 0;  ///< α, interior, radians; π where the source is smooth
    double image_angle = 0;   ///< β, interior, in (0, 2π); NaN where the image is not prescribed
    double speed_out = 1;     ///< c1: |f(s) − f(0)| ≈ c1 s^p along the loop; NaN where not prescribed
    double speed_in = 1;      ///< c2: the same against the loop
    double exponent = 1;      ///< p; 1 unless the data show another one
    double significance = 0;  ///< largest ratio of a jump to what noise and smooth variation explain; > 1 is a corner
    double corner_bound = 1;  ///< K* ≥ this for the limiting data; 1 where the image is not prescribed
    double safe_bound = 1;    ///< the same with every jump smaller by `confidence` standard deviations
};

/// What counts as a corner.
struct CornerOptions {
    double min_turn = 0.1;       ///< smallest |π − α| or |π − β|, radians
    double min_log_speed = 0.1;  ///< smallest |log(c2/c1)|
    double min_exponent = 0.08;  ///< smallest |p − 1|
    double confidence = 4;       ///< standard deviations that noise may reach

    /// @throw Error bad_option unless all are positive
    void validate() const;
};

/// σmax/σmin of [[p, log(c2/c1)/α], [0, β/α]]: in log coordinates the least dilatation of a map of the sector of angle
/// α to that of angle β whose sides run like c1 s^p and c2 s^p, and so a lower bound for any map with such boundary
/// values. ∞ if an angle or p is not positive.
double corner_bound(double source_angle, double image_angle, double speed_out, double speed_in, double exponent);

/// The corners of all loops, by decreasing significance (of equals, by loop and position).
///
/// On both sides of every vertex the boundary is followed over 4, 8, 16 and 32 edges, at most an eighth of its loop and
/// up to the next corner found: in the image, and in the source laid out in the plane by its edge lengths and interior
/// angles. With distances r from the vertex, the chord directions, extrapolated linearly to r = 0, give α and β; log of
/// image over source distance, fitted as log c + a r, or + (p − 1) log r if that leaves clearly less than + b r², gives
/// c and p. Fits weigh r², so single edges count little.
///
/// A jump is compared with its threshold plus `confidence` standard deviations. These follow from what the fits leave
/// (and at least from the loop's own level, the lower sixth of that of all vertices), for vertices that are displaced
/// independently, this one too: so a jagged outline is no corner though its edges turn. No window may rule the jump
/// out. Corners are taken one by one, most significant first; windows end at those taken, and a power keeps the 8
/// vertices on both sides from being taken.
///
/// Jumps of smooth data are of third order in the window. Corners closer than 5 edges to each other, and those of loops
/// with fewer than 24 vertices, may be missed; a bend narrower than 4 edges counts as a corner. Linear time.
/// @pre validate(boundary, source)
std::vector<BoundaryCorner> find_corners(const Surface& source, const BoundaryCondition& boundary,
                                         const CornerOptions& options = {});

/// Edges from a corner to the nearest other one of its loop, at most half the loop.
/// @param loop_size vertices of the loop
int edges_to_next_corner(const BoundaryCorner& corner, const std::vector<BoundaryCorner>& corners, int loop_size);

/// The same fit at one vertex with nothing else taken for a corner, significant or not.
/// @throw Error bad_option if there is no such loop or position
BoundaryCorner measure_boundary_point(const Surface& source, const BoundaryCondition& boundary, int loop, int position,
                                      const CornerOptions& options = {});

}  // namespace beltrami
