#include <beltrami/homotopy/homotopy.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <queue>
#include <string>
#include <utility>

#include <beltrami/base/error.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/plane/inside_polygon.h>
#include <beltrami/plane/polygon.h>

namespace beltrami {

namespace {

/// Lengths that differ by less than this part of them count as equal.
constexpr double kTie = 1e-9;

/// Neighbours of every vertex along edges.
struct Adjacency {
    std::vector<int> offsets, neighbours;
};

Adjacency adjacency(const Surface& source) {
    Adjacency result;
    result.offsets.assign(source.mesh.vertex_count() + 1, 0);
    for (const auto& [a, b] : source.topology.edges) ++result.offsets[a + 1], ++result.offsets[b + 1];
    for (int v = 0; v < source.mesh.vertex_count(); ++v) result.offsets[v + 1] += result.offsets[v];
    result.neighbours.resize(result.offsets.back());
    std::vector<int> next(result.offsets.begin(), result.offsets.end() - 1);
    for (const auto& [a, b] : source.topology.edges) {
        result.neighbours[next[a]++] = b;
        result.neighbours[next[b]++] = a;
    }
    return result;
}

double distance_to_segment(Complex p, Complex a, Complex b) {
    const double square = std::norm(b - a);
    const double t = square > 0 ? std::clamp(std::real(std::conj(b - a) * (p - a)) / square, 0.0, 1.0) : 0.0;
    return std::abs(p - a - t * (b - a));
}

/// Whether the line from a to b meets the edge from c to d, touching included.
bool meets(Complex a, Complex b, Complex c, Complex d) {
    return (signed_area(a, b, c) * signed_area(a, b, d) < 0 && signed_area(c, d, a) * signed_area(c, d, b) < 0) ||
           distance_to_segment(c, a, b) <= kTie * std::abs(b - a);
}

struct Pair {
    int outer = -1, hole = -1;
    double distance = 0;
};

/// The nearest vertices of outer loop and hole whose straight line crosses no other hole; {-1, -1} if there are none.
Pair nearest_pair(const Surface& source, const Eigen::VectorXcd& z, int outer_loop, int hole) {
    const auto& loops = source.topology.boundary_loops;
    std::vector<Pair> pairs;
    for (const int h : loops[hole]) {
        Pair best{-1, h, std::numeric_limits<double>::infinity()};
        for (const int o : loops[outer_loop]) {
            const double d = std::abs(z[o] - z[h]);
            if (d < best.distance * (1 - kTie) || (d < best.distance * (1 + kTie) && o < best.outer))
                best.outer = o, best.distance = std::min(d, best.distance);
        }
        pairs.push_back(best);
    }
    std::sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) { return a.distance < b.distance; });
    const auto blocked = [&](const Pair& pair) {
        for (int l = 0; l < static_cast<int>(loops.size()); ++l) {
            if (l == outer_loop || l == hole) continue;
            for (std::size_t i = 0; i < loops[l].size(); ++i)
                if (meets(z[pair.outer], z[pair.hole], z[loops[l][i]], z[loops[l][(i + 1) % loops[l].size()]]))
                    return true;
        }
        return false;
    };
    Pair result;
    for (const Pair& pair : pairs) {
        if (result.hole >= 0 && pair.distance > result.distance * (1 + kTie)) break;
        if ((result.hole < 0 || pair.hole < result.hole) && !blocked(pair))
            result = {pair.outer, pair.hole, result.hole < 0 ? pair.distance : result.distance};
    }
    return result;
}

/// Dijkstra's shortest path of edges from the hole to the outer loop; of equal ones the one through smaller vertices.
/// With a pair of ends an edge costs more the farther it lies from their straight line.
std::vector<int> shortest_path(const Surface& source, const Adjacency& graph, const Eigen::VectorXcd& z, int outer_loop,
                               int hole, const Pair& pair) {
    const int n = source.mesh.vertex_count();
    std::vector<double> cost(n, std::numeric_limits<double>::infinity());
    std::vector<int> parent(n, -1);
    std::vector<char> is_goal(n, 0), done(n, 0);
    double total = 0;
    for (const auto& [a, b] : source.topology.edges) total += std::abs(z[a] - z[b]);
    const double mean = total / source.topology.edge_count();
    using Entry = std::pair<double, int>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    const auto begin = [&](int v) {
        cost[v] = 0;
        queue.emplace(0.0, v);
    };
    if (pair.hole >= 0) {
        begin(pair.hole);
        is_goal[pair.outer] = 1;
    } else {
        for (const int v : source.topology.boundary_loops[hole]) begin(v);
        for (const int v : source.topology.boundary_loops[outer_loop]) is_goal[v] = 1;
    }
    while (!queue.empty()) {
        const auto [here, v] = queue.top();
        queue.pop();
        if (done[v]) continue;
        done[v] = 1;
        if (is_goal[v]) {
            std::vector<int> path;
            for (int at = v; at >= 0; at = parent[at]) path.push_back(at);
            return path;
        }
        for (int i = graph.offsets[v]; i < graph.offsets[v + 1]; ++i) {
            const int w = graph.neighbours[i];
            if (done[w]) continue;
            double step = std::abs(z[w] - z[v]);
            if (pair.hole >= 0)
                step *= 1 + distance_to_segment(0.5 * (z[v] + z[w]), z[pair.hole], z[pair.outer]) / mean;
            // Other boundary vertices only where there is no other way.
            if (source.topology.on_boundary[w] && !is_goal[w]) step += total;
            if (here + step < cost[w] || (here + step == cost[w] && v < parent[w])) {
                cost[w] = here + step;
                parent[w] = v;
                queue.emplace(cost[w], w);
            }
        }
    }
    throw Error(Cause::bad_mesh,
                "boundary loop " + std::to_string(hole) + " is not connected with loop " + std::to_string(outer_loop),
                "map each component on its own", {Things::loops, {hole}});
}

}  // namespace

