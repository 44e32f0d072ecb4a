#pragma once

#include <memory>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/operators/surface.h>
#include <beltrami/targets/slide_curve.h>
#include <beltrami/targets/target.h>

namespace beltrami BELTRAMI_PUBLIC {

/// What a map to a target has to keep while it moves along it: vertices that stay where the start has them, and
/// vertices that slide along curves of the target. All others are free on the target, also those of the boundary.
struct TargetConstraints {
    struct Slide {
        int vertex;
        int curve;  ///< of curves
    };

    std::vector<int> fixed;
    SlideCurves curves;
    std::vector<Slide> sliding;

    /// Whether nothing is held, so that conformal maps of the target onto itself are left over.
    bool empty() const { return fixed.empty() && sliding.empty(); }
    /// Lets all vertices of one loop slide along a curve.
    void slide(const std::vector<int>& loop, std::shared_ptr<const SlideCurve> curve);
};

/// @throw Error bad_boundary naming vertices that the source does not have or that are held twice, and slides along
///        curves that there are not
void validate(const TargetConstraints& constraints, const Surface& source);

/// Lets every boundary loop of the source slide along the curve of the target's boundary that it is nearest to;
/// vertices that are held already stay so.
/// @param start #V×3 or #V×2, near the target
/// @throw Error bad_boundary if the target has no boundary, or two loops are nearest to one curve
void slide_boundary(TargetConstraints& constraints, const Surface& source, const Target& target,
                    const Positions& start);

/// A map to a target: where every vertex is, and the arc lengths of those that slide on their curves.
struct TargetMap {
    Target::Points points;           ///< #V
    std::vector<double> parameters;  ///< beside TargetConstraints::sliding
};

/// The map whose vertices are at the nearest points of the target, those that slide at the nearest points of their
/// curves.
/// @param start #V×3 or #V×2, near the target
/// @throw Error bad_option naming points that are not finite, or unless there are #V; bad_boundary as validate
TargetMap target_map(const Surface& source, const Target& target, const TargetConstraints& constraints,
                     const Positions& start);

}  // namespace beltrami
