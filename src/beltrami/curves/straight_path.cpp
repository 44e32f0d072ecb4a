#include <beltrami/curves/straight_path.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <queue>

#include <beltrami/base/error.h>

namespace beltrami {

namespace {

using Point = Eigen::Vector2d;

constexpr double kShorter = 1e-12;  // part by which a way has to be shorter
constexpr double kAtEnd = 1e-6;     // of an edge, nearer to an end of which a path meets the vertex
constexpr int kMostTurns = 100000;

/// An edge that a path crosses, its ends seen along the path.
struct Portal {
    int left, right;
};

/// A straight way from a vertex to another one through triangles; along an edge if it crosses none.
struct Straight {
    int from, to;
    std::vector<Portal> portals;
};

double cross(const Point& a, const Point& b, const Point& c) {
    return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// The corner of a triangle to the left of the side from a to b, from its lengths to both.
Point third_corner(const Point& a, const Point& b, double to_a, double to_b) {
    const double base = (b - a).norm(), along = (base * base + to_a * to_a - to_b * to_b) / (2 * base);
    const double height = std::sqrt(std::max(0.0, to_a * to_a - along * along));
    const Point x = (b - a) / base, y(-x.y(), x.x());
    return a + along * x + height * y;
}

/// A strip of triangles in the plane: the ends, and the ends of its portals.
struct Layout {
    Point from, to;
    std::vector<Point> left, right;
};

Layout lay_out(const CurveMesh& mesh, int from, int to, const std::vector<Portal>& portals) {
    Layout layout;
    layout.from = Point::Zero();
    if (portals.empty()) {
        layout.to = Point(mesh.length(from, to), 0);
        return layout;
    }
    Portal last = portals[0];
    Point right(mesh.length(from, last.right), 0);
    Point left = third_corner(layout.from, right, mesh.length(from, last.left), mesh.length(last.left, last.right));
    layout.left.push_back(left);
    layout.right.push_back(right);
    const auto beyond = [&](int vertex) {
        return third_corner(left, right, mesh.length(last.left, vertex), mesh.length(last.right, vertex));
    };
    for (std::size_t i = 1; i < portals.size(); ++i) {
        const Portal next = portals[i];
        if (next.left != last.left)
            left = beyond(next.left);
        else
            right = beyond(next.right);
        layout.left.push_back(left);
        layout.right.push_back(right);
        last = next;
    }
    layout.to = beyond(to);
    return layout;
}

/// A way pulled taut.
struct Taut {
    std::vector<Straight> parts;
    double length = 0;
};

/// Pulls the way through a strip taut: it bends at ends of portals.
Taut pulled(const CurveMesh& mesh, int from, int to, const std::vector<Portal>& portals) {
    const Layout layout = lay_out(mesh, from, to, portals);
    const int n = static_cast<int>(portals.size());
    const auto left_at = [&](int i) -> const Point& { return i < n ? layout.left[i] : layout.to; };
    const auto right_at = [&](int i) -> const Point& { return i < n ? layout.right[i] : layout.to; };
    struct Bend {
        int vertex, portal;
        Point at;
    };
    std::vector<Bend> bends{{from, 0, layout.from}};
    Point apex = layout.from, left = left_at(0), right = right_at(0);
    int left_index = 0, right_index = 0;
    bool left_at_apex = false, right_at_apex = false;
    const auto restart = [&](int vertex, int index, const Point& at) {
        bends.push_back({vertex, index, at});
        apex = left = right = at;
        left_index = right_index = index;
        left_at_apex = right_at_apex = true;
        return index;
    };
    for (int i = 1; i <= n; ++i) {
        if (right_at_apex || cross(apex, right, right_at(i)) >= 0) {
            if (right_at_apex || left_at_apex || cross(apex, left, right_at(i)) <= 0) {
                right = right_at(i);
                right_index = i;
                right_at_apex = (right - apex).squaredNorm() == 0;
            } else {
                i = restart(portals[left_index].left, left_index, left);
                continue;
            }
        }
        if (left_at_apex || cross(apex, left, left_at(i)) <= 0) {
            if (left_at_apex || right_at_apex || cross(apex, right, left_at(i)) >= 0) {
                left = left_at(i);
                left_index = i;
                left_at_apex = (left - apex).squaredNorm() == 0;
            } else {
                i = restart(portals[right_index].right, right_index, right);
                continue;
            }
        }
    }
    if (bends.back().vertex != to) bends.push_back({to, n, layout.to});
    Taut taut;
    for (std::size_t b = 1; b < bends.size(); ++b) {
        if (bends[b].vertex == bends[b - 1].vertex) continue;
        Straight part{bends[b - 1].vertex, bends[b].vertex, {}};
        for (int i = bends[b - 1].portal; i < std::min(n, bends[b].portal + 1); ++i) {
            const Portal& portal = portals[i];
            if (portal.left == part.from || portal.right == part.from || portal.left == part.to ||
                portal.right == part.to)
                continue;
            part.portals.push_back(portal);
        }
        taut.length += (bends[b].at - bends[b - 1].at).norm();
        taut.parts.push_back(std::move(part));
    }
    return taut;
}

void append(std::vector<Portal>& portals, const Portal& portal) {
    if (!portals.empty() && portals.back().left == portal.right && portals.back().right == portal.left)
        portals.pop_back();  // there and back
    else
        portals.push_back(portal);
}

/// The portals of two successive ways joined around the vertex between them on one side; nothing if the boundary is
/// there.
std::optional<std::vector<Portal>> around(const CurveMesh& mesh, const Straight& before, const Straight& after,
                                          bool on_left) {
    const int v = before.to;
    const auto side_of = [&](const Portal& portal) { return on_left ? portal.left : portal.right; };
    const bool along = before.portals.empty(), leaves_along = after.portals.empty();
    std::vector<Portal> portals = before.portals;
    int w = along ? before.from : side_of(before.portals.back());
    bool first = true;
    for (int turn = 0; turn < kMostTurns; ++turn) {
        if (leaves_along && w == after.to) break;
        if (!(along && first)) append(portals, on_left ? Portal{w, v} : Portal{v, w});
        first = false;
        if (!leaves_along && w == side_of(after.portals[0])) break;
        w = on_left ? mesh.opposite(w, v) : mesh.opposite(v, w);
        if (w < 0) return {};
    }
    for (const Portal& portal : after.portals) append(portals, portal);
    return portals;
}

double length_of(const CurveMesh& mesh, const Straight& way) {
    const Layout layout = lay_out(mesh, way.from, way.to, way.portals);
    return (layout.to - layout.from).norm();
}

/// The shortest path along edges, as ways of one edge.
std::vector<Straight> along_edges(const CurveMesh& mesh, int from, int to) {
    const int n = mesh.vertex_count();
    std::vector<std::vector<int>> neighbours(static_cast<std::size_t>(n));
    for (const auto& triangle : mesh.triangles())
        for (int i = 0; i < 3; ++i) {
            neighbours[triangle[i]].push_back(triangle[(i + 1) % 3]);
            neighbours[triangle[(i + 1) % 3]].push_back(triangle[i]);
        }
    std::vector<double> distance(static_cast<std::size_t>(n), std::numeric_limits<double>::infinity());
    std::vector<int> previous(static_cast<std::size_t>(n), -1);
    using Entry = std::pair<double, int>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    distance[from] = 0;
    queue.emplace(0.0, from);
    while (!queue.empty() && queue.top().second != to) {
        const auto [so_far, v] = queue.top();
        queue.pop();
        if (so_far > distance[v]) continue;
        for (const int w : neighbours[v])
            if (const double there = so_far + mesh.length(v, w); there < distance[w]) {
                distance[w] = there;
                previous[w] = v;
                queue.emplace(there, w);
            }
    }
    if (!std::isfinite(distance[to]))
        throw Error(Cause::bad_boundary,
                    "no way leads from vertex " + std::to_string(from) + " to vertex " + std::to_string(to) +
                        " over the surface",
                    "give points of one component", {Things::vertices, {from, to}});
    std::vector<Straight> ways;
    for (int v = to; v != from; v = previous[v]) ways.push_back({previous[v], v, {}});
    std::reverse(ways.begin(), ways.end());
    return ways;
}

/// Shortens ways at their joint where one side allows it. @return whether it did
bool shorten(const CurveMesh& mesh, std::vector<Straight>& ways, std::size_t joint) {
    const Straight before = ways[joint], after = ways[joint + 1];
    const double length = length_of(mesh, before) + length_of(mesh, after);
    std::optional<Taut> best;
    for (const bool on_left : {true, false}) {
        const auto portals = around(mesh, before, after, on_left);
        if (!portals) continue;
        Taut taut = pulled(mesh, before.from, after.to, *portals);
        if (!best || taut.length < best->length) best = std::move(taut);
    }
    if (!best || best->length > length * (1 - kShorter)) return false;
    const auto at = ways.begin() + static_cast<std::ptrdiff_t>(joint);
    ways.insert(ways.erase(at, at + 2), best->parts.begin(), best->parts.end());
    return true;
}

void append_nodes(const CurveMesh& mesh, const Straight& way, std::vector<PathNode>& nodes) {
    const Layout layout = lay_out(mesh, way.from, way.to, way.portals);
    const Point along = layout.to - layout.from;
    const auto append_vertex = [&](int vertex) {
        if (nodes.back().b >= 0 || nodes.back().a != vertex) nodes.push_back({vertex, -1, 0, mesh.point(vertex)});
    };
    for (std::size_t i = 0; i < way.portals.size(); ++i) {
        const Point side = layout.right[i] - layout.left[i], to_left = layout.left[i] - layout.from;
        const double across = along.x() * side.y() - along.y() * side.x();
        const double t = across != 0 ? (to_left.x() * along.y() - to_left.y() * along.x()) / across : 0.5;
        const auto [a, b] = way.portals[i];
        if (t < kAtEnd)
            append_vertex(a);
        else if (t > 1 - kAtEnd)
            append_vertex(b);
        else
            nodes.push_back({a, b, t, (1 - t) * mesh.point(a) + t * mesh.point(b)});
    }
    append_vertex(way.to);
}

}  // namespace

std::vector<PathNode> straight_path(const CurveMesh& mesh, int from, int to) {
    std::vector<Straight> ways = along_edges(mesh, from, to);
    for (int turn = 0; turn < kMostTurns; ++turn) {
        bool changed = false;
        for (std::size_t joint = 0; joint + 1 < ways.size();)
            if (shorten(mesh, ways, joint)) {
                changed = true;
                joint = joint > 0 ? joint - 1 : 0;
            } else {
                ++joint;
            }
        if (!changed) break;
    }
    std::vector<PathNode> nodes{{from, -1, 0, mesh.point(from)}};
    for (const Straight& way : ways) append_nodes(mesh, way, nodes);
    return nodes;
}

}  // namespace beltrami
