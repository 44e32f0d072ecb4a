#include <beltrami/teichmuller/extremal_sphere.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

#include <beltrami/base/error.h>
#include <beltrami/certificate/refined_problem.h>
#include <beltrami/sphere/moebius_fit.h>
#include <beltrami/starts/landmark_flow.h>
#include <beltrami/teichmuller/around_landmarks.h>
#include <beltrami/teichmuller/soft_landmarks.h>
#include <beltrami/teichmuller/sphere_problem.h>
#include <beltrami/unfold/sphere_repair.h>
#include <beltrami/uniformize/sphere_map.h>

namespace beltrami {

namespace {

constexpr double kTolerance = 1e-5, kToleranceOfK = 0.1;
/// Steps that would narrow the bracket by less than this part are not worth while: k moves by 1e-5 of itself or less.
constexpr double kWithinBracket = 3e-3;
constexpr int kFlowSteps = 20;
constexpr double kLeastSeparation = 1e-3;  // of landmarks on the sphere
constexpr int kStepsBack = 3;              // on the mesh itself after one that is finer around landmarks
constexpr double kHeldUp = 0.05;           // part of a step below which something holds up the map

std::string short_number(double x) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2g", x);
    return text;
}

/// Landmarks as columns: vertices, where they are, where they go.
struct Landmarks {
    std::vector<int> vertices;
    Positions images;
    Eigen::VectorXd weights;

