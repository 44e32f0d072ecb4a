#include <beltrami/teichmuller/sphere_iteration.h>

#include <cmath>
#include <optional>
#include <utility>

#include <beltrami/certificate/refined_problem.h>
#include <beltrami/meshing/face_split.h>
#include <beltrami/sphere/moebius_fit.h>
#include <beltrami/teichmuller/around_landmarks.h>
#include <beltrami/teichmuller/soft_landmarks.h>
#include <beltrami/unfold/sphere_repair.h>

namespace beltrami {

namespace {

constexpr double kSphereTolerance = 1e-5, kSphereToleranceOfK = 0.1;
/// Steps that would narrow the bracket by less than this part are not worth while: k moves by 1e-5 of itself or less.
constexpr double kWithinSphereBracket = 3e-3;
constexpr int kStepsBack = 3;     // on the mesh itself after one that is finer around landmarks
constexpr double kHeldUp = 0.05;  // part of a step below which something holds up the map
/// Meshes on which a c-step is cheap: for these the iteration is repeated on finer ones.
constexpr int kSmallMesh = 10'000;
constexpr Fineness kAroundLandmarks{.halvings = 2, .rings = 1}, kAroundLandmarksOnSmallMesh{.halvings = 4, .rings = 3};
/// Of k, from one mesh width to its half: beyond that the first is no mesh width to extrapolate from.
constexpr double kExtrapolated = 0.02;

HamiltonIteration::Options iteration_options(const ExtremalSphereOptions& options) {
    HamiltonIteration::Options result;
    result.tolerance = options.tolerance > 0 ? options.tolerance : kSphereTolerance;
    result.k_tolerance = kSphereToleranceOfK * result.tolerance;
    result.max_iterations = options.max_iterations;
    result.anderson_window = 0;
    result.grow_first = result.grow_last = false;
    result.progress = options.progress;
    return result;
}

/// Hamilton's iteration from a start. Images are turned by the Möbius map that brings the landmarks nearest to where
/// they are in the source, and at the end back: that costs nothing, and away from the landmarks the map is then about
/// as smooth as a mesh can draw it. Soft landmarks measure distances and stay where they are.
/// @param surface that of the problem
/// @param turn    whether to turn them: in crowded parts faces may be flipped when the map is turned back
SphereIteration settle(const Surface& surface, SphereProblem& problem, const Positions& on_sphere,
                       const Positions& start, const SphereLandmarks& landmarks, const ExtremalSphereOptions& options,
                       bool turn = true) {
    const SphereFaces faces(surface);
    Positions from = start;
    turn = turn && !landmarks.soft();
    if (turn) from = moebius_fitted(start, landmarks.vertices, on_sphere(landmarks.vertices, Eigen::all));
    const bool turned = turn && faces.flipped(from).empty();
    SphereMapStep step(surface, landmarks.vertices, turned ? from : start);
    SphereIteration result;
    if (landmarks.soft()) {
        SoftLandmarks soft(surface, problem, step, landmarks.vertices, landmarks.images, landmarks.weights,
                           iteration_options(options));
        result.iterations = soft.settle();
        result.residual = (soft.places() - landmarks.images).rowwise().norm().maxCoeff();
    }
    HamiltonIteration::Options how = iteration_options(options);
    if (!landmarks.soft() && !(options.tolerance > 0)) how.within_bracket = kWithinSphereBracket;
    const HamiltonIteration iteration = problem.settle(step, how);
    result.last = iteration.last_step();
    result.held_up = step.last_length() < kHeldUp && result.last.k > kSphereTolerance;
    result.converged = iteration.converged();
    result.iterations += iteration.iterations();
    result.factorizations = step.factorization_count();
    result.history = iteration.history();
    result.points = step.points();
    if (turned) {
        result.points = moebius_fitted(std::move(result.points), landmarks.vertices, landmarks.images);
        for (std::size_t i = 0; i < landmarks.vertices.size(); ++i)
            result.points.row(landmarks.vertices[i]) = landmarks.images.row(static_cast<Eigen::Index>(i));
        if (!faces.flipped(result.points).empty() &&
            !repair_sphere_map(surface, faces, result.points, landmarks.vertices).flipped.empty())
            return settle(surface, problem, on_sphere, start, landmarks, options, false);
    }
    return result;
}

/// The iteration on a mesh that is finer around the landmarks, left at the vertices of the surface itself. Nothing if
/// faces are flipped there.
std::optional<SphereIteration> settle_around(const Surface& surface, const std::vector<Positions>& maps,
                                             const SphereLandmarks& landmarks, const ExtremalSphereOptions& options,
                                             Fineness fineness) {
    const AroundLandmarks finer = refined_around(surface, landmarks.vertices, maps, fineness);
    SphereProblem problem(finer.surface, finer.maps[0], landmarks.vertices, options.cluster_count);
    SphereIteration result = settle(finer.surface, problem, finer.maps[0], finer.maps[1], landmarks, options);
    result.points.conservativeResize(surface.mesh.vertex_count(), 3);
    if (!SphereFaces(surface).flipped(result.points).empty()) return {};
    return result;
}

/// Goes on from there with all edges halved. The error of k being of the second order, a third of its change is left.
/// Without a word stays with the first if anything is wrong with the second.
void extrapolate(const Surface& source, const Positions& on_sphere, const SphereLandmarks& landmarks,
                 const ExtremalSphereOptions& options, SphereIteration& first) {
    const AroundLandmarks halved = refined_everywhere(source, {on_sphere, first.points});
    std::optional<SphereIteration> second =
        settle_around(halved.surface, halved.maps, landmarks, options, kAroundLandmarksOnSmallMesh);
    if (!second || !second->converged || second->held_up) return;
    second->points.conservativeResize(source.mesh.vertex_count(), 3);
    if (!SphereFaces(source).flipped(second->points).empty()) return;
    const double change = second->last.k - first.last.k;
    first.points = std::move(second->points);
    first.last.k = second->last.k;
    if (std::abs(change) < kExtrapolated * first.last.k) first.last.k += change / 3;
    first.iterations += second->iterations;
    first.factorizations += second->factorizations;
    first.history.insert(first.history.end(), second->history.begin(), second->history.end());
}

/// The same surface with its quads as two triangles each, which can be made finer around landmarks. Nothing where there
/// are no quads, they have a metric of their own, or their halves are flipped in one of the two maps.
std::optional<Surface> quads_in_two(const Surface& source, const Positions& on_sphere, const Positions& start) {
    if (all_triangles(source.mesh) || source.metric) return {};
    Surface result(split_into_triangles(source.mesh).mesh);
    const SphereFaces faces(result);
    if (!faces.flipped(on_sphere).empty() || !faces.flipped(start).empty()) return {};
    return result;
}

/// What a map of a finer mesh leaves on this one is too coarse for it: φ is found anew, and a few steps go towards it.
void settle_back(const Surface& source, SphereProblem& problem, const SphereLandmarks& landmarks,
                 SphereIteration& result) {
    const double k = result.last.k;
    result.last = problem.coefficient_step(beltrami_coefficient(source.operators, result.points, result.points));
    result.last.k = k;
    SphereMapStep step(source, landmarks.vertices, std::move(result.points));
    step.weigh(result.last.phi);
    for (int i = 0; i < kStepsBack; ++i) step.solve(teichmueller_coefficient(k, result.last.phi), 0);
    result.factorizations += step.factorization_count();
    result.points = step.points();
}

}  // namespace

SphereIteration iterate_on_sphere(const Surface& source, SphereProblem& problem, const Positions& on_sphere,
                                  const Positions& start, const SphereLandmarks& landmarks,
                                  const ExtremalSphereOptions& options) {
    std::optional<SphereIteration> found;
    const std::optional<Surface> halves = quads_in_two(source, on_sphere, start);
    if (halves || all_triangles(source.mesh)) {
        const Surface& triangles = halves ? *halves : source;
        const bool small = triangles.mesh.face_count() <= kSmallMesh && !landmarks.soft();
        found = settle_around(triangles, {on_sphere, start}, landmarks, options,
                              small ? kAroundLandmarksOnSmallMesh : kAroundLandmarks);
        if (found && small && found->converged && !found->held_up)
            extrapolate(triangles, on_sphere, landmarks, options, *found);
        if (found && halves && !SphereFaces(source).flipped(found->points).empty()) found.reset();
    }
    if (!found) return settle(source, problem, on_sphere, start, landmarks, options);
    settle_back(source, problem, landmarks, *found);
    return *std::move(found);
}

}  // namespace beltrami
