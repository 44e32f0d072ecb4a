#include <beltrami/mesh/boundary_position.h>

#include <algorithm>

namespace beltrami {

std::optional<BoundaryPosition> boundary_position(const Topology& topology, int vertex) {
    for (std::size_t l = 0; l < topology.boundary_loops.size(); ++l) {
        const auto& loop = topology.boundary_loops[l];
        const auto at = std::find(loop.begin(), loop.end(), vertex);
        if (at != loop.end()) return BoundaryPosition{static_cast<int>(l), static_cast<int>(at - loop.begin())};
    }
    return {};
}

}  // namespace beltrami
