#pragma once

#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/mesh/mesh.h>

namespace beltrami BELTRAMI_PUBLIC {

// What keeps only a part of a mesh is in submesh.h.

/// A mesh whose vertices at one place have become one.
struct WeldedMesh {
    Mesh mesh;
    std::vector<int> vertices;  ///< for each vertex the first of those it was, whose position it has
    std::vector<int> welded;    ///< for each vertex of the old mesh the new one
    std::vector<int> faces;     ///< for each face the old one
    int removed_faces = 0;      ///< those of which less than a triangle was left
};

/// Makes vertices one that are no further apart than @p tolerance, also by way of others; each keeps the position of
/// the first of them. Faces whose neighbouring corners become one lose them; those left with two are removed. Texture
/// coordinates stay, corner by corner. Order is kept. Time n log n unless many vertices share one place.
/// @param tolerance in the units of the positions; 0: exactly equal positions
/// @pre indices of the faces are in range; texture coordinates, if any, have one index per corner
/// @throw Error bad_option unless the tolerance is a number from 0
WeldedMesh weld(const Mesh& mesh, double tolerance);

/// The least of some tolerances, from 1e-9 to 1e-4 of the mesh's diameter, with which weld() joins the most components
/// and ten times which joins no further vertices (the largest that removes no face, if there is none such), and how
/// many are left; 0 if none joins any.
struct WeldSuggestion {
    double tolerance = 0;
    int components = 0;
};
WeldSuggestion suggest_weld(const Mesh& mesh);

/// Faces turned so that neighbours agree: in every component the fewer are. The first corner of a face stays the first.
struct OrientedMesh {
    Mesh mesh;
    std::vector<int> turned;  ///< faces
};

/// @pre as weld()
/// @throw Error bad_mesh if there is no coherent orientation, or edges belong to more than two faces
OrientedMesh orient(const Mesh& mesh);

}  // namespace beltrami
