#include <beltrami/certificate/branched_cover.h>

#include <algorithm>
#include <queue>

namespace beltrami {

namespace {

/// Edges of a chain from a vertex to the nearest one of the boundary.
std::vector<int> chain_to_boundary(const Topology& topology, const std::vector<std::vector<int>>& edges_at, int from) {
    std::vector<int> came_by(edges_at.size(), -2);  // edge; −1: the beginning, −2: not reached
    std::queue<int> queue;
    queue.push(from);
    came_by[from] = -1;
    while (!queue.empty()) {
        int v = queue.front();
        queue.pop();
        if (topology.on_boundary[v]) {
            std::vector<int> chain;
            while (came_by[v] >= 0) {
                const auto [a, b] = topology.edges[came_by[v]];
                chain.push_back(came_by[v]);
                v = v == a ? b : a;
            }
            return chain;
        }
        for (const int e : edges_at[v]) {
            const auto [a, b] = topology.edges[e];
            const int other = v == a ? b : a;
            if (came_by[other] != -2) continue;
            came_by[other] = e;
            queue.push(other);
        }
    }
    return {};
}

}  // namespace

std::vector<signed char> branched_signs(const Surface& source, const std::vector<int>& branches) {
    const Topology& topology = source.topology;
    const FaceList& faces = source.mesh.faces;
    const int vertices = source.mesh.vertex_count();
    std::vector<std::vector<int>> edges_at(static_cast<std::size_t>(vertices));
    for (int e = 0; e < topology.edge_count(); ++e)
        for (const int v : topology.edges[e]) edges_at[v].push_back(e);
    std::vector<char> changes(static_cast<std::size_t>(topology.edge_count()), 0);
    for (const int v : branches)
        for (const int e : chain_to_boundary(topology, edges_at, v)) changes[e] ^= 1;

    std::vector<std::vector<int>> corners_at(static_cast<std::size_t>(vertices));
    for (int c = 0; c < faces.corner_count(); ++c) corners_at[faces.vertices()[c]].push_back(c);
    std::vector<signed char> signs(static_cast<std::size_t>(faces.corner_count()), 0);
    std::vector<int> waiting;
    for (int v = 0; v < vertices; ++v) {
        if (corners_at[v].empty()) continue;
        // From corner to corner across the edges at v; at a branch the values are 0, and the signs mean nothing.
        const auto start = corners_at[v].front();
        signs[start] = 1;
        waiting.assign(1, start);
        while (!waiting.empty()) {
            const int c = waiting.back();
            waiting.pop_back();
            const int face = c / 3, last = 3 * face + (c + 2) % 3;
            for (const int e : {topology.corner_edges[c], topology.corner_edges[last]})
                for (const int f : topology.edge_faces[e]) {
                    if (f < 0 || f == face) continue;
                    for (int other = 3 * f; other < 3 * f + 3; ++other) {
                        if (faces.vertices()[other] != v || signs[other] != 0) continue;
                        signs[other] = static_cast<signed char>(changes[e] ? -signs[c] : signs[c]);
                        waiting.push_back(other);
                    }
                }
        }
    }
    return signs;
}

}  // namespace beltrami
