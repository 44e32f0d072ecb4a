#pragma once

#include <optional>
#include <string>
#include <vector>

namespace beltrami {

/// A surface carried onto another one.
struct RegistrationRecord {
    std::string target;  ///< its file
    int landmarks = 0;
    /// Of closed surfaces.
    struct OnSphere {
        int dimension = 0;                                 ///< complex, of the differentials
        double weighted_mean = 0, weighted_deviation = 0;  ///< of |μ| by |φ|
        double separation = 0;                             ///< least distance of two landmarks on the conformal spheres
    };
    std::optional<OnSphere> sphere;
    /// Of least Lᵖ maps.
    struct LeastLp {
        double p = 2;
        int curves = 0, start_flipped = 0;  ///< faces that the start had flipped
        double curve_distance = 0;          ///< largest of a vertex of a curve from its partner, in the target's units
    };
    std::optional<LeastLp> lp;
    int flipped_in_space = 0;  ///< straight faces between the places
    int unresolved = 0;        ///< faces on which the mesh does not resolve the map
    std::optional<double> inverse_k;
    std::optional<double> largest_distance;  ///< of soft landmarks from their places, in the target's units
};

}  // namespace beltrami
