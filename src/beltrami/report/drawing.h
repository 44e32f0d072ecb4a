#pragma once

#include <array>
#include <vector>

#include <beltrami/mesh/mesh.h>

namespace beltrami {

/// The triangles that stand for a mesh in a picture. Quads are split by split_quad; a mesh of too many
/// triangles is coarsened by merging the vertices of each cell of a grid. For drawing only: nothing is computed on it.
struct Drawing {
    std::vector<std::array<int, 3>> triangles;  ///< indices of drawn vertices; the two halves of a quad are neighbours
                                                ///< (a, b, c), (a, c, d)
    std::vector<int> faces;                     ///< #triangles: the face of the mesh behind each
    std::vector<int> drawn_vertex;              ///< #V drawn vertex that stands for each vertex; empty: itself
    int vertex_count = 0;                       ///< number of drawn vertices

    bool coarsened() const { return !drawn_vertex.empty(); }
    /// Values of the drawn vertices: the mean over the vertices each stands for, those with NaN left out.
    Positions reduce(const Positions& values) const;
};

/// @param triangle_limit a mesh of more triangles is coarsened to at most this many
Drawing make_drawing(const Mesh& mesh, int triangle_limit);

}  // namespace beltrami
