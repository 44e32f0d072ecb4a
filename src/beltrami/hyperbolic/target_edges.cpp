#include <beltrami/hyperbolic/target_edges.h>

#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <string>
#include <utility>

#include <beltrami/base/error.h>

namespace beltrami::detail {

TargetEdges::TargetEdges(const EdgeGroup& target)
    : target_(target),
      from_(static_cast<std::size_t>(target.triangulation.vertex_count())),
      edges_(static_cast<std::size_t>(target.triangulation.halfedge_count()), -1),
      distance_(from_.size(), std::numeric_limits<double>::infinity()),
      arrived_by_(from_.size(), -1) {
    // Of a doubled surface those of the one half.
    const int all = target.triangulation.halfedge_count(), own = target.topology.boundary_loops.empty() ? all : all / 2;
    for (int h = 0; h < all; ++h) {
        if (h >= own && target.triangulation.twin(h) >= own) continue;
        edges_[h] = edge_between(target.topology, target.triangulation.tail(h), target.triangulation.head(h));
        if (edges_[h] >= 0) from_[target.triangulation.tail(h)].push_back(h);  // else the diagonal of a quad
    }
}

MarkedStep TargetEdges::along_boundary(int a, int b) {
    if (places_.empty()) place_on_loops();
    const Place from = places_[a], to = places_[b];
    if (from.loop < 0 || from.loop != to.loop)
        throw Error(Cause::bad_option,
                    "a boundary edge of the source has its ends near vertices " + std::to_string(a) + " and " +
                        std::to_string(b) + " of the target, which lie on no common boundary loop",
                    "bring the source nearer to the target", {Things::vertices, {a, b}});
    const std::vector<int>& loop = target_.topology.boundary_loops[static_cast<std::size_t>(from.loop)];
    const auto size = static_cast<int>(loop.size());
    const double around = loop_lengths_[static_cast<std::size_t>(from.loop)];
    double ahead = to.length - from.length;
    if (ahead < 0) ahead += around;
    const bool forward = 2 * ahead <= around;
    MarkedStep result = nowhere();
    for (int i = from.index; i != to.index;) {
        const int next = (i + (forward ? 1 : size - 1)) % size;
        result = result * along(halfedge(loop[static_cast<std::size_t>(i)], loop[static_cast<std::size_t>(next)]));
        i = next;
    }
    return result;
}

MarkedStep TargetEdges::between(int a, int b) {
    MarkedStep result = nowhere();
    if (a == b) return result;
    search(a, b);
    std::vector<int> path;
    for (int v = b; v != a; v = target_.triangulation.tail(path.back())) path.push_back(arrived_by_[v]);
    for (auto h = path.rbegin(); h != path.rend(); ++h) result = result * along(*h);
    for (const int v : touched_) {
        distance_[v] = std::numeric_limits<double>::infinity();
        arrived_by_[v] = -1;
    }
    touched_.clear();
    return result;
}

void TargetEdges::place_on_loops() {
    places_.resize(from_.size());
    const std::vector<std::vector<int>>& loops = target_.topology.boundary_loops;
    for (std::size_t l = 0; l < loops.size(); ++l) {
        double length = 0;
        for (std::size_t i = 0; i < loops[l].size(); ++i) {
            places_[loops[l][i]] = {static_cast<int>(l), static_cast<int>(i), length};
            const int h = halfedge(loops[l][i], loops[l][(i + 1) % loops[l].size()]);
            length += std::exp(target_.triangulation.log_length(h));
        }
        loop_lengths_.push_back(length);
    }
}

void TargetEdges::search(int a, int b) {
    using Entry = std::pair<double, int>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    distance_[a] = 0;
    touched_.push_back(a);
    queue.emplace(0, a);
    while (!queue.empty()) {
        const auto [distance, v] = queue.top();
        queue.pop();
        if (v == b) return;
        if (distance > distance_[v]) continue;
        for (const int h : from_[v]) {
            const int w = target_.triangulation.head(h);
            const double longer = distance + std::exp(target_.triangulation.log_length(h));
            if (!(longer < distance_[w])) continue;
            if (std::isinf(distance_[w])) touched_.push_back(w);
            distance_[w] = longer;
            arrived_by_[w] = h;
            queue.emplace(longer, w);
        }
    }
}

}  // namespace beltrami::detail
