#pragma once

#include <numbers>
#include <vector>

#include <beltrami/beltrami.h>
#include <beltrami/mesh/submesh.h>
#include <beltrami/report/timing.h>

namespace beltrami::bench {

/// Seconds of one harmonic map of a closed mesh less a face, with which benchmarks of closed surfaces compare.
inline double closed_harmonic(const Mesh& closed) {
    std::vector<int> faces;
    for (int f = 1; f < closed.face_count(); ++f) faces.push_back(f);
    const Surface open(keep_faces(closed, faces).mesh);
    BoundaryCondition boundary;
    const std::vector<int>& rim = open.topology.boundary_loops[0];
    for (std::size_t i = 0; i < rim.size(); ++i)
        boundary.pin(rim[i],
                     std::polar(1.0, 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(rim.size())));
    return harmonic_seconds(open, boundary);
}

}  // namespace beltrami::bench
