#pragma once

#include <array>
#include <span>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/charts/chart_places.h>
#include <beltrami/constraints/boundary_condition.h>

namespace beltrami BELTRAMI_PUBLIC {

/// Where a surface's boundary goes on that of another surface.
struct BoundaryCorrespondence {
    std::vector<int> partner;  ///< of every boundary loop of the source, the loop of the target
    /// Of every boundary loop of the source, the places of its vertices on the target's boundary.
    std::vector<std::vector<BoundaryPlace>> places;
};

/// The correspondence of boundaries given by pairs of vertices: between two of them that follow each other on a loop
/// the source's boundary runs along the target's by arc length. One pair on a loop tells where it begins.
/// @param pairs (boundary vertex of the source, boundary vertex of the target), at least one on every loop
/// @throw Error bad_boundary naming vertices that are not on the boundary or have two partners, a loop without a pair,
///        pairs of one loop on two, pairs of two loops on one, different numbers of loops, and pairs that follow each
///        other in another order on the target
BoundaryCorrespondence boundary_correspondence(const Surface& source, const Surface& target,
                                               std::span<const std::array<int, 2>> pairs);

/// The boundary values of the map to the target's circle domain that belong to a correspondence: places between two
/// vertices of the target lie on the circle, at an angle between those of the vertices.
/// @param circles of the target
BoundaryCondition boundary_on_circles(const Surface& source, const Surface& target, const CircleDomainChart& circles,
                                      const BoundaryCorrespondence& correspondence);

}  // namespace beltrami
