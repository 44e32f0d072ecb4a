#include <beltrami/registration/register_spheres.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

#include <Eigen/Geometry>

#include <beltrami/base/error.h>
#include <beltrami/charts/chart_places.h>
#include <beltrami/registration/sphere_locator.h>
#include <beltrami/teichmuller/sphere_iteration.h>
#include <beltrami/teichmuller/sphere_problem.h>
#include <beltrami/unfold/sphere_repair.h>

namespace beltrami {

namespace {

constexpr double kLeastLimb = 1e-3;  // on the sphere, of a limb that a landmark is in
constexpr double kAgreement = 5e-4;  // of k and that of the inverse map
constexpr int kStepsOfInverse = 8;   // where they do not agree

template <class Call>
auto of_surface(const char* name, Call&& call) {
    try {
        return call();
    } catch (const Error& error) {
        throw Error(error.cause(), std::string("the ") + name + ": " + error.what(), {}, error.where());
    }
}

Positions on_sphere(const Positions& sphere, std::span<const MeshPoint> places) {
    Positions points(static_cast<Eigen::Index>(places.size()), 3);
    for (std::size_t i = 0; i < places.size(); ++i)
        points.row(static_cast<Eigen::Index>(i)) = sphere_place(sphere, places[i]);
    return points;
}

/// The landmarks at every step; NaN where a step names none.
std::vector<Positions> stops(std::span<const SurfaceWaypoint> waypoints, std::span<const SurfaceLandmark> landmarks,
                             const Positions& sphere) {
    std::vector<Positions> result;
    for (const auto& named : stops_of(waypoints, landmarks)) {
        Positions& stop = result.emplace_back(Positions::Constant(static_cast<Eigen::Index>(landmarks.size()), 3,
                                                                  std::numeric_limits<double>::quiet_NaN()));
        for (std::size_t i = 0; i < named.size(); ++i)
            if (named[i]) stop.row(static_cast<Eigen::Index>(i)) = sphere_place(sphere, *named[i]);
    }
    return result;
}

/// k of the map back, which takes every vertex of the target to its place in the source's sphere. A c-step finds it of
/// the map as it is sampled there; where that is far from k of the map, a few steps of the iteration first: it may only
/// have been sampled too coarsely.
/// @param places of these vertices on the source
double k_of_inverse(const Surface& target, std::span<const SurfaceLandmark> landmarks, const SphereRegistration& found,
                    std::span<const MeshPoint> places, int cluster_count) {
    Positions back = on_sphere(found.source_sphere.positions, places);
    std::vector<int> vertices;
    for (const SurfaceLandmark& landmark : landmarks) {
        const MeshPoint& place = found.places[landmark.vertex];
        vertices.push_back(nearest_vertex(place));
        if (*std::max_element(place.barycentric.begin(), place.barycentric.end()) == 1)
            back.row(vertices.back()) = found.source_sphere.positions.row(landmark.vertex);
    }
    const Positions& sphere = found.target_sphere.positions;
    SphereProblem problem(target, sphere, vertices, cluster_count);
    const double sampled = problem.coefficient_step(beltrami_coefficient(target.operators, back, back)).k;
    if (std::abs(sampled - found.map.k) < kAgreement) return sampled;
    const SphereFaces faces(target);
    if (!faces.flipped(back).empty() && !repair_sphere_map(target, faces, back, vertices).flipped.empty())
        return sampled;
    ExtremalSphereOptions few;
    few.cluster_count = cluster_count;
    few.max_iterations = kStepsOfInverse;
    const Positions images = back(vertices, Eigen::all);
    const SphereLandmarks held{vertices, images,
                               Eigen::VectorXd::Constant(images.rows(), std::numeric_limits<double>::infinity())};
    try {
        return iterate_on_sphere(target, problem, sphere, back, held, few).last.k;
    } catch (const Error& error) {
        if (error.cause() == Cause::cancelled) throw;
        return sampled;  // a check that cannot be made is no fault of the map
    }
}

/// @throw Error bad_boundary for a landmark of four or more around which a thousandth of the surface lies within 1e-3
/// on
///        its sphere: deep inside a limb, of which a map to the sphere keeps hardly any digits
template <class VertexOf>
void require_outside_limbs(const char* name, const Surface& surface, const Positions& sphere,
                           std::span<const SurfaceLandmark> landmarks, VertexOf&& vertex_of) {
    if (landmarks.size() < 4) return;
    for (const SurfaceLandmark& landmark : landmarks) {
        const int vertex = vertex_of(landmark);
        const double size = limb_size(surface, sphere, vertex);
        if (size >= kLeastLimb) continue;
        char text[32];
        std::snprintf(text, sizeof text, "%.1g", size);
        throw Error(
            Cause::bad_boundary,
            std::string("the ") + name + ": vertex " + std::to_string(vertex) +
                " of a landmark lies deep inside a thin limb: the thousandth of the surface around it lies within " +
                text + " on the conformal sphere",
            "move it to where the limb begins, leave it out, or cut the limb off",
            {Things::vertices, {landmark.vertex}});
    }
}

}  // namespace

SphereRegistration register_spheres(const Surface& source, const Surface& target,
                                    std::span<const SurfaceLandmark> landmarks, const RegistrationOptions& options) {
    of_surface("source", [&] { require_sphere(source); });
    of_surface("target", [&] { require_sphere(target); });
    SphereRegistration result;
    result.source_sphere = of_surface("source", [&] { return sphere_map(source, options.sphere); });
    result.target_sphere = of_surface("target", [&] { return sphere_map(target, options.sphere); });
    const Positions& sphere = result.target_sphere.positions;
    std::vector<SphereLandmark> images;
    require_outside_limbs("source", source, result.source_sphere.positions, landmarks,
                          [](const SurfaceLandmark& landmark) { return landmark.vertex; });
    require_outside_limbs("target", target, sphere, landmarks,
                          [](const SurfaceLandmark& landmark) { return nearest_vertex(landmark.place); });
    for (const SurfaceLandmark& landmark : landmarks)
        images.push_back({landmark.vertex, sphere_place(sphere, landmark.place),
                          landmark.weight * squared_scale(target, sphere, landmark.place)});
    ExtremalSphereOptions how = options.map;
    if (!options.start.empty()) how.start = on_sphere(sphere, options.start);
    how.waypoints = stops(options.waypoints, landmarks, sphere);
    result.map = extremal_sphere_map(source, result.source_sphere.positions, images, how);

    result.places = SphereLocator(target.mesh.faces, sphere).locate(result.map.positions);
    meet_landmarks(landmarks, result);
    const std::vector<MeshPoint> back = SphereLocator(source.mesh.faces, result.map.positions).locate(sphere);
    result.measure(source, target, result.map.distortion.mu, back);
    measure_landmarks(target.mesh, landmarks, result);
    if (options.check_inverse && landmarks.size() > 3)
        result.inverse_k = k_of_inverse(target, landmarks, result, back, how.cluster_count);
    for (const auto& [name, warnings] :
         {std::pair{"source", &result.source_sphere.warnings}, std::pair{"target", &result.target_sphere.warnings}})
        for (const Warning& warning : *warnings) result.warnings.push_back(prefixed(name, warning));
    append(result.warnings, result.map.warnings);
    return result;
}

}  // namespace beltrami
