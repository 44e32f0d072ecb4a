#pragma once

#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/mesh/mesh.h>

namespace beltrami BELTRAMI_PUBLIC {

/// A mesh some vertices of which were moved onto neighbours. Every edge of the old mesh has become one of the new mesh,
/// or a vertex: the map of vertices is simplicial, and homotopic to the identity.
struct CollapsedMesh {
    Mesh mesh;
    std::vector<int> images;  ///< #V of the old mesh: vertices of the new one
};

/// Collapses the shortest edges first until few vertices are left, where the surface stays a triangulated one of the
/// same topology (link condition: Dey, Edelsbrunner, Guha, Nekhayev 1999) and no face turns over. Boundary vertices
/// stay as they are. The shape is kept roughly.
/// @param mesh of triangles
/// @param vertices to be left; more are where no more edges can go
CollapsedMesh collapse_edges(const Mesh& mesh, int vertices);

}  // namespace beltrami
