#pragma once

#include <optional>
#include <span>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/locate/planar_locator.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/operators/surface.h>

namespace beltrami BELTRAMI_PUBLIC {

/// A surface on the faces of another one, and how its own faces, straight between those places, sit there.
struct CarriedSurface {
    std::vector<MeshPoint> places;  ///< #V of the source, on the target's faces
    Positions positions;            ///< #V×3 their positions
    /// Of the straight faces in space between those: where they follow the target badly they differ from the map, and
    /// may be flipped, though the map is not.
    Distortion in_space;
    /// Faces whose straight image and the map differ by a dilatation above 3, or miss a vertex of the target that the
    /// map takes into them by more than their longest side: limbs inside a few faces. The mesh does not resolve the map
    /// there.
    std::vector<int> unresolved;
    /// Of soft landmarks the largest distance in space from their places; empty without any.
    std::optional<double> largest_distance;

    /// Measures what is between the places.
    /// @param mu #S coefficients of the map in the source's frames
    /// @param back #V of the target: places on the source to which the inverse map takes its vertices; empty: not known
    void measure(const Surface& source, const Surface& target, const Eigen::VectorXcd& mu,
                 std::span<const MeshPoint> back = {});
};

}  // namespace beltrami
