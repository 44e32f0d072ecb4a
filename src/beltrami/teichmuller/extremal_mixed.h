#pragma once

#include <optional>
#include <vector>

#include <beltrami/plane/target_curve.h>
#include <beltrami/teichmuller/extremal_map.h>

namespace beltrami {

/// Boundary conditions that mix: every loop, or every arc of a loop, is prescribed or slides along a curve, and inner
/// points may be pinned at the same time.
struct MixedConditions {
    /// One for every boundary loop of the source: the curve along which its vertices slide that are not prescribed,
    /// whichever way it runs; nothing for loops that are wholly prescribed.
    std::vector<std::optional<TargetCurve>> curves;
    /// Vertices of the boundary and inside with their images. A boundary vertex that is prescribed alone between two
    /// that slide is a mark; from two neighbours on they are an arc with prescribed boundary values, which may leave
    /// the curve but for its ends.
    BoundaryCondition prescribed;
    std::vector<SlidingArc> arcs;  ///< what is prescribed inside these does not hold
    int outer_loop = 0;            ///< the boundary loop whose image encloses the others
};

/// The extremal quasiconformal map among all that obey mixed conditions: Hamilton's iteration as in extremal_map, with
/// the differentials that are real along what slides (mixed_space.h, in the circle domain of the source) and an f-step
/// in which sliding vertices move along their curves.
///
/// The homotopy class is that of the start: the harmonic map of the boundary values where every sliding vertex stands
/// where the circle domain puts it, without folds, pinned points pushed straight to their places.
/// @param source  one component of genus 0 with a boundary; triangles or quads, in the plane or in space
/// @param options tolerance 0 is 1e-6
/// @throw Error bad_mesh, bad_boundary, bad_option, not_solved, cancelled
ExtremalMap mixed_extremal_map(const Surface& source, const MixedConditions& conditions,
                               const ExtremalOptions& options = {});

}  // namespace beltrami
