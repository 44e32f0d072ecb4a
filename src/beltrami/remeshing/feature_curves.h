#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include <beltrami/base/public.h>
#include <beltrami/mesh/topology.h>

namespace beltrami BELTRAMI_PUBLIC {

/// Curves of a mesh that its shape or its border distinguishes.
struct FeatureCurves {
    struct Curve {
        std::vector<int> vertices;  ///< in order; of an open one the ends are corners
        bool closed;
    };
    std::vector<Curve> curves;
    /// Ends and branchings of curves, and vertices at which one turns by more than 50 degrees.
    std::vector<int> corners;
};

/// The border, given edges, and those at which the normals of the two faces differ by more than an angle.
/// @param angle radians; none: no others
/// @param given pairs of vertices, such as seam_edges (carried_data.h)
FeatureCurves feature_curves(const Mesh& mesh, const Topology& topology, std::optional<double> angle,
                             std::span<const std::array<int, 2>> given = {});

}  // namespace beltrami
