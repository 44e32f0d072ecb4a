#include <beltrami/hyperbolic/marking.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <deque>
#include <string>
#include <utility>

#include <beltrami/base/disjoint_sets.h>
#include <beltrami/base/error.h>
#include <beltrami/hyperbolic/fundamental_group.h>
#include <beltrami/hyperbolic/target_edges.h>

namespace beltrami {

namespace {

constexpr double kFlat = 1e-6;  // nothing is between rounding and a deck transformation

std::string short_number(double x) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2g", x);
    return text;
}

bool on_boundary(const Topology& topology, int edge) {
    const auto& [left, right] = topology.edge_faces[static_cast<std::size_t>(edge)];
    return left < 0 || right < 0;
}

/// Faces whose images do not close up.
std::vector<int> faces_not_flat(const Surface& source, const EquivariantMap& map) {
    const std::vector<MarkedStep> steps = halfedge_steps(source, map);
    std::vector<int> bad;
    for (std::size_t f = 0; 3 * f < steps.size(); ++f)
        if (!(not_closed(steps[3 * f] * steps[3 * f + 1] * steps[3 * f + 2]) < kFlat))
            bad.push_back(static_cast<int>(f));
    return bad;
}

/// How many faces every face is away from some (#F).
std::vector<int> distances_from(const IntrinsicTriangulation& triangulation, const std::vector<int>& faces) {
    std::vector<int> distance(static_cast<std::size_t>(triangulation.triangle_count()), triangulation.triangle_count());
    std::deque<int> queue(faces.begin(), faces.end());
    for (const int f : faces) distance[f] = 0;
    while (!queue.empty()) {
        const int f = queue.front();
        queue.pop_front();
        for (int k = 0; k < 3; ++k) {
            const int g = triangulation.twin(3 * f + k) / 3;
            if (distance[g] <= distance[f] + 1) continue;
            distance[g] = distance[f] + 1;
            queue.push_back(g);
        }
    }
    return distance;
}

/// How far steps along the boundary are from the boundary of the target.
double off_boundary(const Surface& source, const EquivariantMap& map) {
    double largest = 0;
    for (std::size_t e = 0; e < map.steps.size(); ++e)
        if (on_boundary(source.topology, static_cast<int>(e)))
            largest = std::max(largest, (map.steps[e].mirrored() * map.steps[e].inverse()).from_identity());
    return largest;
}

/// Keeps the steps of a tree and of generators that stay away from the bad faces; all others follow by flatness.
double mend(const Surface& source, const IntrinsicTriangulation& triangulation, std::vector<int> bad,
            EquivariantMap& map) {
    if (!source.topology.boundary_loops.empty()) {
        const std::size_t own = bad.size();
        for (std::size_t i = 0; i < own; ++i) bad.push_back(bad[i] + source.mesh.face_count());
    }
    const std::vector<int> distance = distances_from(triangulation, bad);
    std::vector<double> costs(static_cast<std::size_t>(triangulation.halfedge_count()));
    for (int h = 0; h < triangulation.halfedge_count(); ++h)
        costs[h] = 1.0 / (1 + std::min(distance[h / 3], distance[triangulation.twin(h) / 3]));
    const auto farthest = std::max_element(distance.begin(), distance.end()) - distance.begin();
    const CutTree tree = cut_tree(triangulation, triangulation.tail(3 * static_cast<int>(farthest)), costs);
    std::vector<MarkedStep> steps = with_mirror_images(halfedge_steps(source, map), source.topology);
    const double defect = fill_by_flatness(triangulation, tree, steps);
    set_halfedge_steps(source, steps, map);
    return std::max(defect, off_boundary(source, map));
}

EquivariantMap at_vertices(const std::vector<int>& images, int edges, int classes) {
    EquivariantMap map;
    map.steps.resize(static_cast<std::size_t>(edges));
    map.classes = Eigen::MatrixXi::Zero(edges, classes);
    map.bases = images;
    map.frames.resize(images.size());
    return map;
}

Error bad_path(const std::string& sentence, std::vector<int> vertices) {
    return {Cause::bad_option,
            sentence,
            "give closed paths of vertices along edges",
            {Things::vertices, std::move(vertices)}};
}

/// The holonomy of a closed path of the target.
MarkedStep around(const detail::TargetEdges& edges, const std::vector<int>& path) {
    MarkedStep result = edges.nowhere();
    for (std::size_t i = 0; i < path.size(); ++i) {
        const int a = path[i], b = path[(i + 1) % path.size()], h = edges.halfedge(a, b);
        if (h < 0)
            throw bad_path("no edge of the target joins vertices " + std::to_string(a) + " and " + std::to_string(b),
                           {a, b});
        result = result * edges.along(h);
    }
    return {result.isometry.normalized(), result.homology};
}

/// The half-edges along a closed path.
std::vector<int> halfedges_along(const IntrinsicTriangulation& triangulation, const std::vector<int>& path) {
    std::vector<int> result;
    std::vector<std::vector<int>> from(static_cast<std::size_t>(triangulation.vertex_count()));
    for (int h = 0; h < triangulation.halfedge_count(); ++h) from[triangulation.tail(h)].push_back(h);
    for (std::size_t i = 0; i < path.size(); ++i) {
        const int a = path[i], b = path[(i + 1) % path.size()];
        int found = -1;
        if (a >= 0 && a < triangulation.vertex_count())
            for (const int h : from[a])
                if (triangulation.head(h) == b) found = h;
        if (found < 0)
            throw bad_path("no edge of the source joins vertices " + std::to_string(a) + " and " + std::to_string(b),
                           {a, b});
        result.push_back(found);
    }
    return result;
}

/// The union of loops through one vertex: a tree, along which nothing moves, and one more edge for every loop, whose
/// step follows from the loop's image and from those before.
struct LoopSystem {
    const IntrinsicTriangulation& triangulation;
    DisjointSets sets;
    std::vector<int> in_tree;
    std::vector<char> barred, tree;  // flags of half-edges
    std::vector<MarkedStep> steps;

