#pragma once

#include <string>

#include <beltrami/applications/fitting_grid.h>
#include <beltrami/applications/grid_on_surface.h>
#include <beltrami/base/public.h>

namespace beltrami BELTRAMI_PUBLIC {

/// A grid carried to a surface.
struct GridRecord {
    std::string carried_by;  ///< the map: "extremal", "conformal" or "file"
    GridLines lines = GridLines::rectangular;
    int cells = 0;  ///< wanted, as in fitting_grid
    bool trimmed = false;
    bool checker = false;
    int vertices = 0, quads = 0, triangles = 0;
    int whole_cells = 0, trimmed_cells = 0, omitted_cells = 0;
    GridQuality quality;
    double area_part = 0;  ///< area of the faces over that of the surface
};

/// Counts, quality and area; what was wished for is the caller's to fill in.
GridRecord grid_record(const SurfaceGrid& grid, const Mesh& surface);

/// The counts and the quality as a table for the terminal. Angles in degrees.
std::string to_table(const GridRecord& record);

}  // namespace beltrami
