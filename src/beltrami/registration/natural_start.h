#pragma once

#include <optional>
#include <span>
#include <string>

#include <beltrami/base/public.h>
#include <beltrami/operators/surface.h>
#include <beltrami/registration/held_curves.h>
#include <beltrami/targets/target_domain.h>

namespace beltrami BELTRAMI_PUBLIC {

/// Where a flow along a target begins that is given no start.
struct NaturalStart {
    Positions positions;  ///< #V×3 or #V×2, near the target
    std::string name;     ///< identity, conformal, harmonic, lattice, cut along curves, led along curves
    /// The source divided along its curves, if that is what has positions; else it is the source itself.
    std::optional<MeshWithCurves> source = {};
};

/// What a target is, beside its points.
struct TargetKind {
    const Surface* surface = nullptr;               ///< of a mesh
    const TargetDomain* domain = nullptr;           ///< of a domain
    std::optional<Eigen::Vector3d> half_axes = {};  ///< of an ellipsoid
};

/// The source itself where it lies on the target; else a map that its topology and the target's lead to: of genus 0 the
/// conformal one onto spheres, ellipsoids and closed meshes, and by way of circle domains onto meshes with as many
/// boundary loops, the plane, domains (the harmonic map) and, of rings, cylinders; of genus 1 the flat lattice onto
/// tori.
/// @param curves that the map is to take along; between surfaces of genus 0 the start is cut along them
///               (register_least_lp)
/// @throw Error bad_option where no start is known; as those of the maps that are used
NaturalStart natural_start(const Surface& source, const Target& target, const TargetKind& kind,
                           std::span<const CurveOnto> curves = {});

/// A start made ready for curves, as it is divided along them already or not.
/// @param source that of the start
HeldCurves held_curves(const Mesh& source, const Target& target, std::span<const CurveOnto> curves, NaturalStart start);

}  // namespace beltrami
