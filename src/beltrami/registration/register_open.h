#pragma once

#include <optional>
#include <span>

#include <beltrami/base/public.h>
#include <beltrami/registration/surface_landmarks.h>
#include <beltrami/teichmuller/carried_surface.h>
#include <beltrami/teichmuller/extremal_map.h>

namespace beltrami BELTRAMI_PUBLIC {

struct OpenRegistrationOptions {
    ExtremalOptions map;
    int outer_loop = 0;         ///< the boundary loop of the source whose partner goes to the unit circle
    int target_outer_loop = 0;  ///< that partner
};

/// A surface with boundary carried onto another one.
struct OpenRegistration : CarriedSurface {
    ExtremalMap map;           ///< of the source to the target's circle domain: k, φ, bounds, |μ|
    CircleDomainChart target;  ///< that domain
    Warnings warnings;
};

/// The extremal map between two surfaces of genus 0 with equally many boundary loops that takes landmarks to their
/// places: boundaries slide along each other, landmarks inside are pinned, those on the boundary marked
/// (extremal_map.h), by way of the target's circle domain. Soft landmarks move from their places as those of the sphere
/// do (soft_landmarks.h).
/// @throw Error bad_mesh, bad_boundary, bad_option (a soft landmark on the boundary, too), not_solved, cancelled
OpenRegistration register_open(const Surface& source, const Surface& target, std::span<const SurfaceLandmark> landmarks,
                               const OpenRegistrationOptions& options = {});

}  // namespace beltrami
