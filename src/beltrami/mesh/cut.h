#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/mesh/mesh.h>
#include <beltrami/mesh/submesh.h>

namespace beltrami BELTRAMI_PUBLIC {

/// The half {n·x ≥ d} of a plane.
struct HalfSpace {
    Eigen::Vector3d normal;  ///< n, not zero; need not be of unit length
    double offset = 0.0;     ///< d, in the units of the positions for a unit normal

    /// The side of the plane through @p point into which @p normal points.
    static HalfSpace through(const Eigen::Vector3d& point, const Eigen::Vector3d& normal) {
        return {normal, normal.dot(point)};
    }
};

/// What a plane leaves of a mesh. Original vertices come first, in their order, then the new ones on the plane, in the
/// order in which the faces meet them.
struct CutMesh {
    Mesh mesh;
    std::vector<int> vertices;  ///< vertex of the original mesh; -1 for a new one
    std::vector<std::array<int, 2>>
        edges;               ///< for a new vertex the original edge (or quad diagonal) it lies on; else {-1, -1}
    std::vector<int> faces;  ///< face of the original mesh that contains this one
};

/// Cuts a mesh along a plane and keeps one side. Faces that cross the plane are split (quads into triangles first); a
/// vertex within 1e-12 of the mesh's diameter counts as lying on the plane, and is not moved. Faces in the plane stay.
/// Neighbours remain neighbours, orientation and texture coordinates are kept.
/// @throw Error bad_option if the normal is zero or not finite; bad_mesh if a face names a vertex that does not exist
CutMesh cut_by_plane(const Mesh& mesh, const HalfSpace& kept);

}  // namespace beltrami
