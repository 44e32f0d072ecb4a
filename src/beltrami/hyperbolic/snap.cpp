#include <beltrami/hyperbolic/snap.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <vector>

#include <beltrami/hyperbolic/target_walk.h>

namespace beltrami {

namespace {

constexpr int kMostTurns = 10;  // from half-edge to half-edge near the end of a walk

/// The way from one half-edge to another one nearby.
std::optional<DiskIsometry> way_between(const HyperbolicSurface& target, int from, int to) {
    struct Reached {
        int halfedge, turns;
        DiskIsometry way;
    };
    std::vector<Reached> reached{{from, 0, {}}};
    for (std::size_t i = 0; i < reached.size(); ++i) {
        const Reached here = reached[i];
        if (here.halfedge == to) return here.way;
        if (here.turns == kMostTurns) continue;
        const DiskIsometry way = here.way * target.delaunay_steps[static_cast<std::size_t>(here.halfedge)];
        for (const int h : {IntrinsicTriangulation::next(here.halfedge), target.delaunay.twin(here.halfedge)})
            if (std::ranges::none_of(reached, [&](const Reached& other) { return other.halfedge == h; }))
                reached.push_back({h, here.turns + 1, way});
    }
    return {};
}

}  // namespace

double snap_to_target(const Surface& source, const HyperbolicSurface& target, EquivariantMap& map) {
    constexpr double lost = std::numeric_limits<double>::infinity();
    const std::vector<int> first = detail::first_halfedges(target);
    std::vector<int> at(map.bases.size());
    for (std::size_t v = 0; v < at.size(); ++v) {
        const detail::TargetWalk walk = detail::walk(target, first[map.bases[v]], map.frames[v]);
        if (walk.halfedge < 0) return lost;
        at[v] = walk.halfedge;
        map.bases[v] = target.delaunay.tail(walk.halfedge);
        map.frames[v] = walk.frame.normalized();
    }
    double largest = 0;
    for (std::size_t e = 0; e < map.steps.size(); ++e) {
        const auto [a, b] = source.topology.edges[e];
        const detail::TargetWalk walk = detail::walk(target, at[a], map.frames[a] * map.steps[e]);
        if (walk.halfedge < 0) return lost;
        // The triangle of the other end, or, by rounding, one beside it.
        const std::optional<DiskIsometry> rest = way_between(target, walk.halfedge, at[b]);
        if (!rest) return lost;
        const DiskIsometry exact = (map.frames[a].inverse() * walk.way * *rest * map.frames[b]).normalized();
        largest = std::max(largest, (map.steps[e].inverse() * exact).from_identity());
        map.steps[e] = exact;
    }
    return largest;
}

}  // namespace beltrami
