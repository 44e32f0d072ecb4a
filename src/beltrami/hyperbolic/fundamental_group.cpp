#include <beltrami/hyperbolic/fundamental_group.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <queue>
#include <tuple>

#include <beltrami/hyperbolic/halfedges.h>

namespace beltrami {

namespace {

using Entry = std::tuple<double, int, int>;  // cost, number, half-edge
using Heap = std::priority_queue<Entry, std::vector<Entry>, std::greater<>>;

std::vector<std::vector<int>> halfedges_from(const IntrinsicTriangulation& triangulation) {
    std::vector<std::vector<int>> result(static_cast<std::size_t>(triangulation.vertex_count()));
    for (int h = 0; h < triangulation.halfedge_count(); ++h) result[triangulation.tail(h)].push_back(h);
    return result;
}

/// Prim's tree from the root. @return flags of its half-edges
std::vector<char> grow_vertex_tree(const IntrinsicTriangulation& triangulation, const std::vector<double>& costs,
                                   const std::vector<char>& barred, CutTree& tree) {
    const std::vector<std::vector<int>> from = halfedges_from(triangulation);
    tree.to_vertex.assign(from.size(), -1);
    tree.order = {tree.root};
    std::vector<char> seen(from.size(), 0), taken(costs.size(), 0);
    seen[tree.root] = 1;
    Heap heap;
    int count = 0;
    const auto push_from = [&](int v) {
        for (const int h : from[v])
            if (barred.empty() || !barred[h]) heap.emplace(costs[h], count++, h);
    };
    push_from(tree.root);
    while (!heap.empty()) {
        const int h = std::get<2>(heap.top());
        heap.pop();
        const int v = triangulation.head(h);
        if (seen[v]) continue;
        seen[v] = 1;
        tree.to_vertex[v] = h;
        taken[h] = taken[triangulation.twin(h)] = 1;
        tree.order.push_back(v);
        push_from(v);
    }
    return taken;
}

/// The tree of triangles, dearest edges first.
void grow_triangle_tree(const IntrinsicTriangulation& triangulation, const std::vector<double>& costs,
                        std::vector<char>& taken, CutTree& tree) {
    tree.to_triangle.assign(static_cast<std::size_t>(triangulation.triangle_count()), -1);
    tree.triangle_order = {0};
    std::vector<char> seen(tree.to_triangle.size(), 0);
    seen[0] = 1;
    Heap heap;
    int count = 0;
    const auto push_from = [&](int t) {
        for (int k = 0; k < 3; ++k) heap.emplace(-costs[3 * t + k], count++, 3 * t + k);
    };
    push_from(0);
    while (!heap.empty()) {
        const int h = std::get<2>(heap.top());
        heap.pop();
        const int twin = triangulation.twin(h), t = twin / 3;
        if (taken[h] || seen[t]) continue;
        seen[t] = 1;
        tree.to_triangle[t] = twin;
        taken[h] = taken[twin] = 1;
        tree.triangle_order.push_back(t);
        push_from(t);
    }
}

}  // namespace

double not_closed(const MarkedStep& step) {
    return step.isometry.from_identity() + (step.homology.size() > 0 ? step.homology.cwiseAbs().maxCoeff() : 0);
}

CutTree cut_tree(const IntrinsicTriangulation& triangulation, int root, const std::vector<double>& costs,
                 const std::vector<int>& first, const std::vector<char>& barred) {
    CutTree tree;
    tree.root = root;
    std::vector<double> ranked = costs;
    for (const int h : first) ranked[h] = ranked[triangulation.twin(h)] = -std::numeric_limits<double>::infinity();
    std::vector<char> taken = grow_vertex_tree(triangulation, ranked, barred, tree);
    for (std::size_t h = 0; h < barred.size(); ++h) taken[h] = taken[h] || barred[h];
    std::vector<char> used = taken;
    grow_triangle_tree(triangulation, costs, used, tree);
    for (int h = 0; h < triangulation.halfedge_count(); ++h)
        if (h < triangulation.twin(h) && (!used[h] || (!barred.empty() && barred[h]))) tree.generators.push_back(h);
    return tree;
}

namespace {

/// The shortest paths from a root, and what loops cost that go along them and across an edge.
struct ShortestPaths {
    std::vector<double> distance;
    std::vector<int> arrived_by;  ///< #vertices the last half-edge; −1: root, or not reached
    std::vector<double> loops;    ///< #halfedges

