#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <beltrami/curves/surface_curve.h>
#include <beltrami/flow/extremal_flow.h>
#include <beltrami/flow/surface_flow.h>
#include <beltrami/registration/surface_landmarks.h>
#include <beltrami/teichmuller/carried_surface.h>
#include <beltrami/uniformize/sphere_map.h>

namespace beltrami BELTRAMI_PUBLIC {

/// A curve on one surface and the one of another to which it goes. Given points of both belong together in order,
/// equally many of them.
struct CurvePair {
    CurveThrough source, target;
    /// The curve slides along its partner, its ends stay at those of the partner; else every point stays where its part
    /// of the arc between given points puts it.
    bool slides = true;
};

struct CurveRegistrationOptions {
    double p = 2;               ///< of the Lᵖ norm, see least_lp_map()
    bool extremal = false;      ///< go on to the map of least dilatation (extremal_flow); p is that of its start
    SphereMapOptions sphere;    ///< of closed surfaces
    int outer_loop = 0;         ///< of others: the loop whose partner goes to the unit circle, …
    int target_outer_loop = 0;  ///< … and that partner
    SurfaceFlowOptions flow;
    std::function<bool(int iteration, double k)> extremal_progress = {};  ///< see ExtremalFlowOptions
    /// Places on the target of every vertex of the source, to start from.
    std::vector<MeshPoint> start = {};
};

/// A surface of genus 0 carried onto another one by the map of least Lᵖ norm.
struct LpRegistration : CarriedSurface {
    MeshWithCurves source;           ///< the source with its curves along edges, whose map is found
    std::vector<MeshPoint> divided;  ///< places of all vertices of source.mesh on the target
    SurfaceFlowMap map;              ///< of that to the target's sphere or circle domain
    /// Of the map of least dilatation, if that was wanted; map is then that one.
    std::optional<ExtremalFlowMap> extremal;
    Positions image;                 ///< #V×3 the target's vertices there
    MapResult carried;               ///< |μ| of the source's own faces there
    std::vector<int> start_flipped;  ///< faces that the start had flipped
    double curve_distance = 0;       ///< largest distance of a vertex of a curve from its partner, in space
    Warnings warnings;
};

/// The map between two surfaces of genus 0, both closed or with equally many boundary loops, of least Σ A ψ^{p/2}, ψ =
/// |μ|²/(1 − |μ|²), or from there on of least dilatation, that takes curves to curves and landmarks to their places, by
/// way of the target's conformal sphere or circle domain (least_lp_map); boundaries slide along each other. Curves run
/// through given points along geodesics (mesh_with_curves). The start of closed surfaces is that of the landmarks
/// (extremal_sphere_map), with curves a map of the surfaces cut along them (curve_start.h). That of others is the
/// extremal map that takes landmarks and given points of curves to their places (register_open), curves then put to
/// their partners and what folds opened (fold_free.h).
/// @param landmarks to be met: none is soft
/// @throw Error bad_mesh; bad_boundary (curves, landmarks, starts that fold and cannot be unfolded); bad_option;
///        not_solved, cancelled
LpRegistration register_least_lp(const Surface& source, const Surface& target,
                                 std::span<const SurfaceLandmark> landmarks, std::span<const CurvePair> curves,
                                 const CurveRegistrationOptions& options = {});

}  // namespace beltrami
