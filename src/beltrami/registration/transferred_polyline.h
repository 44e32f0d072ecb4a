#pragma once

#include <span>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/registration/transfer.h>

namespace beltrami BELTRAMI_PUBLIC {

/// The image of a polyline, with a point wherever it bends: it is straight in between.
struct TransferredPolyline {
    std::vector<MeshPoint> places;
    std::vector<int> given;  ///< of the points that were given, the numbers of their images
};

/// A polyline of one surface on the other. Its points are joined by geodesics of the surface (straight_path.h), which
/// may cross each other; the image bends where these cross edges of either surface, at points found to 1e-12 of the
/// pieces between edges.
/// @param points places of the surface, in their order
/// @throw Error bad_boundary if no way leads from one to the next
TransferredPolyline transferred_polyline(const SurfaceCorrespondence& map, std::span<const MeshPoint> points,
                                         TransferWay way = TransferWay::to_target);

}  // namespace beltrami