    ShortestPaths(const IntrinsicTriangulation& triangulation, const std::vector<double>& lengths, int root);
};

ShortestPaths::ShortestPaths(const IntrinsicTriangulation& triangulation, const std::vector<double>& lengths,
                             int root) {
    constexpr double infinite = std::numeric_limits<double>::infinity();
    const std::vector<std::vector<int>> from = halfedges_from(triangulation);
    distance.assign(from.size(), infinite);
    arrived_by.assign(from.size(), -1);
    using Reached = std::tuple<double, int>;
    std::priority_queue<Reached, std::vector<Reached>, std::greater<>> queue;
    distance[root] = 0;
    queue.emplace(0, root);
    while (!queue.empty()) {
        const auto [d, v] = queue.top();
        queue.pop();
        if (d > distance[v]) continue;
        for (const int h : from[v]) {
            const int w = triangulation.head(h);
            const double longer = d + lengths[h];
            if (!(longer < distance[w])) continue;
            distance[w] = longer;
            arrived_by[w] = h;
            queue.emplace(longer, w);
        }
    }
    loops.resize(lengths.size());
    for (int h = 0; h < triangulation.halfedge_count(); ++h)
        loops[h] = distance[triangulation.tail(h)] + lengths[h] + distance[triangulation.head(h)];
}

}  // namespace

CutTree short_cut_tree(const IntrinsicTriangulation& triangulation, const std::vector<double>& lengths, int root) {
    const ShortestPaths paths(triangulation, lengths, root);
    std::vector<int> tree;
    for (const int h : paths.arrived_by)
        if (h >= 0) tree.push_back(h);
    return cut_tree(triangulation, root, paths.loops, tree);
}

CutTree short_cut_tree_with_boundary(const HyperbolicSurface& metric, const std::vector<double>& lengths, int root) {
    const IntrinsicTriangulation& triangulation = metric.original;
    const int own = triangulation.halfedge_count() / 2;
    const ShortestPaths paths(triangulation, lengths, root);
    CutTree tree;
    tree.root = root;
    tree.to_vertex = paths.arrived_by;
    for (std::size_t v = 0; v < tree.to_vertex.size(); ++v)
        if (paths.distance[v] < std::numeric_limits<double>::infinity()) tree.order.push_back(static_cast<int>(v));
    std::ranges::stable_sort(tree.order, {}, [&](int v) { return paths.distance[v]; });
    std::vector<char> taken(lengths.size(), 0);
    const auto take = [&](int h) { taken[h] = taken[triangulation.twin(h)] = 1; };
    for (const int h : tree.to_vertex)
        if (h >= 0) take(h);
    // From outside over the boundary into the triangles, across the dearest edges first.
    tree.to_triangle.assign(static_cast<std::size_t>(metric.own_triangles()), -1);
    std::vector<char> seen(tree.to_triangle.size(), 0);
    Heap heap;
    int count = 0;
    for (int h = 0; h < own; ++h)
        if (triangulation.twin(h) >= own) heap.emplace(-paths.loops[h], count++, h);
    while (!heap.empty()) {
        const int h = std::get<2>(heap.top()), t = h / 3;
        heap.pop();
        if (taken[h] || seen[t]) continue;
        seen[t] = 1;
        take(h);
        tree.to_triangle[t] = h;
        for (int k = 0; k < 3; ++k)
            if (const int g = triangulation.twin(3 * t + k); g < own && !taken[g])
                heap.emplace(-paths.loops[g], count++, g);
    }
    for (int h = 0; h < own; ++h)
        if (!taken[h] && h < triangulation.twin(h)) tree.generators.push_back(h);
    return tree;
}

std::vector<double> edge_lengths(const Topology& topology, const HyperbolicSurface& metric) {
    const IntrinsicTriangulation& triangulation = metric.original;
    std::vector<double> result(metric.steps.size());
    const int own = 3 * metric.own_triangles();
    for (int h = 0; h < triangulation.halfedge_count(); ++h)
        result[h] = (h < own || triangulation.twin(h) < own) &&
                            edge_between(topology, triangulation.tail(h), triangulation.head(h)) >= 0
                        ? metric.step(h).distance()
                        : std::numeric_limits<double>::infinity();
    return result;
}

std::vector<std::vector<int>> generator_paths(const IntrinsicTriangulation& triangulation, const CutTree& tree) {
    const auto to_root = [&](int v) {
        std::vector<int> path{v};
        while (tree.to_vertex[path.back()] >= 0) path.push_back(triangulation.tail(tree.to_vertex[path.back()]));
        return path;
    };
    std::vector<std::vector<int>> paths;
    for (const int h : tree.generators) {
        std::vector<int> path = to_root(triangulation.tail(h));
        std::reverse(path.begin(), path.end());
        const std::vector<int> back = to_root(triangulation.head(h));
        path.insert(path.end(), back.begin(), back.end());
        path.pop_back();  // the root again
        paths.push_back(std::move(path));
    }
    return paths;
}

std::vector<Letter> boundary_word(const IntrinsicTriangulation& triangulation, const CutTree& tree) {
    std::vector<int> letter(static_cast<std::size_t>(triangulation.halfedge_count()), -1);
    for (std::size_t j = 0; j < tree.generators.size(); ++j)
        letter[tree.generators[j]] = letter[triangulation.twin(tree.generators[j])] = static_cast<int>(j);
    std::vector<char> crossed(letter.size(), 0);
    for (const int h : tree.to_triangle)
        if (h >= 0) crossed[h] = crossed[triangulation.twin(h)] = 1;
    std::vector<Letter> word;
    const int first = tree.generators.front();
    int h = first;
    do {
        if (letter[h] >= 0) word.push_back({letter[h], h != tree.generators[static_cast<std::size_t>(letter[h])]});
        h = next_halfedge(h);
        while (crossed[h]) h = next_halfedge(triangulation.twin(h));
    } while (h != first);
    return word;
}

std::vector<DiskIsometry> generator_isometries(const IntrinsicTriangulation& triangulation, const CutTree& tree,
                                               const std::vector<DiskIsometry>& steps) {
    std::vector<DiskIsometry> at(tree.to_vertex.size()), result;
    for (const int v : tree.order)
        if (const int h = tree.to_vertex[v]; h >= 0) at[v] = (at[triangulation.tail(h)] * steps[h]).normalized();
    for (const int h : tree.generators)
        result.push_back((at[triangulation.tail(h)] * steps[h] * at[triangulation.head(h)].inverse()).normalized());
    return result;
}

double fill_by_flatness(const IntrinsicTriangulation& triangulation, const CutTree& tree,
                        std::vector<MarkedStep>& steps) {
    for (auto t = tree.triangle_order.rbegin(); t != tree.triangle_order.rend(); ++t) {
        const int h = tree.to_triangle[*t];
        if (h < 0) continue;
        steps[h] = (steps[next_halfedge(h)] * steps[previous_halfedge(h)]).inverse();
        steps[triangulation.twin(h)] = steps[h].inverse();
    }
    const int root = 3 * tree.triangle_order.front();
    return not_closed(steps[root] * steps[root + 1] * steps[root + 2]);
}

std::vector<MarkedStep> halfedge_steps(const Surface& source, const EquivariantMap& map) {
    const std::vector<int>& vertices = source.mesh.faces.vertices();
    std::vector<MarkedStep> steps;
    steps.reserve(vertices.size());
    for (std::size_t c = 0; c < vertices.size(); ++c) {
        const int edge = source.topology.corner_edges[c];
        const MarkedStep along{map.steps[static_cast<std::size_t>(edge)], map.classes.row(edge)};
        steps.push_back(source.topology.edges[edge][0] == vertices[c] ? along : along.inverse());
    }
    return steps;
}

std::vector<MarkedStep> with_mirror_images(std::vector<MarkedStep> steps, const Topology& source) {
    if (source.boundary_loops.empty()) return steps;
    const auto own = static_cast<int>(steps.size());
    steps.resize(2 * steps.size(), steps.front());
    for (int h = 0; h < own; ++h)
        steps[IntrinsicTriangulation::mirrored(h, own)] =
            MarkedStep{steps[h].isometry.mirrored(), steps[h].homology}.inverse();
    return steps;
}

void set_halfedge_steps(const Surface& source, const std::vector<MarkedStep>& steps, EquivariantMap& map) {
    const std::vector<int>& vertices = source.mesh.faces.vertices();
    for (std::size_t c = 0; c < vertices.size(); ++c) {
        const int edge = source.topology.corner_edges[c];
        if (source.topology.edges[edge][0] != vertices[c]) continue;
        map.steps[static_cast<std::size_t>(edge)] = steps[c].isometry.normalized();
        map.classes.row(edge) = steps[c].homology;
    }
}

}  // namespace beltrami
