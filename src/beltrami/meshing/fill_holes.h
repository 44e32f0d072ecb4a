#pragma once

#include <optional>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/operators/surface.h>

namespace beltrami BELTRAMI_PUBLIC {

/// What closes one boundary loop.
struct HoleFill {
    int loop;  ///< of the source's boundary loops
    int first_vertex, vertex_count;
    int first_face, face_count;
};

/// A mesh with holes closed. Its first #V vertices and #F faces are the source's.
struct FilledSurface {
    Mesh mesh;
    /// One point per face corner, if the fills have shapes of their own (see fill_holes) or the source has.
    std::optional<Positions> metric;
    std::vector<HoleFill> fills;  ///< one for every closed loop, in the order of the loops
    bool planar = false;          ///< the source lies in the plane, and so do the fills, beside it
};

/// Closes every boundary loop that is not in @p open by triangles that grow away from it (docs/conformal.md).
///
/// - In the plane, where the geometric outer loop (loop 0) stays open and the others are simple polygons: the
///   triangles lie in the holes.
/// - Otherwise every fill has a shape of its own, glued in along sides of equal length: the flat convex polygon with
///   the loop's edge lengths whose corners lie on a circle, or a cone where there is none. The positions of its
///   vertices only show it: the harmonic surface over that polygon, raised above a planar source (which gets a third
///   coordinate).
///
/// A loop of three vertices that has an area is closed by one triangle. Texture coordinates are dropped.
/// @param open loops to leave as they are
/// @throw Error bad_option if there is no such loop
FilledSurface fill_holes(const Surface& source, const std::vector<int>& open);
/// Leaves one loop open.
FilledSurface fill_holes(const Surface& source, int outer_loop = 0);

}  // namespace beltrami
