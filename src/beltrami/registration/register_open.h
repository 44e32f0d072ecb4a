#pragma once

#include <optional>
#include <span>

#include <beltrami/base/public.h>
#include <beltrami/registration/surface_landmarks.h>
#include <beltrami/teichmuller/carried_surface.h>
#include <beltrami/teichmuller/extremal_map.h>

namespace beltrami BELTRAMI_PUBLIC {

struct OpenRegistrationOptions {
    ExtremalOptions map;  ///< its start is made of those below
    /// Places on the target of every vertex of the source, to start from. The iteration has no barrier: from a start of
    /// another homotopy class than that of straight ways it may come back to that.
    std::vector<MeshPoint> start = {};
    /// Ways of landmarks inside over the target, which choose the homotopy class.
    std::vector<SurfaceWaypoint> waypoints = {};
    bool check_inverse = true;
    int outer_loop = 0;         ///< the boundary loop of the source whose partner goes to the unit circle
    int target_outer_loop = 0;  ///< that partner
};

/// A surface with boundary carried onto another one.
struct OpenRegistration : CarriedSurface {
    ExtremalMap map;           ///< of the source to the target's circle domain: k, φ, bounds, |μ|
    CircleDomainChart target;  ///< that domain
    /// k of the inverse map, sampled at the target's vertices, after a step of the iteration there, with the target's
    /// own differentials; empty if not wanted, or where the map is not one-to-one.
    std::optional<double> inverse_k;
    Warnings warnings;
};

/// The extremal map between two surfaces of genus 0 with equally many boundary loops that takes landmarks to their
/// places: boundaries slide along each other, landmarks inside are pinned, those on the boundary marked
/// (extremal_map.h), by way of the target's circle domain. A landmark on the boundary goes to the point of the target's
/// boundary nearest to its place, with a warning where that is far. Soft landmarks move from their places as those of
/// the sphere do (soft_landmarks.h). With waypoints landmarks are led along their ways first (braided_start.h), and a
/// map that has left the class of these is refused.
/// @throw Error bad_mesh, bad_boundary, bad_option (a soft landmark on the boundary, too, and a start beside
/// waypoints),
///        not_solved, cancelled
OpenRegistration register_open(const Surface& source, const Surface& target, std::span<const SurfaceLandmark> landmarks,
                               const OpenRegistrationOptions& options = {});

}  // namespace beltrami
