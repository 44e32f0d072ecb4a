#include <beltrami/forms/homology.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string>
#include <utility>

#include <beltrami/base/error.h>
#include <beltrami/forms/tree_cotree.h>

namespace beltrami {

namespace {

/// The closed forms that are 0 on the tree and have 1 on one of the loops' edges: every face gives the value of the
/// edge that leads on to the root of the tree of faces, from the leaves on.
Eigen::MatrixXi cochains_of(const Surface& surface, const EdgeRoles& roles) {
    const Topology& t = surface.topology;
    const FaceList& faces = surface.mesh.faces;
    Eigen::MatrixXi values = Eigen::MatrixXi::Zero(t.edge_count(), static_cast<Eigen::Index>(roles.loops.size()));
    for (std::size_t l = 0; l < roles.loops.size(); ++l) values(roles.loops[l], static_cast<Eigen::Index>(l)) = 1;

    std::vector<int> order, way(static_cast<std::size_t>(faces.size()), -1);
    std::vector<char> reached(way.size(), 0);
    const auto reach = [&](int face, int edge) {
        if (face < 0 || reached[face]) return;
        reached[face] = 1;
        way[face] = edge;
        order.push_back(face);
    };
    for (int e = 0; e < t.edge_count(); ++e)
        if (roles.of_edges[e] == EdgeRole::cotree && std::min(t.edge_faces[e][0], t.edge_faces[e][1]) < 0)
            reach(std::max(t.edge_faces[e][0], t.edge_faces[e][1]), e);
    if (order.empty()) reach(0, -1);
    for (std::size_t next = 0; next < order.size(); ++next) {
        const int f = order[next];
        for (int c = faces.first_corner(f); c < faces.first_corner(f) + faces.degree(f); ++c) {
            const int e = t.corner_edges[c];
            if (roles.of_edges[e] == EdgeRole::cotree)
                reach(t.edge_faces[e][0] == f ? t.edge_faces[e][1] : t.edge_faces[e][0], e);
        }
    }
    for (auto f = order.rbegin(); f != order.rend(); ++f) {
        if (way[*f] < 0) continue;
        Eigen::RowVectorXi sum = Eigen::RowVectorXi::Zero(values.cols());
        int sign = 1;
        for (int c = faces.first_corner(*f); c < faces.first_corner(*f) + faces.degree(*f); ++c) {
            const int e = t.corner_edges[c];
            const int along = t.edges[e][0] == faces.vertices()[c] ? 1 : -1;
            if (e == way[*f])
                sign = along;
            else
                sum += along * values.row(e);
        }
        values.row(way[*f]) = -sign * sum;
    }
    return values;
}

/// Edges with a direction: 2e runs from the smaller vertex of edge e to the larger, 2e + 1 back. For each the next one
/// counter-clockwise around its tail; after the last one at a boundary vertex comes the first.
std::vector<int> turns(const Surface& surface) {
    const Topology& t = surface.topology;
    const FaceList& faces = surface.mesh.faces;
    std::vector<int> next(2 * t.edges.size(), -1);
    std::vector<char> entered(next.size(), 0);
    const auto dart = [&](int corner) {
        const int e = t.corner_edges[corner];
        return 2 * e + (t.edges[e][0] == faces.vertices()[corner] ? 0 : 1);
    };
    for (int f = 0; f < faces.size(); ++f)
        for (int i = 0; i < faces.degree(f); ++i) {
            const int n = faces.degree(f), first = faces.first_corner(f);
            const int turned = dart(first + (i + n - 1) % n) ^ 1;
            next[dart(first + i)] = turned;
            entered[turned] = 1;
        }
    std::vector<int> first_at(static_cast<std::size_t>(surface.mesh.vertex_count()), -1);
    const auto tail = [&](std::size_t d) { return t.edges[d / 2][d % 2]; };
    for (std::size_t d = 0; d < next.size(); ++d)
        if (!entered[d]) first_at[tail(d)] = static_cast<int>(d);
    for (std::size_t d = 0; d < next.size(); ++d)
        if (next[d] < 0) next[d] = first_at[tail(d)];
    return next;
}

/// Once around the tree, the ends of the loops' edges are met in the order in which the loops meet at one point when
/// the tree has shrunk to it: two that alternate cross there.
Eigen::MatrixXi intersections_of(const Surface& surface, const PathTree& tree, const EdgeRoles& roles) {
    const Topology& t = surface.topology;
    const auto count = static_cast<int>(roles.loops.size());
    std::vector<int> loop_of_edge(t.edges.size(), -1);
    for (int l = 0; l < count; ++l) loop_of_edge[roles.loops[l]] = l;
    const std::vector<int> next = turns(surface);
    int start = -1;
    for (std::size_t e = 0; e < t.edges.size() && start < 0; ++e)
        if (roles.of_edges[e] == EdgeRole::tree && (t.edges[e][0] == tree.root || t.edges[e][1] == tree.root))
            start = static_cast<int>(2 * e) + (t.edges[e][0] == tree.root ? 0 : 1);
    std::vector<std::array<int, 2>> places(static_cast<std::size_t>(count));  // of the start and the end of each loop
    int place = 0;
    for (int d = start;;) {
        const int e = d / 2;
        if (roles.of_edges[e] == EdgeRole::tree) {
            d = next[d ^ 1];
        } else {
            if (const int l = loop_of_edge[e]; l >= 0) places[l][d % 2] = place++;
            d = next[d];
        }
        if (d == start) break;
    }
    Eigen::MatrixXi result = Eigen::MatrixXi::Zero(count, count);
    const auto between = [&](int x, int i) {
        const auto [from, to] = places[i];
        return from < to ? from < x && x < to : x > from || x < to;
    };
    for (int i = 0; i < count; ++i)
        for (int j = 0; j < count; ++j)
            if (i != j)
                result(i, j) = static_cast<int>(between(places[j][0], i)) - static_cast<int>(between(places[j][1], i));
    return result;
}

/// From the root along an edge and back, without what is gone there and back.
std::vector<int> loop_of(const Topology& topology, const PathTree& tree, int edge) {
    const std::vector<int> there = tree.path(topology.edges[edge][0]), back = tree.path(topology.edges[edge][1]);
    std::size_t common = 0;
    while (common + 1 < std::min(there.size(), back.size()) && there[common + 1] == back[common + 1]) ++common;
    std::vector<int> loop(there.begin() + static_cast<std::ptrdiff_t>(common), there.end());
    for (std::size_t i = back.size(); i-- > common + 1;) loop.push_back(back[i]);
    return loop;
}

/// The edge between two vertices; -1 if there is none.
int edge_between(const Topology& topology, int a, int b) {
    const std::array<int, 2> wanted{std::min(a, b), std::max(a, b)};
    const auto found = std::lower_bound(topology.edges.begin(), topology.edges.end(), wanted);
    return found != topology.edges.end() && *found == wanted ? static_cast<int>(found - topology.edges.begin()) : -1;
}

}  // namespace

HomologyBasis homology_basis(const Surface& surface) {
    const Topology& t = surface.topology;
    if (t.components != 1)
        throw Error(Cause::bad_mesh, "the surface has " + std::to_string(t.components) + " components",
                    "take one component at a time");
    const std::vector<double> lengths = edge_lengths(surface);
    const PathTree tree(t, lengths, surface.mesh.vertex_count(), t.edges[0][0]);
    const EdgeRoles part = edge_roles(surface, tree, lengths);
    HomologyBasis basis;
    for (const int e : part.loops) {
        basis.loops.push_back(loop_of(t, tree, e));
        double length = 0;
        const std::vector<int>& loop = basis.loops.back();
        for (std::size_t i = 0; i < loop.size(); ++i)
            length += lengths[edge_between(t, loop[i], loop[(i + 1) % loop.size()])];
        basis.lengths.push_back(length);
    }
    basis.intersections = intersections_of(surface, tree, part);
    basis.cochains = cochains_of(surface, part);
    return basis;
}

Eigen::VectorXi homology_class(const Topology& topology, const HomologyBasis& basis, std::span<const int> path) {
    Eigen::VectorXi result = Eigen::VectorXi::Zero(basis.size());
    for (std::size_t i = 0; i < path.size(); ++i) {
        const int from = path[i], to = path[(i + 1) % path.size()];
        const int edge = edge_between(topology, from, to);
        if (edge < 0)
            throw Error(
                Cause::bad_option,
                "no edge joins the vertices " + std::to_string(from) + " and " + std::to_string(to) + " of a path",
                "name every vertex on the way", {Things::vertices, {from, to}});
        result += (from < to ? 1 : -1) * basis.cochains.row(edge).transpose();
    }
    return result;
}

Eigen::MatrixXi symplectic_basis(Eigen::MatrixXi intersections) {
    // Integer Gram-Schmidt for antisymmetric forms: a pair of smallest product is split off as soon as Euclid's
    // algorithm has made all others orthogonal to it.
    Eigen::MatrixXi& N = intersections;
    const Eigen::Index n = N.rows();
    Eigen::MatrixXi P = Eigen::MatrixXi::Identity(n, n);
    const auto add = [&](Eigen::Index to, int factor, Eigen::Index from) {
        N.row(to) += factor * N.row(from);
        N.col(to) += factor * N.col(from);
        P.col(to) += factor * P.col(from);
    };
    const auto swap = [&](Eigen::Index a, Eigen::Index b) {
        N.row(a).swap(N.row(b));
        N.col(a).swap(N.col(b));
        P.col(a).swap(P.col(b));
    };
    Eigen::Index done = 0;
    while (done + 1 < n) {
        Eigen::Index a = -1, b = -1;
        for (Eigen::Index i = done; i < n; ++i)
            for (Eigen::Index j = i + 1; j < n; ++j)
                if (N(i, j) != 0 && (a < 0 || std::abs(N(i, j)) < std::abs(N(a, b)))) a = i, b = j;
        if (a < 0) break;
        if (N(a, b) < 0) std::swap(a, b);
        const int product = N(a, b);
        bool orthogonal = true;
        for (Eigen::Index c = done; c < n; ++c) {
            if (c == a || c == b) continue;
            add(c, -(N(a, c) / product), b);
            add(c, N(b, c) / product, a);
            orthogonal = orthogonal && N(a, c) == 0 && N(b, c) == 0;
        }
        if (!orthogonal) continue;  // a remainder is smaller than the product
        swap(a, done);
        if (b == done) b = a;
        swap(b, done + 1);
        done += 2;
    }
    // Pairs one after the other become first the a, then the b.
    Eigen::MatrixXi sorted = P;
    for (Eigen::Index i = 0; i < done / 2; ++i) {
        sorted.col(i) = P.col(2 * i);
        sorted.col(done / 2 + i) = P.col(2 * i + 1);
    }
    return sorted;
}

}  // namespace beltrami
