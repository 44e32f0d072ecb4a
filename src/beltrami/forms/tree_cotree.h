#pragma once

#include <vector>

#include <beltrami/operators/surface.h>

namespace beltrami {

/// #E lengths of the edges in the metric of the surface; where two faces differ, that of the one that names it last.
std::vector<double> edge_lengths(const Surface& surface);

/// Shortest paths along edges from one vertex.
struct PathTree {
    std::vector<int> parents, edges;  ///< #V, of the way to the root; -1
    std::vector<double> distances;    ///< #V; infinite where no way leads
    int root;

    /// @param lengths #E
    PathTree(const Topology& topology, const std::vector<double>& lengths, int vertex_count, int from);

    /// From the root to a vertex.
    std::vector<int> path(int v) const;
    /// The vertex that is farthest from the root of those that a path reaches.
    int farthest() const;
};

/// What an edge is to a tree of paths and a tree of faces.
enum class EdgeRole : unsigned char { tree, cotree, loop };

struct EdgeRoles {
    std::vector<EdgeRole> of_edges;
    std::vector<int> loops;  ///< edges in neither tree, the shortest loops first
};

/// The spanning tree of the faces, and one for what lies beyond the boundary, across edges that are not in the tree;
/// the edges of long loops first.
/// @param lengths #E
EdgeRoles edge_roles(const Surface& surface, const PathTree& tree, const std::vector<double>& lengths);

}  // namespace beltrami
