#pragma once

#include <span>
#include <vector>

#include <beltrami/curves/surface_curve.h>

namespace beltrami {

/// Two surfaces with their curves, and what they are cut along for a start that obeys these.
struct Curved {
    MeshWithCurves source, target;          ///< with the curves
    MeshWithCurves cut_source, cut_target;  ///< the same meshes with what they are cut along
};

/// Cut along the curves alone.
/// @throw Error bad_boundary as mesh_with_curves
Curved along_curves(const Mesh& source, const Mesh& target, std::span<const CurveThrough> source_curves,
                    std::span<const CurveThrough> target_curves);

/// Ways to cut two closed surfaces along curves that belong together, those that are to be tried first in one group.
///
/// - Along the curves alone. Two open ones leave a ring, whose maps differ by turns: all of them can be looked at
///   (curve_start.h).
/// - Along open curves joined by geodesics, from the end of one to the beginning of the next, so that the surfaces come
///   apart into disks, whose map is never folded. Which way around the curves the geodesics run decides how the map
///   turns around them, so that curves are joined in several orders and from either end: those with the shortest
///   geodesics.
/// @throw Error bad_boundary as mesh_with_curves
std::vector<std::vector<Curved>> ways_to_cut(const Mesh& source, const Mesh& target,
                                             std::span<const CurveThrough> source_curves,
                                             std::span<const CurveThrough> target_curves);

/// Measures arc lengths of curves where other points stand for the vertices: parts between given points are then
/// divided as they are there.
/// @param points #V×3
void measure_curves(MeshWithCurves& mesh, const Positions& points);

}  // namespace beltrami
