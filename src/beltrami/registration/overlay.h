#pragma once

#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/registration/transfer.h>

namespace beltrami BELTRAMI_PUBLIC {

/// The faces of two surfaces laid over each other by a map: convex pieces, each in one face of both, whose sides are
/// straight in both.
struct Overlay {
    /// A corner of pieces: a vertex of one of the surfaces or a point where edges of both cross.
    struct Corner {
        MeshPoint on_source, on_target;
    };
    struct Piece {
        int source_face, target_face;
        std::vector<int> corners;               ///< counter-clockwise
        double part_of_source, part_of_target;  ///< of the areas of its triangles
        std::array<int, 3> source_triangle, target_triangle;
        /// Barycentric coordinates of the corners in these triangles.
        std::vector<std::array<double, 3>> in_source, in_target;
    };
    std::vector<Corner> corners;
    std::vector<Piece> pieces;
};

/// The common refinement of both surfaces: where values that jump at edges of the one are wanted on the other.
Overlay overlay(const SurfaceCorrespondence& map);

/// The common refinement as a triangle mesh that lies on one of the surfaces and is, up to the roundness of boundaries,
/// the same set in space.
struct OverlayMesh {
    Mesh
        mesh;  ///< with the texture coordinates of the other surface, if it has any, exactly: one point for each corner
    std::vector<int> source_faces, target_faces;  ///< #F, in which its faces lie
};

/// @param way to the surface on which it is to lie
/// @throw Error bad_mesh if corners of the other surface have no texture point, and others have
OverlayMesh overlay_mesh(const SurfaceCorrespondence& map, TransferWay way = TransferWay::to_target);

}  // namespace beltrami
