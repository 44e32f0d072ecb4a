#pragma once

#include <ctime>
#include <numbers>
#include <vector>

#include <beltrami/beltrami.h>
#include <beltrami/mesh/submesh.h>
#include <beltrami/report/timing.h>

namespace beltrami::bench {

/// A closed mesh less a face, its rim on the unit circle.
struct ClosedHarmonic {
    Surface open;
    BoundaryCondition boundary;

    explicit ClosedHarmonic(const Mesh& closed) : open(less_a_face(closed)) {
        const std::vector<int>& rim = open.topology.boundary_loops[0];
        for (std::size_t i = 0; i < rim.size(); ++i)
            boundary.pin(rim[i], std::polar(1.0, 2 * std::numbers::pi * static_cast<double>(i) /
                                                     static_cast<double>(rim.size())));
    }

  private:
    static Mesh less_a_face(const Mesh& closed) {
        std::vector<int> faces;
        for (int f = 1; f < closed.face_count(); ++f) faces.push_back(f);
        return keep_faces(closed, faces).mesh;
    }
};

/// Seconds of one harmonic map of a closed mesh less a face, with which benchmarks of closed surfaces compare.
inline double closed_harmonic(const Mesh& closed) {
    const ClosedHarmonic problem(closed);
    return harmonic_seconds(problem.open, problem.boundary);
}

/// Processor time of the program so far, of all threads: what other programs do at the time hardly counts.
inline double processor_seconds() {
    return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

/// The same harmonic map in processor time, mean of three.
inline double closed_harmonic_processor_seconds(const Mesh& closed) {
    const ClosedHarmonic problem(closed);
    const double begun = processor_seconds();
    (void)harmonic_seconds(problem.open, problem.boundary);  // solves three times
    return (processor_seconds() - begun) / 3;
}

}  // namespace beltrami::bench
