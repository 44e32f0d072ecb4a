#pragma once

#include <array>
#include <vector>

#include <beltrami/applications/grid_quality.h>
#include <beltrami/applications/plane_grid.h>
#include <beltrami/base/public.h>
#include <beltrami/locate/planar_locator.h>
#include <beltrami/operators/surface.h>

namespace beltrami BELTRAMI_PUBLIC {

struct GridOptions {
    /// What becomes of cells that the boundary of the image cuts.
    enum class Border {
        trimmed,  ///< their part inside becomes a triangle, a quad or two, with corners on the boundary
        stepped,  ///< they are left out
    };
    Border border = Border::trimmed;
    /// Grid points this near to the boundary are moved to it: a part of the shortest edge there, 0 to 0.3. It keeps
    /// trimmed cells from becoming slivers, and lets a circle of the grid be the boundary.
    double snap = 0.25;

    /// @throw Error bad_option if a value is impossible
    void validate() const;
};

/// A grid of the plane carried to a surface.
struct SurfaceGrid {
    Mesh mesh;                              ///< quads, and triangles where the grid or its border needs them
    std::vector<MeshPoint> parents;         ///< #V places on the surface
    Eigen::VectorXcd parameter;             ///< #V places in the plane
    std::vector<char> on_border;            ///< #V flags: moved to, or cut by, the boundary of the surface
    std::vector<std::array<int, 2>> cells;  ///< #F column and row; pieces of a cell share them
    int whole_cells = 0;                    ///< cells with all their corners
    int trimmed_cells = 0;
    int omitted_cells = 0;  ///< cells that meet the image but hold a hole or a notch of it, or (stepped) are cut
    GridQuality quality;
};

/// Carries a structured grid in the plane back to a surface by the inverse of a one-to-one map (Ng, Gu & Lui 2014,
/// figure 22). Cells are convex in the plane, trimmed ones too, so none folds there; on the surface the quality tells.
/// Where cells touch at a corner only, the vertex is doubled: the result is a manifold.
/// @param map #V images in the plane, all faces counter-clockwise; a quad is read as two triangles
/// @throw Error bad_option for an impossible grid or one that has no cell inside; bad_mesh unless the
///        surface has one component, genus 0 and a boundary, or naming faces that the map flips or makes flat
SurfaceGrid grid_on_surface(const Surface& source, const Eigen::VectorXcd& map, const PlaneGrid& grid,
                            const GridOptions& options = {});

}  // namespace beltrami