    bool soft() const { return !weights.array().isInf().all(); }
};

Landmarks checked(const Surface& source, std::span<const SphereLandmark> given) {
    std::vector<char> used(static_cast<std::size_t>(source.mesh.vertex_count()), 0);
    for (const int v : source.mesh.faces.vertices()) used[v] = 1;
    const auto count = static_cast<Eigen::Index>(given.size());
    Landmarks result{{}, Positions(count, 3), Eigen::VectorXd(count)};
    for (const SphereLandmark& landmark : given) {
        const int v = landmark.vertex;
        if (v < 0 || v >= source.mesh.vertex_count() || !used[v])
            throw Error(Cause::bad_boundary, "landmark " + std::to_string(v) + " is no vertex of a face",
                        "name a vertex of the surface", {Things::vertices, {v}});
        if (used[v]++ == 2)
            throw Error(Cause::bad_boundary, "vertex " + std::to_string(v) + " is a landmark twice",
                        "name every landmark once", {Things::vertices, {v}});
        if (!(landmark.image.allFinite() && landmark.image.norm() > 0))
            throw Error(Cause::bad_boundary, "the image of vertex " + std::to_string(v) + " is no point of the sphere",
                        "give a point other than the centre", {Things::vertices, {v}});
        if (!(landmark.weight > 0))
            throw Error(Cause::bad_option, "the weight of landmark " + std::to_string(v) + " is not positive", {},
                        {Things::vertices, {v}});
        const auto i = static_cast<Eigen::Index>(result.vertices.size());
        result.images.row(i) = landmark.image.normalized();
        result.weights[i] = landmark.weight;
        result.vertices.push_back(v);
    }
    return result;
}

/// @return the least distance between two landmarks
double require_apart(const Landmarks& landmarks, const Positions& points, const char* where) {
    double least = 2;
    for (Eigen::Index i = 0; i < points.rows(); ++i)
        for (Eigen::Index j = 0; j < i; ++j) {
            const double distance = (points.row(i) - points.row(j)).norm();
            least = std::min(least, distance);
            if (distance >= kLeastSeparation) continue;
            const int a = landmarks.vertices[j], b = landmarks.vertices[i];
            throw Error(
                Cause::bad_boundary,
                "landmarks " + std::to_string(a) + " and " + std::to_string(b) +
                    (distance == 0 ? std::string(" coincide on the ")
                                   : " are " + short_number(distance) + " apart on the conformal sphere of the ") +
                    where,
                distance == 0 ? "leave one of them out"
                              : "landmarks inside one thin limb, closer than 1e-3, cannot be told apart: leave "
                                "all but one out, or move them to where the limb begins",
                {Things::vertices, {a, b}});
        }
    return least;
}

/// The landmarks' stops, those that are left open filled in.
std::vector<Positions> stops_between(const Positions& from, const std::vector<Positions>& waypoints,
                                     const Positions& to) {
    std::vector<Positions> stops{from};
    const double legs = static_cast<double>(waypoints.size()) + 1;
    for (std::size_t step = 0; step < waypoints.size(); ++step) {
        const Positions straight = along_great_circles(from, to, (static_cast<double>(step) + 1) / legs);
        Positions stop = waypoints[step];
        for (Eigen::Index i = 0; i < stop.rows(); ++i)
            stop.row(i) = std::isnan(stop(i, 0)) ? straight.row(i) : stop.row(i).normalized();
        stops.push_back(std::move(stop));
    }
    stops.push_back(to);
    return stops;
}

/// Whether some point has moved so far, by half of its distance from a landmark, that the homotopy class may be
/// another.
bool moved_across(const Positions& from, const Positions& to, const Positions& landmarks) {
    for (Eigen::Index v = 0; v < from.rows(); ++v) {
        const double moved = (to.row(v) - from.row(v)).norm();
        if (moved == 0) continue;
        for (Eigen::Index i = 0; i < landmarks.rows(); ++i)
            if (moved > 0.5 * (landmarks.row(i) - from.row(v)).norm()) return true;
    }
    return false;
}

/// Möbius map, flow, repair.
Positions start_map(const Surface& source, const Positions& on_sphere, const Landmarks& landmarks,
                    const ExtremalSphereOptions& options, Warnings& warnings) {
    const std::vector<int>& vertices = landmarks.vertices;
    Positions points = options.start ? *options.start : moebius_fitted(on_sphere, vertices, landmarks.images);
    for (Eigen::Index v = 0; v < points.rows(); ++v) points.row(v).normalize();
    if (vertices.size() > 3 || options.start) {
        const std::vector<Positions> stops =
            stops_between(points(vertices, Eigen::all), options.waypoints, landmarks.images);
        points = landmark_flow(std::move(points), stops, kFlowSteps);
    }
    for (std::size_t i = 0; i < vertices.size(); ++i)
        points.row(vertices[i]) = landmarks.images.row(static_cast<Eigen::Index>(i));
    const SphereFaces faces(source);
    const std::vector<int> folded = faces.flipped(points);
    if (folded.empty()) return points;
    Positions repaired = points;
    const SphereRepair repair = repair_sphere_map(source, faces, repaired, vertices);
    if (!repair.flipped.empty() || moved_across(points, repaired, landmarks.images))
        throw Error(Cause::bad_boundary,
                    "the start folds: " + std::to_string(folded.size()) +
                        " faces are flipped once the landmarks are at their images, and cannot be unfolded",
                    "the landmarks may contradict each other, or the mesh may be too coarse around them: check their "
                    "pairs, leave some out, or give another start or way",
                    {Things::faces, folded});
    warnings.push_back({WarningKind::unfolded, std::to_string(folded.size()) +
                                                   " faces were flipped in the start, and vertices around them were "
                                                   "moved"});
    return repaired;
}

HamiltonIteration::Options iteration_options(const ExtremalSphereOptions& options) {
    HamiltonIteration::Options result;
    result.tolerance = options.tolerance > 0 ? options.tolerance : kTolerance;
    result.k_tolerance = kToleranceOfK * result.tolerance;
    result.max_iterations = options.max_iterations;
    result.anderson_window = 0;
    result.grow_first = result.grow_last = false;
    result.progress = options.progress;
    return result;
}

/// What the map comes to, whatever found it.
void measure(const Surface& source, ExtremalSphereMap& result) {
    result.distortion = distortion(source.operators, result.positions, result.positions);
    result.K_max = result.distortion.K_max();
    std::vector<double> weights = source.operators.weights;
    for (Eigen::Index s = 0; s < result.phi.size(); ++s) weights[s] *= std::abs(result.phi[s]);
    const bool conformal = result.phi.size() == 0 || result.differential.zero();
    const MuStatistics by_phi = mu_statistics(result.distortion.mu, conformal ? source.operators.weights : weights);
    result.weighted_mean = by_phi.mean;
    result.weighted_deviation = by_phi.standard_deviation;
}

void record_bounds(const Surface& source, double k, ExtremalSphereMap& result) {
    result.k = k;
    result.K = std::min(dilatation(k), result.K_max);
    const ReichStrebel integrals = reich_strebel(source, result.differential, result.distortion.mu);
    if (integrals.valid) {
        result.K_lower = std::clamp(integrals.lower, 1.0, result.K);
        result.bounds.push_back({Bound::Kind::reich_strebel, result.K_lower, Bound::Of::extremal, false});
        result.bounds.push_back({Bound::Kind::reich_strebel_estimate, integrals.estimate, Bound::Of::extremal, false});
    }
    if (std::isfinite(result.K_max))
        result.bounds.push_back({Bound::Kind::attained, result.K_max, Bound::Of::extremal, false});
}

/// Where the iteration came to.
struct Settled {
    Positions points;
    CoefficientStep::Result last;
    double residual = 0;  ///< largest distance of a soft landmark
    bool converged = false, held_up = false;
    int iterations = 0, factorizations = 0;
    std::vector<Iteration> history;
};

/// Hamilton's iteration from a start. Images are turned by the Möbius map that brings the landmarks nearest to where
/// they are in the source, and at the end back: that costs nothing, and away from the landmarks the map is then about
/// as smooth as a mesh can draw it. Soft landmarks measure distances and stay where they are.
/// @param surface that of the problem
/// @param turn    whether to turn them: in crowded parts faces may be flipped when the map is turned back
Settled settle(const Surface& surface, SphereProblem& problem, const Positions& on_sphere, const Positions& start,
               const Landmarks& landmarks, const ExtremalSphereOptions& options, bool turn = true) {
    const SphereFaces faces(surface);
    Positions from = start;
    turn = turn && !landmarks.soft();
    if (turn) from = moebius_fitted(start, landmarks.vertices, on_sphere(landmarks.vertices, Eigen::all));
    const bool turned = turn && faces.flipped(from).empty();
    SphereMapStep step(surface, landmarks.vertices, turned ? from : start);
    Settled result;
    if (landmarks.soft()) {
        SoftLandmarks soft(surface, problem, step, landmarks.vertices, landmarks.images, landmarks.weights,
                           iteration_options(options));
        result.iterations = soft.settle();
        result.residual = (soft.places() - landmarks.images).rowwise().norm().maxCoeff();
    }
    HamiltonIteration::Options how = iteration_options(options);
    if (!landmarks.soft() && !(options.tolerance > 0)) how.within_bracket = kWithinBracket;
    const HamiltonIteration iteration = problem.settle(step, std::move(how));
    result.last = iteration.last_step();
    result.held_up = step.last_length() < kHeldUp && result.last.k > kTolerance;
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

/// k conj(φ)/|φ|
Eigen::VectorXcd coefficient(double k, const Eigen::VectorXcd& phi) {
    return phi.unaryExpr([k](Complex value) { return value == 0.0 ? value : k * std::conj(value) / std::abs(value); });
}

/// k of the iteration on a mesh that is finer around the landmarks. What its map leaves on this one is too coarse for
/// it there: φ is found anew, and a few steps go towards it. Nothing if faces are flipped.
std::optional<Settled> settle_finer(const Surface& source, SphereProblem& problem, const Positions& on_sphere,
                                    const Positions& start, const Landmarks& landmarks,
                                    const ExtremalSphereOptions& options) {
    if (!all_triangles(source.mesh)) return {};
    const AroundLandmarks finer = refined_around(source, landmarks.vertices, {on_sphere, start});
    SphereProblem there(finer.surface, finer.maps[0], landmarks.vertices, options.cluster_count);
    Settled result = settle(finer.surface, there, finer.maps[0], finer.maps[1], landmarks, options);
    result.points.conservativeResize(source.mesh.vertex_count(), 3);
    if (!SphereFaces(source).flipped(result.points).empty()) return {};
    const double k = result.last.k;
    result.last = problem.coefficient_step(beltrami_coefficient(source.operators, result.points, result.points));
    result.last.k = k;
    SphereMapStep step(source, landmarks.vertices, std::move(result.points));
    step.weigh(result.last.phi);
    for (int i = 0; i < kStepsBack; ++i) step.solve(coefficient(k, result.last.phi), 0);
    result.factorizations += step.factorization_count();
    result.points = step.points();
    return result;
}

void iterate(const Surface& source, const Positions& on_sphere, const Landmarks& landmarks,
             const ExtremalSphereOptions& options, ExtremalSphereMap& result) {
    SphereProblem problem(source, on_sphere, landmarks.vertices, options.cluster_count);
    std::optional<Settled> found = settle_finer(source, problem, on_sphere, result.start, landmarks, options);
    if (!found) found = settle(source, problem, on_sphere, result.start, landmarks, options);
    result.termination = found->converged && !found->held_up ? Termination::converged : Termination::iteration_limit;
    result.iterations = found->iterations;
    result.factorizations = found->factorizations;
    result.history = std::move(found->history);
    result.positions = std::move(found->points);
    result.residual = found->residual;
    result.dimension = problem.dimension();
    result.differential = problem.differential(found->last.direction);
    result.phi = found->last.phi;
    measure(source, result);
    record_bounds(source, found->last.k, result);
    if (found->held_up && found->converged)
        result.warnings.push_back(
            {WarningKind::rough, "faces that are about to flip hold the map up: k is too large by what they cost"});
}

}  // namespace

void ExtremalSphereOptions::validate() const {
    IterationOptions::validate();
    if (cluster_count < 100) throw Error(Cause::bad_option, "cluster_count must be at least 100");
}

ExtremalSphereMap extremal_sphere_map(const Surface& source, const Positions& on_sphere,
                                      std::span<const SphereLandmark> landmarks, const ExtremalSphereOptions& options) {
    options.validate();
    require_sphere(source);
    const auto require_points = [&](const Positions& points, Eigen::Index rows, const char* what) {
        if (points.rows() != rows || points.cols() != 3 || !points.allFinite())
            throw Error(Cause::bad_option,
                        std::string(what) + " must have " + std::to_string(rows) + " rows of 3 finite numbers");
    };
    require_points(on_sphere, source.mesh.vertex_count(), "the map to the sphere");
    if (options.start) require_points(*options.start, source.mesh.vertex_count(), "the start");
    for (const Positions& stop : options.waypoints)
        if (stop.rows() != static_cast<Eigen::Index>(landmarks.size()) || stop.cols() != 3)
            throw Error(Cause::bad_option, "every stop must have a row of 3 numbers for each landmark");
    const Landmarks marks = checked(source, landmarks);
    ExtremalSphereMap result;
    result.separation = std::min(require_apart(marks, on_sphere(marks.vertices, Eigen::all), "source"),
                                 require_apart(marks, marks.images, "target"));
    result.start = start_map(source, on_sphere, marks, options, result.warnings);
    if (marks.vertices.size() > 3) {
        iterate(source, on_sphere, marks, options, result);
    } else {
        result.positions = result.start;
        if (options.start || !options.waypoints.empty())
            result.positions = moebius_fitted(on_sphere, marks.vertices, marks.images);
        result.phi = Eigen::VectorXcd::Zero(source.operators.sample_count());
        measure(source, result);
    }
    warn_of_folds_and_limit(std::to_string(result.iterations) + " iterations before k and φ settled", result);
    return result;
}

}  // namespace beltrami