    LoopSystem(const IntrinsicTriangulation& of, const MarkedStep& nowhere)
        : triangulation(of),
          sets(of.vertex_count()),
          barred(static_cast<std::size_t>(of.halfedge_count()), 0),
          tree(barred),
          steps(barred.size(), nowhere) {}

    void add(const std::vector<int>& path, const MarkedStep& image) {
        const std::vector<int> along = halfedges_along(triangulation, path);
        int closing = -1;
        for (const int h : along) {
            const int twin = triangulation.twin(h), a = triangulation.tail(h), b = triangulation.head(h);
            if (h == closing || twin == closing)
                throw bad_path("a loop runs along an edge that only it has twice", {a, b});
            if (tree[h] || barred[h]) continue;
            if (sets.find(a) != sets.find(b)) {
                sets.join(a, b);
                in_tree.push_back(h);
                tree[h] = tree[twin] = 1;
            } else if (closing < 0) {
                closing = h;
                barred[h] = barred[twin] = 1;
            } else {
                throw bad_path("a loop crosses itself or the loops before it more than once", {a, b});
            }
        }
        if (closing < 0) throw bad_path("a loop is made of those before it", {path.front()});
        // before · closing · after = image
        MarkedStep before = steps[along[0]] * steps[along[0]].inverse(), after = before;
        bool passed = false;
        for (const int h : along) {
            if (h == closing)
                passed = true;
            else
                (passed ? after : before) = (passed ? after : before) * steps[h];
        }
        steps[closing] = before.inverse() * image * after.inverse();
        steps[triangulation.twin(closing)] = steps[closing].inverse();
    }
};

}  // namespace

Marking marking_by_vertices(const Surface& source, const IntrinsicTriangulation& triangulation, const EdgeGroup& target,
                            const std::vector<int>& images) {
    require_triangles(source);
    detail::TargetEdges edges(target);
    Marking marking{at_vertices(images, source.topology.edge_count(), edges.size())};
    for (int e = 0; e < source.topology.edge_count(); ++e) {
        const auto [a, b] = source.topology.edges[static_cast<std::size_t>(e)];
        const MarkedStep step = on_boundary(source.topology, e) ? edges.along_boundary(images[a], images[b])
                                                                : edges.between(images[a], images[b]);
        marking.map.steps[static_cast<std::size_t>(e)] = step.isometry.normalized();
        marking.map.classes.row(e) = step.homology;
    }
    std::vector<int> bad = faces_not_flat(source, marking.map);
    marking.mended = static_cast<int>(bad.size());
    if (bad.empty()) return marking;
    marking.defect = mend(source, triangulation, bad, marking.map);
    if (!(marking.defect < kFlat)) {
        const std::string faces = std::to_string(bad.size());
        throw Error(Cause::bad_option,
                    "no map takes the vertices near their images: around " + faces +
                        " faces these do not close up, and the loops far from there contradict each other (defect " +
                        short_number(marking.defect) + ")",
                    "bring the source nearer to the target, or give a start or loops", {Things::faces, std::move(bad)});
    }
    return marking;
}

