#pragma once

#include <optional>
#include <span>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/locate/planar_locator.h>
#include <beltrami/registration/surface_landmarks.h>
#include <beltrami/teichmuller/carried_surface.h>
#include <beltrami/teichmuller/extremal_sphere.h>
#include <beltrami/uniformize/sphere_map.h>

namespace beltrami BELTRAMI_PUBLIC {

struct RegistrationOptions {
    ExtremalSphereOptions map;  ///< of the extremal map; its start and waypoints are those below
    SphereMapOptions sphere;    ///< of both conformal maps
    /// Places on the target of every vertex of the source, to start from.
    std::vector<MeshPoint> start = {};
    /// Ways of landmarks over the target, which choose the homotopy class.
    std::vector<SurfaceWaypoint> waypoints = {};
    bool check_inverse = true;
};

/// A closed surface of genus 0 carried onto another one, and what is to be known about it.
struct SphereRegistration : CarriedSurface {
    SphereMap source_sphere, target_sphere;
    ExtremalSphereMap map;  ///< of the source to the target's sphere: k, φ, bounds, |μ|
    /// k of the inverse map, sampled at the target's vertices, by a c-step with the target's own differentials,
    /// where that is off by 5e-4 and more after a few steps of the iteration there; empty if not wanted or if there are
    /// fewer than four landmarks.
    std::optional<double> inverse_k;
    Warnings warnings;  ///< of both maps to the sphere and of the map
};

/// The extremal map between two closed surfaces of genus 0 that takes landmarks to their places (extremal_sphere.h), by
/// way of the target's conformal sphere; the target's faces are located there. It is one-to-one, as both maps to the
/// sphere have no flipped face.
/// @param target triangles and quads
/// @throw Error bad_mesh, bad_boundary, bad_option, not_solved, cancelled
SphereRegistration register_spheres(const Surface& source, const Surface& target,
                                    std::span<const SurfaceLandmark> landmarks,
                                    const RegistrationOptions& options = {});

}  // namespace beltrami
