#include <beltrami/teichmuller/around_landmarks.h>

#include <algorithm>

#include <beltrami/certificate/edge_split.h>

namespace beltrami {

namespace {

/// #E 1 for the edges of faces at the vertices and of the rings around those.
std::vector<char> edges_around(const Surface& surface, std::span<const int> landmarks, int rings) {
    std::vector<char> edges(static_cast<std::size_t>(surface.topology.edge_count()), 0),
        reached(static_cast<std::size_t>(surface.mesh.vertex_count()), 0);
    for (const int v : landmarks) reached[v] = 1;
    for (int ring = 0; ring <= rings; ++ring) {
        std::vector<char> next = reached;
        for (int f = 0; f < surface.mesh.face_count(); ++f) {
            const auto corners = surface.mesh.faces[f];
            if (std::none_of(corners.begin(), corners.end(), [&](int v) { return reached[v] != 0; })) continue;
            for (int i = 0; i < 3; ++i) {
                edges[surface.topology.corner_edges[surface.mesh.faces.first_corner(f) + i]] = 1;
                next[corners[i]] = 1;
            }
        }
        reached = std::move(next);
    }
    return edges;
}

/// A map with the midpoints of the marked edges, in their order.
Positions with_midpoints(const Positions& map, const Topology& topology, const std::vector<char>& marked) {
    Positions result(map.rows() + std::count(marked.begin(), marked.end(), 1), 3);
    result.topRows(map.rows()) = map;
    Eigen::Index next = map.rows();
    for (int e = 0; e < topology.edge_count(); ++e)
        if (marked[e])
            result.row(next++) = (map.row(topology.edges[e][0]) + map.row(topology.edges[e][1])).normalized();
    return result;
}

void halve(const std::vector<char>& marked, AroundLandmarks& around) {
    for (Positions& map : around.maps) map = with_midpoints(map, around.surface.topology, marked);
    around.surface = split_edges(around.surface, {}, marked).surface;
}

}  // namespace

AroundLandmarks refined_around(const Surface& source, std::span<const int> landmarks, std::vector<Positions> maps,
                               Fineness fineness) {
    AroundLandmarks result{source, std::move(maps)};
    for (int halving = 0; halving < fineness.halvings; ++halving)
        halve(edges_around(result.surface, landmarks, fineness.rings), result);
    return result;
}

AroundLandmarks refined_everywhere(const Surface& source, std::vector<Positions> maps) {
    AroundLandmarks result{source, std::move(maps)};
    halve(std::vector<char>(static_cast<std::size_t>(source.topology.edge_count()), 1), result);
    return result;
}

}  // namespace beltrami
