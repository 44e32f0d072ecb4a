#include <beltrami/forms/tree_cotree.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

#include <beltrami/base/disjoint_sets.h>

namespace beltrami {

std::vector<double> edge_lengths(const Surface& surface) {
    const Positions corners = surface.metric ? *surface.metric : corner_positions(surface.mesh);
    const FaceList& faces = surface.mesh.faces;
    std::vector<double> lengths(surface.topology.edges.size());
    for (int f = 0; f < faces.size(); ++f)
        for (int i = 0; i < faces.degree(f); ++i) {
            const int c = faces.first_corner(f) + i, next = faces.first_corner(f) + (i + 1) % faces.degree(f);
            lengths[surface.topology.corner_edges[c]] = (corners.row(next) - corners.row(c)).norm();
        }
    return lengths;
}

PathTree::PathTree(const Topology& topology, const std::vector<double>& lengths, int vertex_count, int from)
    : parents(static_cast<std::size_t>(vertex_count), -1),
      edges(parents.size(), -1),
      distances(parents.size(), std::numeric_limits<double>::infinity()),
      root(from) {
    std::vector<std::vector<int>> around(parents.size());
    for (int e = 0; e < topology.edge_count(); ++e)
        for (const int v : topology.edges[e]) around[v].push_back(e);
    using Entry = std::pair<double, int>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> waiting;
    distances[root] = 0;
    waiting.push({0, root});
    while (!waiting.empty()) {
        const auto [distance, v] = waiting.top();
        waiting.pop();
        if (distance > distances[v]) continue;
        for (const int e : around[v]) {
            const int w = topology.edges[e][0] == v ? topology.edges[e][1] : topology.edges[e][0];
            if (distance + lengths[e] >= distances[w]) continue;
            distances[w] = distance + lengths[e];
            parents[w] = v;
            edges[w] = e;
            waiting.push({distances[w], w});
        }
    }
}

std::vector<int> PathTree::path(int v) const {
    std::vector<int> result;
    for (; v >= 0; v = parents[v]) result.push_back(v);
    std::reverse(result.begin(), result.end());
    return result;
}

int PathTree::farthest() const {
    int best = root;
    for (std::size_t v = 0; v < distances.size(); ++v)
        if (std::isfinite(distances[v]) && distances[v] > distances[best]) best = static_cast<int>(v);
    return best;
}

EdgeRoles edge_roles(const Surface& surface, const PathTree& tree, const std::vector<double>& lengths) {
    const Topology& t = surface.topology;
    EdgeRoles result;
    result.of_edges.assign(t.edges.size(), EdgeRole::loop);
    for (const int e : tree.edges)
        if (e >= 0) result.of_edges[e] = EdgeRole::tree;
    std::vector<double> of_loop(t.edges.size());
    std::vector<int> order;
    for (int e = 0; e < t.edge_count(); ++e) {
        if (result.of_edges[e] == EdgeRole::tree) continue;
        of_loop[e] = tree.distances[t.edges[e][0]] + lengths[e] + tree.distances[t.edges[e][1]];
        order.push_back(e);
    }
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return of_loop[a] > of_loop[b]; });
    const int beyond = surface.mesh.face_count();
    DisjointSets joined(beyond + 1);
    for (const int e : order) {
        const int a = t.edge_faces[e][0] < 0 ? beyond : t.edge_faces[e][0];
        const int b = t.edge_faces[e][1] < 0 ? beyond : t.edge_faces[e][1];
        if (joined.find(a) == joined.find(b)) {
            result.loops.push_back(e);
        } else {
            joined.join(a, b);
            result.of_edges[e] = EdgeRole::cotree;
        }
    }
    std::reverse(result.loops.begin(), result.loops.end());
    return result;
}

}  // namespace beltrami
