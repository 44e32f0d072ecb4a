#pragma once

#include <array>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/mesh/mesh.h>

namespace beltrami BELTRAMI_PUBLIC {

/// Combinatorics of a mesh whose edges are manifold and coherently oriented.
struct Topology {
    std::vector<std::array<int, 2>> edges;  ///< #E vertex pairs, smaller index first, sorted
    std::vector<std::array<int, 2>>
        edge_faces;  ///< #E faces beside the edge: the one that runs along edges[e][0]→[1] first; -1 = none
    std::vector<int> corner_edges;  ///< #corners: edge from this corner's vertex to the next one of the face
    /// Oriented boundary loops (faces on the left). Loop 0 is the outer one — in the plane the one that encloses the
    /// most area, in space the longest — the others are sorted by their smallest vertex. Each starts at its smallest
    /// vertex.
    std::vector<std::vector<int>> boundary_loops;
    std::vector<double> loop_lengths;  ///< length of each boundary loop, in the units of the positions
    std::vector<char> on_boundary;     ///< #V flags
    int components = 0;                ///< connected components of the faces
    int euler_characteristic = 0;      ///< V − E + F over the referenced vertices
    int genus = 0;                     ///< sum of the genera of all components

    int edge_count() const { return static_cast<int>(edges.size()); }
};

/// Builds edges, loops, components and genus.
/// @throw Error bad_mesh with diagnose's sentence if an edge or vertex is non-manifold or faces disagree in
/// orientation.
Topology topology(const Mesh& mesh);

}  // namespace beltrami
