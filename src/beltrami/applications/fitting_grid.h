#pragma once

#include <beltrami/applications/plane_grid.h>
#include <beltrami/base/public.h>
#include <beltrami/targets/target_domain.h>

namespace beltrami BELTRAMI_PUBLIC {

enum class GridLines {
    automatic,    ///< log_polar where the domain is a ring between two circles of one centre, else rectangular
    rectangular,  ///< along the sides of an outer rectangle, however it is turned, else along the axes
    polar,        ///< circles of equal distance around the centre of the outer circle, and rays
    log_polar,    ///< circles around a hole whose radii grow by one factor, and rays
};

const char* to_string(GridLines lines);

/// A grid that fits a domain: lines run along the sides of an outer rectangle and touch an outer circle on four sides;
/// the outermost circle is the outer curve, of a ring the innermost one its hole. Cells are as nearly square as this
/// allows, log-polar ones conformally.
/// @param cells rectangular: along the longer side of the domain (of the box around it, unless it is a rectangle);
///              polar, log_polar: around
/// @throw Error bad_option for fewer cells than 1, or 3 around; for circles where the outer curve is none; log_polar:
///        unless a hole holds the centre of the outer circle
PlaneGrid fitting_grid(const TargetDomain& domain, int cells, GridLines lines = GridLines::automatic);

/// What kind of grid it is; never automatic.
GridLines lines_of(const PlaneGrid& grid);

}  // namespace beltrami
