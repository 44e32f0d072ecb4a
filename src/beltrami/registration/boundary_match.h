#pragma once

#include <span>
#include <vector>

#include <beltrami/charts/circle_domain_chart.h>
#include <beltrami/operators/surface.h>
#include <beltrami/registration/drawn_surface.h>

namespace beltrami {

/// Two surfaces with boundary drawn in the plane z = 1 as one of them lies on the other's circle domain. Boundary
/// vertices of both are on the circles; each surface's boundary edges are bent at those of the other, so that both have
/// the same boundary.
struct BoundaryMatch {
    Positions source, target;  ///< #V×3 each
    std::vector<BoundaryPoint> source_bends, target_bends;
    /// Beside every vertex of the source and then every bend of it the number of the vertex or bend of the target that
    /// is the same point; −1: none.
    std::vector<int> partners;
};

/// @param places #V of the source, on the target's faces; a loop whose vertices do not run around one of the target's
///               once is left as it is
BoundaryMatch match_boundaries(const Surface& source, const Surface& target, const CircleDomainChart& circles,
                               std::span<const MeshPoint> places);

}  // namespace beltrami
