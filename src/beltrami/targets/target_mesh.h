#pragma once

#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/targets/target_domain.h>

namespace beltrami BELTRAMI_PUBLIC {

/// Sizes of the triangles in a target domain, lengths in the units of its plane.
struct TargetMeshOptions {
    double edge_length = 0;       ///< inside and along the curves, at most; 0: about 5000 vertices in all
    double hole_edge_length = 0;  ///< along the holes, at most; 0 = edge_length
    int least_edges = 32;         ///< every curve has at least so many, at least 6
    double max_turn = 0.2;        ///< radians by which a curve may turn along an edge, above 0 and at most 0.5
    double min_angle = 0.489;     ///< radians, see TriangulateOptions
    bool split_ears = true;       ///< see TriangulateOptions

    /// @throw Error bad_option if a value is impossible
    void validate() const;
};

/// A triangulated target domain whose boundary vertices know their places on the curves.
struct TargetMesh {
    Mesh mesh;               ///< #V×2, counter-clockwise; curve by curve the vertices from s = 0, then the others
    std::vector<int> curve;  ///< #V curve of the domain on which the vertex lies; −1 inside
    std::vector<double> parameter;   ///< #V arc length on that curve; 0 inside
    std::vector<int> curve_of_loop;  ///< curve of each of topology(mesh).boundary_loops
};

/// Triangulates a target domain. Corners of polygons are vertices, boundary vertices lie on the curves to rounding, and
/// follow each other along each loop as their parameters do. Where curves come near each other or bend sharply their
/// edges are halved until the polygons of the vertices are as far apart as the curves.
/// @throw Error bad_option as validate(domain), or if the sizes ask for too many triangles; not_solved if the mesh
///        does not follow the curves
TargetMesh target_mesh(const TargetDomain& domain, const TargetMeshOptions& options = {});

}  // namespace beltrami
