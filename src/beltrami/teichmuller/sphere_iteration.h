#pragma once

#include <vector>

#include <beltrami/teichmuller/extremal_sphere.h>
#include <beltrami/teichmuller/sphere_problem.h>

namespace beltrami {

/// Landmarks as columns: vertices, where they go, and how much that counts.
struct SphereLandmarks {
    std::vector<int> vertices;
    Positions images;
    Eigen::VectorXd weights;

    bool soft() const { return !weights.array().isInf().all(); }
};

/// Where the iteration on the sphere came to.
struct SphereIteration {
    Positions points;
    CoefficientStep::Result last;
    double residual = 0;  ///< largest distance of a soft landmark
    bool converged = false;
    bool held_up = false;  ///< by faces that are about to flip
    int iterations = 0, factorizations = 0;
    std::vector<Iteration> history;
};

/// Hamilton's iteration from a start without flipped faces, for what k is. Meshes, of quads the triangles that are
/// their halves, are finer for it around the landmarks, where few faces cannot follow μ. The error of k that is left
/// goes with the square of the mesh width; on small meshes without soft landmarks k is found again with all edges
/// halved, and extrapolated. Points and φ are those of the mesh itself.
/// @param problem   of the source and the landmarks
/// @param on_sphere, start #V×3 unit vectors
/// @throw Error cancelled, not_solved
SphereIteration iterate_on_sphere(const Surface& source, SphereProblem& problem, const Positions& on_sphere,
                                  const Positions& start, const SphereLandmarks& landmarks,
                                  const ExtremalSphereOptions& options);

}  // namespace beltrami
