#pragma once

#include <beltrami/charts/circle_domain_chart.h>
#include <beltrami/starts/sliding_start.h>
#include <beltrami/teichmuller/extremal_mixed.h>

namespace beltrami {

/// Mixed conditions as they hold vertex by vertex.
struct MixedBoundary {
    std::vector<std::optional<TargetCurve>> curves;  ///< of every loop, each running as its loop does
    BoundaryCondition prescribed;                    ///< without what is inside arcs that slide
    /// Of every loop, 1 for vertices that are prescribed.
    std::vector<std::vector<char>> held;

    bool slides(int loop) const;
};

/// Whether an arc of a loop is prescribed: two neighbours.
/// @param held of the loop
bool has_arc(const std::vector<char>& held);

/// The curve of the outer loop runs counter-clockwise, those of the others clockwise.
/// @throw Error bad_option unless there is an entry for every loop; bad_boundary naming arcs that do not lie on one
///        loop, and vertices that are neither prescribed nor have a curve
MixedBoundary mixed_boundary(const Surface& source, const MixedConditions& conditions);

/// The loops that slide: every vertex of theirs that slides stands, between those of its loop that are held, where its
/// angle in the circle domain puts it; a loop without any is turned as the similarity that fits what is prescribed
/// turns it.
/// @throw Error bad_boundary where the ends of arcs do not lie on the curve, or not in their order
std::vector<SlidingLoop> places_on_curves(const Surface& source, const CircleDomainChart& domain,
                                          const MixedBoundary& boundary);

/// A map from which the boundary can slide: the harmonic map with boundary vertices at places_on_curves(). Where that
/// has folds, loops without held vertices first turn until the energy
/// of the harmonic map is least; folds that stay are opened with the boundary fixed. Pinned points inside are then
/// pushed straight to their places, with what is around them.
/// @return flips are those of the harmonic map, before anything inside is pushed to its place; curves are not set
/// @throw Error as places_on_curves
SlidingStart mixed_start(const Surface& source, const CircleDomainChart& domain, const MixedBoundary& boundary);

/// The same from a given map, folded or not: sliding vertices go to the nearest points of their curves
/// (given_start.h), what is prescribed to its place, the rest stays where that leaves no folds.
/// @param map #V values in the target's plane
/// @throw Error bad_option unless there is a finite value for every vertex; bad_boundary: a loop that does not run
/// around
///        its curve once
SlidingStart mixed_start(const Surface& source, const MixedBoundary& boundary, const Eigen::VectorXcd& map);

}  // namespace beltrami
