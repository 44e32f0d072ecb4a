#include "problems/noisy_copy.h"

#include <algorithm>

#include <beltrami/base/random.h>

namespace beltrami::bench {

namespace {

using Neighbours = std::vector<std::vector<int>>;

Neighbours neighbours_of(const Surface& surface) {
    Neighbours result(static_cast<std::size_t>(surface.mesh.vertex_count()));
    for (const auto& [a, b] : surface.topology.edges) {
        result[a].push_back(b);
        result[b].push_back(a);
    }
    return result;
}

/// Edges from the nearest of some vertices to every one.
std::vector<int> edges_from(const Neighbours& neighbours, const std::vector<int>& begin) {
    std::vector<int> distance(neighbours.size(), -1), queue = begin;
    for (const int v : begin) distance[v] = 0;
    for (std::size_t i = 0; i < queue.size(); ++i)
        for (const int w : neighbours[queue[i]])
            if (distance[w] < 0) distance[w] = distance[queue[i]] + 1, queue.push_back(w);
    return distance;
}

}  // namespace

NoisyCopy noisy_copy(const Surface& surface, const NoisyCopyOptions& options) {
    NoisyCopy result{surface.mesh, {}, 0};
    for (const auto& [a, b] : surface.topology.edges)
        result.edge +=
            (surface.mesh.positions.row(a) - surface.mesh.positions.row(b)).norm() / surface.topology.edge_count();
    Random random(options.seed);
    for (double& x : result.mesh.positions.reshaped()) x += options.noise * result.edge * random.uniform(-1, 1);

    const Neighbours neighbours = neighbours_of(surface);
    std::vector<int> taken;
    for (const auto& loop : surface.topology.boundary_loops) taken.insert(taken.end(), loop.begin(), loop.end());
    for (int i = 0; i < options.landmarks; ++i) {
        const std::vector<int> distance = edges_from(neighbours, taken);
        const int vertex = static_cast<int>(std::max_element(distance.begin(), distance.end()) - distance.begin());
        taken.push_back(vertex);
        const std::vector<int> from_it = edges_from(neighbours, {vertex});
        std::vector<int> ring;
        for (std::size_t v = 0; v < from_it.size(); ++v)
            if (from_it[v] == options.off) ring.push_back(static_cast<int>(v));
        const int place = ring[static_cast<std::size_t>(random.uniform() * static_cast<double>(ring.size()))];
        result.landmarks.push_back({vertex, place_of_vertex(result.mesh, place), options.weight});
    }
    return result;
}

}  // namespace beltrami::bench
