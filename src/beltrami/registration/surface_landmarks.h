#pragma once

#include <limits>
#include <optional>
#include <span>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/locate/planar_locator.h>
#include <beltrami/teichmuller/carried_surface.h>

namespace beltrami BELTRAMI_PUBLIC {

/// A vertex of one surface and the place of another to which it belongs.
struct SurfaceLandmark {
    int vertex = 0;
    MeshPoint place;
    /// Infinite: the vertex goes there. Else it may be off by d at the cost of weight·d², d in units of the root of the
    /// target's area, beside ½ log K.
    double weight = std::numeric_limits<double>::infinity();
};

/// Where a landmark is at a step of its way.
struct SurfaceWaypoint {
    int step = 1;  ///< from 1; the landmarks' places come after the last step
    int vertex = 0;
    MeshPoint place;
};

/// Of every step the places of the landmarks that it names, in their order.
/// @throw Error bad_option for a waypoint of no landmark, or an impossible step
std::vector<std::vector<std::optional<MeshPoint>>> stops_of(std::span<const SurfaceWaypoint> waypoints,
                                                            std::span<const SurfaceLandmark> landmarks);

/// The place of a mesh that is a vertex.
/// @throw Error bad_boundary if no face has the vertex
MeshPoint place_of_vertex(const Mesh& mesh, int vertex);

/// The corner of a place with the largest weight.
int nearest_vertex(const MeshPoint& place);

/// The vertex that a place is; −1: it is none.
int vertex_at(const MeshPoint& place);

/// Area of a surface around a place per area of its image in a chart, as part of the whole: what squared distances in
/// the chart are multiplied by.
/// @param chart #V×3 or #V×2
double squared_scale(const Surface& surface, const Positions& chart, const MeshPoint& place);

/// How far from a vertex, on the sphere, the thousandth of a surface's area around it reaches: tiny inside limbs.
/// @param sphere #V×3
double limb_size(const Surface& surface, const Positions& sphere, int vertex);

/// Puts landmarks that are to be met at their places exactly.
void meet_landmarks(std::span<const SurfaceLandmark> landmarks, CarriedSurface& carried);
/// How far the others are from theirs.
void measure_landmarks(const Mesh& target, std::span<const SurfaceLandmark> landmarks, CarriedSurface& carried);

}  // namespace beltrami