Marking marking_by_loops(const Surface& source, const IntrinsicTriangulation& triangulation, const EdgeGroup& target,
                         const std::vector<std::vector<int>>& paths, const std::vector<std::vector<int>>& images) {
    require_triangles(source);
    if (!source.topology.boundary_loops.empty())
        throw Error(Cause::bad_option,
                    "loops tell the class of maps between closed surfaces, and these have a boundary",
                    "bring the source near the target, or give a start");
    const int genus = source.topology.genus;
    const auto wanted = 2 * static_cast<std::size_t>(genus);
    if (paths.size() != wanted || images.size() != wanted)
        throw Error(Cause::bad_option,
                    "a marking of genus " + std::to_string(genus) + " takes " + std::to_string(wanted) +
                        " loops and as many images, and there are " + std::to_string(paths.size()) + " and " +
                        std::to_string(images.size()),
                    "give generators of the fundamental group");
    const detail::TargetEdges edges(target);
    LoopSystem loops(triangulation, edges.nowhere());
    for (std::size_t i = 0; i < wanted; ++i) {
        if (paths[i].empty() || images[i].empty() || paths[i][0] != paths[0][0] || images[i][0] != images[0][0])
            throw bad_path("loops do not begin at one vertex", {});
        loops.add(paths[i], around(edges, images[i]));
    }
    const CutTree tree =
        cut_tree(triangulation, paths[0][0], std::vector<double>(loops.steps.size(), 1.0), loops.in_tree, loops.barred);
    if (tree.generators.size() != wanted ||
        static_cast<int>(tree.triangle_order.size()) != triangulation.triangle_count())
        throw Error(Cause::bad_option, "the loops do not cut the source open to a disk",
                    "give generators of the fundamental group");
    const std::vector<int> all_at(static_cast<std::size_t>(triangulation.vertex_count()), images[0][0]);
    Marking marking{at_vertices(all_at, source.topology.edge_count(), edges.size())};
    marking.defect = fill_by_flatness(triangulation, tree, loops.steps);
    if (!(marking.defect < kFlat))
        throw Error(Cause::bad_option,
                    "the loops contradict each other: what closes up on the source does not on the target (defect " +
                        short_number(marking.defect) + ")",
                    "loops must cross as their images do: turn one round, or exchange two");
    set_halfedge_steps(source, loops.steps, marking.map);
    return marking;
}

namespace {

/// Half-edges with one tail strictly between two of them, counter-clockwise.
std::vector<int> fan_between(const IntrinsicTriangulation& triangulation, int from, int to) {
    const auto next = [&](int h) { return triangulation.twin(IntrinsicTriangulation::previous(h)); };
    std::vector<int> fan;
    for (int h = next(from); h != to; h = next(h)) fan.push_back(h);
    return fan;
}

/// How a curve beside a closed path passes one of its vertices: on the left, or on the right where the surface ends on
/// the left; and the half-edges that it crosses there.
struct Passage {
    bool on_the_right = false;
    std::vector<int> crossed;

    /// @param own half-edges of the surface itself, the first ones
    Passage(const IntrinsicTriangulation& triangulation, int own, int ahead, int back) {
        crossed = fan_between(triangulation, ahead, back);
        if (ahead < own && std::ranges::all_of(crossed, [&](int h) { return h < own; })) return;
        on_the_right = true;
        crossed = fan_between(triangulation, back, ahead);
    }
};

}  // namespace

EquivariantMap twisted(const Surface& source, const IntrinsicTriangulation& triangulation, EquivariantMap map,
                       const std::vector<int>& path, int turns) {
    require_triangles(source);
    const std::vector<int> along = halfedges_along(triangulation, path);
    std::vector<char> visited(static_cast<std::size_t>(triangulation.vertex_count()), 0);
    for (const int v : path)
        if (visited[v]++) throw bad_path("the path meets vertex " + std::to_string(v) + " twice", {v});
    const auto own = static_cast<int>(source.mesh.faces.vertices().size());
    std::vector<Passage> passages;
    passages.reserve(along.size());
    for (std::size_t i = 0; i < along.size(); ++i)
        passages.emplace_back(triangulation, own, along[i],
                              triangulation.twin(along[(i + along.size() - 1) % along.size()]));
    const std::vector<MarkedStep> steps = with_mirror_images(halfedge_steps(source, map), source.topology);
    MarkedStep holonomy = steps[along[0]];
    for (std::size_t i = 1; i < along.size(); ++i) holonomy = holonomy * steps[along[i]];
    std::vector<MarkedStep> result = steps;
    const auto turn_first = [&](const MarkedStep& turn, int h) {
        result[h] = turn * result[h];
        result[triangulation.twin(h)] = result[h].inverse();
    };
    for (std::size_t i = 0; i < along.size(); ++i) {
        // What crosses the curve to its left first goes around it; counter to its direction that is a turn left. Where
        // the curve passes on the right of the path, what leaves the path crosses it to its right.
        const bool right = passages[i].on_the_right, next_right = passages[(i + 1) % along.size()].on_the_right;
        MarkedStep turn{{}, Eigen::RowVectorXi::Zero(map.classes.cols())};
        const bool against = (turns > 0) != right;
        for (int n = 0; n < std::abs(turns); ++n) turn = turn * (against ? holonomy.inverse() : holonomy);
        for (const int h : passages[i].crossed) turn_first(turn, h);
        if (right != next_right) turn_first(turn, along[i]);
        holonomy = steps[along[i]].inverse() * holonomy * steps[along[i]];
    }
    set_halfedge_steps(source, result, map);
    return map;
}

}  // namespace beltrami
