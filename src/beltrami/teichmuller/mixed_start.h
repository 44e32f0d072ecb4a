#pragma once

#include <beltrami/charts/circle_domain_chart.h>
#include <beltrami/solve/sliding_boundary.h>
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

/// The curve of the outer loop runs counter-clockwise, those of the others clockwise.
/// @throw Error bad_option unless there is an entry for every loop; bad_boundary naming arcs that do not lie on one
///        loop, and vertices that are neither prescribed nor have a curve
MixedBoundary mixed_boundary(const Surface& source, const MixedConditions& conditions);

/// A map from which boundaries can slide.
struct MixedStart {
    Eigen::VectorXcd map;
    std::vector<SlidingLoop> loops;  ///< those that slide
    int flips = 0;                   ///< of the harmonic map, before anything inside is pushed to its place
    bool unfolded = false;           ///< its folds were opened
    int factorizations = 0;
};

/// Every vertex that slides stands, between those of its loop that are held, where its angle in the circle domain puts
/// it; a loop without any is turned as the similarity that fits what is prescribed turns it. The start is the harmonic
/// map with these values on the boundary. Where that has folds, loops without held vertices first turn until the energy
/// of the harmonic map is least; folds that stay are opened with the boundary fixed. Pinned points inside are then
/// pushed straight to their places, with what is around them.
/// @throw Error bad_boundary where the ends of arcs do not lie on the curve, or not in their order
MixedStart mixed_start(const Surface& source, const CircleDomainChart& domain, const MixedBoundary& boundary);

}  // namespace beltrami
