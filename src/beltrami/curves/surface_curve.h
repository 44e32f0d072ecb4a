#pragma once

#include <span>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/locate/planar_locator.h>
#include <beltrami/mesh/mesh.h>

namespace beltrami BELTRAMI_PUBLIC {

/// A curve on a mesh as its user gives it: points in order, which geodesics join.
struct CurveThrough {
    std::vector<MeshPoint> points;
    bool closed = false;  ///< the last point is joined to the first, which is not repeated
};

/// A mesh whose edges curves run along. Vertices of the old mesh come first, unchanged and in order.
struct MeshWithCurves {
    /// A curve: vertices along it, those of a closed one once each.
    struct Chain {
        std::vector<int> vertices;
        std::vector<double> lengths;  ///< arc length up to each of them
        std::vector<int> given;       ///< positions in vertices of the given points
        double length = 0;            ///< of the whole curve
        bool closed = false;
    };
    Mesh mesh;
    std::vector<MeshPoint> places;  ///< on the old mesh, of the vertices after the old ones
    std::vector<int> faces;         ///< #F face of the old mesh
    std::vector<Chain> curves;
};

/// Joins the points of every curve by geodesics (straight_path.h) and divides the faces that they cross, so that they
/// run along edges. Edges that join two vertices of one curve beside it are divided in the middle: where the curve
/// bends here and its image runs straight, such an edge would lie on the image and flip a face. Faces that no curve
/// meets are kept.
/// @param mesh that passes the diagnosis; texture coordinates are dropped
/// @throw Error bad_boundary naming the curve: fewer than two points, or three of a closed one; points that coincide,
///        between which no way leads, or that do not exist; a curve that meets itself or another one
MeshWithCurves mesh_with_curves(const Mesh& mesh, std::span<const CurveThrough> curves);

}  // namespace beltrami
