#pragma once

#include <limits>
#include <vector>

#include <beltrami/operators/surface.h>
#include <beltrami/registration/surface_landmarks.h>

namespace beltrami::bench {

/// A surface as if it were scanned again, and landmarks as a clinician might set them.
struct NoisyCopy {
    Mesh mesh;  ///< the same faces, every vertex moved in all directions by up to noise edges (mean length)
    std::vector<SurfaceLandmark> landmarks;  ///< inside, far apart; their places are off by so many edges of the mesh
    double edge = 0;                         ///< mean length
};

struct NoisyCopyOptions {
    int landmarks = 6;
    double noise = 0.1;  ///< of an edge
    int off = 2;         ///< edges from where a landmark would belong to its place
    double weight = std::numeric_limits<double>::infinity();
    std::uint64_t seed = 1;
};

/// @pre one component with a boundary
NoisyCopy noisy_copy(const Surface& surface, const NoisyCopyOptions& options = {});

}  // namespace beltrami::bench
