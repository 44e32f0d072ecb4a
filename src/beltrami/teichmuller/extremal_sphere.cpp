#include <beltrami/teichmuller/extremal_sphere.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <utility>

#include <beltrami/base/error.h>
#include <beltrami/solve/sphere_map_step.h>
#include <beltrami/sphere/moebius_fit.h>
#include <beltrami/starts/landmark_flow.h>
#include <beltrami/teichmuller/sphere_iteration.h>
#include <beltrami/unfold/sphere_repair.h>
#include <beltrami/uniformize/sphere_map.h>

namespace beltrami {

namespace {

constexpr int kFlowSteps = 20;
constexpr int kRelaxing = 3;  // steps of the barrier between two parts of the way of a start that is led
constexpr double kMostPart = 0.5, kLeastPart = 1 / 512.;  // of that way from one stop to the next
constexpr int kMostParts = 100;
constexpr double kLeastSeparation = 1e-3;  // of landmarks on the sphere

std::string short_number(double x) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2g", x);
    return text;
}

SphereLandmarks checked(const Surface& source, std::span<const SphereLandmark> given) {
    std::vector<char> used(static_cast<std::size_t>(source.mesh.vertex_count()), 0);
    for (const int v : source.mesh.faces.vertices()) used[v] = 1;
    const auto count = static_cast<Eigen::Index>(given.size());
    SphereLandmarks result{{}, Positions(count, 3), Eigen::VectorXd(count)};
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
double require_apart(const SphereLandmarks& landmarks, const Positions& points, const char* where) {
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

/// The landmarks put where they are to be, and folds opened.
struct Mended {
    Positions points;
    std::vector<int> folded;  ///< before
    bool success = true;
};

Mended mended(const Surface& source, const SphereFaces& faces, const std::vector<int>& vertices,
              const Positions& images, Positions points) {
    for (std::size_t i = 0; i < vertices.size(); ++i)
        points.row(vertices[i]) = images.row(static_cast<Eigen::Index>(i));
    Mended result{std::move(points), {}, true};
    result.folded = faces.flipped(result.points);
    if (result.folded.empty()) return result;
    Positions repaired = result.points;
    result.success = repair_sphere_map(source, faces, repaired, vertices).flipped.empty() &&
                     !moved_across(result.points, repaired, images);
    if (result.success) result.points = std::move(repaired);
    return result;
}

/// The flow in parts, after each of which the map is made less distorted with the landmarks held: it then goes farther
/// than a mesh can follow the flow by itself. No face is ever flipped, so that the class stays that of the flow.
std::optional<Positions> led_start(const Surface& source, const SphereFaces& faces, const std::vector<int>& vertices,
                                   const std::vector<Positions>& stops, Positions points) {
    const Positions first = points(vertices, Eigen::all);
    Mended begin = mended(source, faces, vertices, first, std::move(points));
    if (!begin.success) return {};
    points = std::move(begin.points);
    const Eigen::VectorXcd conformal = Eigen::VectorXcd::Zero(source.operators.sample_count());
    for (std::size_t leg = 0; leg + 1 < stops.size(); ++leg) {
        double time = 0, part = kMostPart;
        for (int parts = 0; time < 1; ++parts) {
            if (part < kLeastPart || parts == kMostParts) return {};
            const double next = std::min(1.0, time + part);
            const Positions images = along_great_circles(stops[leg], stops[leg + 1], next);
            const std::vector<Positions> way{along_great_circles(stops[leg], stops[leg + 1], time), images};
            Mended moved = mended(source, faces, vertices, images, landmark_flow(points, way, kFlowSteps));
            if (!moved.success) {
                part /= 2;
                continue;
            }
            SphereMapStep step(source, vertices, std::move(moved.points));
            for (int i = 0; i < kRelaxing; ++i) step.solve(conformal, 0);
            points = step.points();
            time = next;
            part = std::min(2 * part, kMostPart);
        }
    }
    return points;
}

/// Möbius map, flow, repair.
Positions start_map(const Surface& source, const Positions& on_sphere, const SphereLandmarks& landmarks,
                    const ExtremalSphereOptions& options, Warnings& warnings) {
    const std::vector<int>& vertices = landmarks.vertices;
    Positions first = options.start ? *options.start : moebius_fitted(on_sphere, vertices, landmarks.images);
    for (Eigen::Index v = 0; v < first.rows(); ++v) first.row(v).normalize();
    std::vector<Positions> stops;
    if (vertices.size() > 3 || options.start)
        stops = stops_between(first(vertices, Eigen::all), options.waypoints, landmarks.images);
    const SphereFaces faces(source);
    Mended start = mended(source, faces, vertices, landmarks.images,
                          stops.empty() ? first : landmark_flow(first, stops, kFlowSteps));
    if (!start.success) {
        std::optional<Positions> led =
            stops.empty() ? std::nullopt : led_start(source, faces, vertices, stops, std::move(first));
        if (!led)
            throw Error(Cause::bad_boundary,
                        "the start folds: " + std::to_string(start.folded.size()) +
                            " faces are flipped once the landmarks are at their images, and cannot be unfolded",
                        "the landmarks may contradict each other, or the mesh may be too coarse around them: check "
                        "their pairs, leave some out, or give another start or way",
                        {Things::faces, start.folded});
        return *std::move(led);
    }
    if (!start.folded.empty())
        warnings.push_back({WarningKind::unfolded, std::to_string(start.folded.size()) +
                                                       " faces were flipped in the start, and vertices around them "
                                                       "were moved"});
    return std::move(start.points);
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

void iterate(const Surface& source, const Positions& on_sphere, const SphereLandmarks& landmarks,
             const ExtremalSphereOptions& options, ExtremalSphereMap& result) {
    SphereProblem problem(source, on_sphere, landmarks.vertices, options.cluster_count);
    SphereIteration found = iterate_on_sphere(source, problem, on_sphere, result.start, landmarks, options);
    result.termination = found.converged && !found.held_up ? Termination::converged : Termination::iteration_limit;
    result.iterations = found.iterations;
    result.factorizations = found.factorizations;
    result.history = std::move(found.history);
    result.positions = std::move(found.points);
    result.residual = found.residual;
    result.dimension = problem.dimension();
    result.differential = problem.differential(found.last.direction);
    result.phi = found.last.phi;
    measure(source, result);
    record_bounds(source, found.last.k, result);
    if (found.held_up && found.converged)
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
    const SphereLandmarks marks = checked(source, landmarks);
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
