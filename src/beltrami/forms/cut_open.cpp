#include <beltrami/forms/cut_open.h>

#include <algorithm>
#include <numeric>
#include <optional>
#include <string>

#include <beltrami/base/disjoint_sets.h>
#include <beltrami/base/error.h>
#include <beltrami/forms/tree_cotree.h>

namespace beltrami {

namespace {

/// The edges of a path between two vertices far from each other: the one farthest from any, and the one farthest from
/// that.
std::vector<char> long_path(const Surface& surface, const std::vector<double>& lengths) {
    const Topology& t = surface.topology;
    const int count = surface.mesh.vertex_count(), first = surface.mesh.faces[0][0];
    const PathTree tree(t, lengths, count, PathTree(t, lengths, count, first).farthest());
    std::vector<char> cut(t.edges.size(), 0);
    const int end = tree.farthest();
    if (tree.parents[end] != tree.root) {
        for (int v = end; v != tree.root; v = tree.parents[v]) cut[tree.edges[v]] = 1;
        return cut;
    }
    // One edge has no inner vertex to open at: around the face beside it.
    const FaceList& faces = surface.mesh.faces;
    const int direct = tree.edges[end], f = t.edge_faces[direct][0];
    for (int c = faces.first_corner(f); c < faces.first_corner(f) + faces.degree(f); ++c)
        cut[t.corner_edges[c]] = t.corner_edges[c] != direct;
    return cut;
}

/// The edges in no tree of faces, without the ends that lead nowhere.
std::vector<char> loops_to_a_disk(const Surface& surface, const std::vector<double>& lengths) {
    const Topology& t = surface.topology;
    const PathTree tree(t, lengths, surface.mesh.vertex_count(), t.edges[0][0]);
    const EdgeRoles roles = edge_roles(surface, tree, lengths);
    std::vector<char> cut(t.edges.size(), 0);
    std::vector<std::vector<int>> around(static_cast<std::size_t>(surface.mesh.vertex_count()));
    for (int e = 0; e < t.edge_count(); ++e) {
        if (roles.of_edges[e] == EdgeRole::cotree) continue;
        cut[e] = 1;
        for (const int v : t.edges[e]) around[v].push_back(e);
    }
    const auto only_edge = [&](int v) {
        int found = -1;
        for (const int e : around[v])
            if (cut[e]) {
                if (found >= 0) return -1;
                found = e;
            }
        return found;
    };
    for (int first = 0; first < surface.mesh.vertex_count(); ++first)
        for (int v = first, e = only_edge(v); e >= 0; e = only_edge(v)) {
            cut[e] = 0;
            v = t.edges[e][0] == v ? t.edges[e][1] : t.edges[e][0];
        }
    return cut;
}

/// The mesh with a vertex for each part of a vertex' faces between edges of the cut.
CutOpen split_along(const Surface& surface, const std::vector<char>& cut) {
    const FaceList& faces = surface.mesh.faces;
    const Topology& t = surface.topology;
    const std::vector<int>& vertices = faces.vertices();
    // Corners at one vertex belong together across an edge that is not cut.
    DisjointSets parts(faces.corner_count());
    struct Side {
        int tail, head;  // corners
    };
    std::vector<std::optional<Side>> first_side(t.edges.size());
    for (int f = 0; f < faces.size(); ++f)
        for (int i = 0; i < faces.degree(f); ++i) {
            const Side side{faces.first_corner(f) + i, faces.first_corner(f) + (i + 1) % faces.degree(f)};
            const int e = t.corner_edges[side.tail];
            if (cut[e]) continue;
            if (const std::optional<Side>& other = first_side[e]) {  // which runs the other way
                parts.join(side.tail, other->head);
                parts.join(side.head, other->tail);
            } else {
                first_side[e] = side;
            }
        }
    CutOpen result;
    result.seam_edges = static_cast<int>(std::count(cut.begin(), cut.end(), 1));
    std::vector<int> number(static_cast<std::size_t>(faces.corner_count()), -1),
        named(static_cast<std::size_t>(surface.mesh.vertex_count()), 0);
    result.vertices.resize(named.size());
    std::iota(result.vertices.begin(), result.vertices.end(), 0);
    for (int c = 0; c < faces.corner_count(); ++c) {
        int& n = number[parts.find(c)];
        if (n >= 0) continue;
        const int v = vertices[c];
        if (named[v]++ == 0) {
            n = v;
        } else {
            n = static_cast<int>(result.vertices.size());
            result.vertices.push_back(v);
        }
    }
    result.disk.positions = surface.mesh.positions(result.vertices, Eigen::all);
    std::vector<int> face;
    for (int f = 0; f < faces.size(); ++f) {
        face.clear();
        for (int c = faces.first_corner(f); c < faces.first_corner(f) + faces.degree(f); ++c)
            face.push_back(number[parts.find(c)]);
        result.disk.faces.add(face);
    }
    return result;
}

}  // namespace

CutOpen cut_open(const Surface& surface) {
    const Topology& t = surface.topology;
    if (t.components != 1 || !t.boundary_loops.empty())
        throw Error(Cause::bad_mesh,
                    t.components != 1 ? "the surface has " + std::to_string(t.components) + " components"
                                      : std::string("the surface has a boundary"),
                    "only a closed surface in one piece is cut open");
    const std::vector<double> lengths = edge_lengths(surface);
    return split_along(surface, t.genus == 0 ? long_path(surface, lengths) : loops_to_a_disk(surface, lengths));
}

}  // namespace beltrami