std::vector<LoopPath> loop_paths(const Surface& source, const Eigen::VectorXcd& positions, int outer_loop) {
    const int loops = static_cast<int>(source.topology.boundary_loops.size());
    if (outer_loop < 0 || outer_loop >= loops)
        throw Error(Cause::bad_option,
                    "the outer loop is given as " + std::to_string(outer_loop) + ", but there are " +
                        std::to_string(loops) + " boundary loops",
                    "loops are counted from 0");
    std::vector<LoopPath> paths;
    if (loops < 2) return paths;
    const Adjacency graph = adjacency(source);
    for (int hole = 0; hole < loops; ++hole)
        if (hole != outer_loop)
            paths.push_back({hole, shortest_path(source, graph, positions, outer_loop, hole,
                                                 nearest_pair(source, positions, outer_loop, hole))});
    return paths;
}

double smallest_angle(Complex from, Complex to, Complex centre) {
    const double angle = std::arg((to - centre) / (from - centre));
    return angle < -std::numbers::pi + kTie ? angle + 2 * std::numbers::pi : angle;
}

std::vector<Complex> loop_images(const std::vector<int>& loop, const Eigen::VectorXcd& map) {
    std::vector<Complex> images;
    images.reserve(loop.size());
    for (const int v : loop) images.push_back(map[v]);
    return images;
}

HomotopyClass homotopy_class(const Surface& source, const Eigen::VectorXcd& positions, const Eigen::VectorXcd& map,
                             int outer_loop) {
    return homotopy_class(source, loop_paths(source, positions, outer_loop), map, outer_loop);
}

HomotopyClass homotopy_class(const Surface& source, const std::vector<LoopPath>& paths, const Eigen::VectorXcd& map,
                             int outer_loop) {
    if (source.topology.genus != 0)
        throw Error(Cause::bad_mesh,
                    "the surface has genus " + std::to_string(source.topology.genus) +
                        "; turns are counted on surfaces of genus 0 only",
                    "cut the handles open");
    const Distortion distortion = beltrami::distortion(source.operators, map);
    std::vector<char> at_fold(source.mesh.vertex_count(), 0);
    for (const auto* faces : {&distortion.flipped, &distortion.degenerate})
        for (const int face : *faces)
            for (const int v : source.mesh.faces[face]) at_fold[v] = 1;

    HomotopyClass result;
    result.outer_loop = outer_loop;
    for (const LoopPath& path : paths) {
        const Complex centre = point_inside(loop_images(source.topology.boundary_loops[path.loop], map));
        HoleTurns hole;
        hole.loop = path.loop;
        hole.outer_vertex = path.vertices.front();
        hole.hole_vertex = path.vertices.back();
        hole.angle = turning_angle(loop_images(path.vertices, map), centre);
        const double smallest = smallest_angle(map[hole.outer_vertex], map[hole.hole_vertex], centre);
        hole.turns = static_cast<int>(std::lround((hole.angle - smallest) / (2 * std::numbers::pi)));
        hole.meaningful = std::none_of(path.vertices.begin(), path.vertices.end(), [&](int v) { return at_fold[v]; });
        result.holes.push_back(hole);
    }
    return result;
}

bool HomotopyClass::same_turns(const HomotopyClass& other) const {
    return std::equal(holes.begin(), holes.end(), other.holes.begin(), other.holes.end(),
                      [](const HoleTurns& a, const HoleTurns& b) {
                          return a.loop == b.loop && a.turns == b.turns && a.meaningful && b.meaningful;
                      });
}

}  // namespace beltrami
