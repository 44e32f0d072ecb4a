#pragma once

#include <span>
#include <vector>

#include <beltrami/constraints/target_constraints.h>
#include <beltrami/curves/surface_curve.h>
#include <beltrami/flow/led_map.h>
#include <beltrami/operators/surface.h>

namespace beltrami BELTRAMI_PUBLIC {

/// A curve on a surface and the points of a target that its own go to, joined there by geodesics: on a mesh
/// (straight_path.h), on other targets as straight_way() has them.
struct CurveOnto {
    CurveThrough source;
    Target::Points target;  ///< as many as source.points; closed as it is
    /// The curve slides along its partner, its ends stay at those of the partner; else every point stays where its part
    /// of the arc between given points puts it.
    bool slides = true;
};

/// Curves where maps go.
struct PartnerCurves {
    std::vector<MeshWithCurves::Chain> chains;  ///< their vertices are rows of points
    Positions points;                           ///< #×3
};

/// Those of a target. Distances of lengths and given points are of the target itself.
/// @throw Error bad_boundary as mesh_with_curves and straight_way, and where numbers of points differ
PartnerCurves partner_curves(const Target& target, std::span<const CurveOnto> curves);

/// Holds the vertices of curves: their places go to @p images, they themselves to @p constraints. Curves that slide
/// and lie near their partners in @p images already go to the nearest points there, others to the same parts of arcs.
/// @param slides  for every curve
/// @param target  on which partners lie; kept by reference by curves along which something slides
/// @param images  #V×3 of the mesh with curves; those of curves are changed
void hold_curves(const MeshWithCurves& source, const PartnerCurves& partners, std::span<const char> slides,
                 const Target& target, TargetConstraints& constraints, Positions& images);

/// A surface with curves along its edges, and what a map to a target has to keep to.
struct HeldCurves {
    MeshWithCurves source;          ///< vertices of the surface come first
    TargetConstraints constraints;  ///< of vertices of curves
    Positions start;                ///< #V×3 of source.mesh: the map that was given
    Positions wanted;               ///< the same with the vertices of curves at their partners
};

/// A map to a target made ready for curves: faces are divided along them, vertices of curves held. The way from start
/// to wanted is that of led_start().
/// @param source that passes the diagnosis, in space or in the plane
/// @param target kept by reference
/// @param start  #V×3 or #V×2 of the source, near the target
/// @throw Error bad_boundary as mesh_with_curves and partner_curves; bad_option (sizes)
HeldCurves held_curves(const Mesh& source, const Target& target, std::span<const CurveOnto> curves,
                       const Positions& start);
/// The same of a source that is divided already, and a map of all its vertices.
HeldCurves held_curves(MeshWithCurves source, const Target& target, std::span<const CurveOnto> curves,
                       const Positions& start);

/// The start that obeys the curves: led (led_map) from held.start to held.wanted, each at its nearest points.
/// @param with_curves the surface of held.source
/// @param held        whose constraints may be more than its curves (pins, boundaries)
LedMap led_start(const Surface& with_curves, const Target& target, const HeldCurves& held);

/// Coefficients of a surface for its faces divided along curves: every face that was divided passes on its own.
/// @param mu #S in the samples' frames of the surface
/// @return #S of the mesh with curves, in its samples' frames
Eigen::VectorXcd mu_along_curves(const Surface& source, const MeshWithCurves& divided, const Surface& with_curves,
                                 const Eigen::VectorXcd& mu);

/// The part of a map of the surface with curves that is one of its own vertices, its faces whole and straight. Where a
/// curve bends inside a face that may flip it: vertices around such faces that nothing holds go to the means of their
/// neighbours or are unfolded in patches, as far as that opens them.
/// @param constraints of the surface with curves
/// @param map         of it
TargetMap own_part(const Surface& source, const Target& target, const TargetConstraints& constraints,
                   const TargetMap& map);

}  // namespace beltrami
