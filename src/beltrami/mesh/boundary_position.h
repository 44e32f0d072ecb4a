#pragma once

#include <optional>

#include <beltrami/base/public.h>
#include <beltrami/mesh/topology.h>

namespace beltrami BELTRAMI_PUBLIC {

/// Where a vertex stands on the boundary.
struct BoundaryPosition {
    int loop;      ///< of Topology::boundary_loops
    int position;  ///< in that loop
};

/// @return nothing for vertices that are not on the boundary
std::optional<BoundaryPosition> boundary_position(const Topology& topology, int vertex);

}  // namespace beltrami
