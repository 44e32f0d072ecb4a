#pragma once

#include <array>
#include <span>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/mesh/mesh.h>

namespace beltrami BELTRAMI_PUBLIC {

/// The edges of any face list, manifold or not: what topology() and diagnose() are built from.
struct EdgeTable {
    std::vector<std::array<int, 2>> edges;  ///< #E vertex pairs, smaller index first, sorted
    std::vector<int> corner_edges;          ///< #corners: edge from this corner's vertex to the next one of the face
    std::vector<int> corner_faces;          ///< #corners: face of the corner
    std::vector<int> offsets;               ///< #E+1 positions in corners
    std::vector<int> corners;               ///< corners that run along each edge, edge after edge, ascending

    int edge_count() const { return static_cast<int>(edges.size()); }
    std::span<const int> corners_of(int edge) const {
        return {corners.data() + offsets[edge], static_cast<std::size_t>(offsets[edge + 1] - offsets[edge])};
    }
};

/// Collects the edges in time linear in the corners.
/// @pre every index of @p faces lies in 0 … vertex_count-1
EdgeTable edge_table(const FaceList& faces, int vertex_count);

/// The corner after @p corner in its face.
inline int next_corner(const FaceList& faces, const EdgeTable& table, int corner) {
    const int face = table.corner_faces[corner];
    return corner + 1 < faces.offsets()[face + 1] ? corner + 1 : faces.first_corner(face);
}

/// Vertices whose faces form more than one fan, ascending. Faces that share an edge of any multiplicity belong to one
/// fan.
/// @pre no face names a vertex twice
std::vector<int> non_manifold_vertices(const FaceList& faces, const EdgeTable& table, int vertex_count);

}  // namespace beltrami
