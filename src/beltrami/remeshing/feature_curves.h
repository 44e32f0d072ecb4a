#pragma once

#include <optional>
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

/// The border and the edges at which the normals of the two faces differ by more than an angle.
/// @param angle radians; none: the border only
FeatureCurves feature_curves(const Mesh& mesh, const Topology& topology, std::optional<double> angle);

}  // namespace beltrami
