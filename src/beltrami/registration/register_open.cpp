#include <beltrami/registration/register_open.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <beltrami/base/error.h>
#include <beltrami/charts/chart_places.h>
#include <beltrami/registration/braided_start.h>
#include <beltrami/registration/soft_pins.h>
#include <beltrami/registration/transfer.h>
#include <beltrami/starts/target_model.h>
#include <beltrami/teichmuller/extremal_solver.h>

namespace beltrami {

namespace {

/// The problem on the target's circle domain.
struct Problem {
    Constraints constraints;
    std::vector<double> weights;  ///< of the pins
    std::vector<int> pinned;      ///< of every landmark the number of its pin; −1: it is on the boundary
    std::vector<int> far;         ///< landmarks on the boundary whose place is far from the target's
    bool soft = false;
};

Positions plane_positions(const Eigen::VectorXcd& plane) {
    Positions positions(plane.size(), 2);
    positions << plane.real(), plane.imag();
    return positions;
}

void require_landmarks(const Surface& source, std::span<const SurfaceLandmark> landmarks) {
    for (std::size_t i = 0; i < landmarks.size(); ++i) {
        const int v = landmarks[i].vertex;
        if (v < 0 || v >= source.mesh.vertex_count())
            throw Error(Cause::bad_boundary, "landmark " + std::to_string(v) + " is no vertex of the surface",
                        "name a vertex of a face", {Things::vertices, {v}});
        for (std::size_t j = 0; j < i; ++j)
            if (landmarks[j].vertex == v)
                throw Error(Cause::bad_boundary, "vertex " + std::to_string(v) + " is a landmark twice",
                            "name every landmark once", {Things::vertices, {v}});
        if (!(landmarks[i].weight > 0))
            throw Error(Cause::bad_option, "the weight of landmark " + std::to_string(v) + " is not positive", {},
                        {Things::vertices, {v}});
    }
}

Problem problem_of(const Surface& source, const Surface& target, std::span<const SurfaceLandmark> landmarks,
                   const CircleDomainChart& circles, int outer_loop) {
    Problem problem{Constraints(circle_target(circles)), {}, {}, {}, false};
    problem.constraints.correspondence.outer_loop = outer_loop;
    const TargetDomain& domain = *problem.constraints.domain();
    const Positions chart = plane_positions(circles.chart.vertices);
    for (const SurfaceLandmark& landmark : landmarks) {
        const int v = landmark.vertex;
        const Complex image = landmark.place.interpolate(circles.chart.vertices);
        const bool soft = std::isfinite(landmark.weight);
        if (source.topology.on_boundary[v]) {
            if (soft)
                throw Error(Cause::bad_option, "landmark " + std::to_string(v) + " is soft and on the boundary",
                            "boundaries slide: leave it out, or prescribe it without a weight",
                            {Things::vertices, {v}});
            problem.constraints.correspondence.marks.push_back(nearest_mark(domain, v, image));
            if (distance_from(domain, problem.constraints.correspondence.marks.back(), image) > kFarMark)
                problem.far.push_back(v);
            problem.pinned.push_back(-1);
            continue;
        }
        problem.constraints.pin(v, image);
        problem.pinned.push_back(static_cast<int>(problem.weights.size()));
        problem.weights.push_back(landmark.weight * squared_scale(target, chart, landmark.place));
        problem.soft = problem.soft || soft;
    }
    return problem;
}

/// The start that is asked for, as a map to the target's circle domain.
Eigen::VectorXcd wanted_start(const Surface& source, std::span<const MeshPoint> places,
                              const CircleDomainChart& circles) {
    if (static_cast<int>(places.size()) != source.mesh.vertex_count())
        throw Error(Cause::bad_option, "the start has " + std::to_string(places.size()) + " places, the source " +
                                           std::to_string(source.mesh.vertex_count()) + " vertices");
    Eigen::VectorXcd start(source.mesh.vertex_count());
    for (std::size_t v = 0; v < places.size(); ++v)
        start[static_cast<Eigen::Index>(v)] = places[v].interpolate(circles.chart.vertices);
    return start;
}

/// The steps of ways in the target's circle domain, in the order of the pins.
std::vector<std::vector<std::optional<Complex>>> stops_in(const CircleDomainChart& circles, const Problem& problem,
                                                          std::span<const SurfaceWaypoint> waypoints,
                                                          std::span<const SurfaceLandmark> landmarks) {
    std::vector<std::vector<std::optional<Complex>>> result;
    for (const auto& named : stops_of(waypoints, landmarks)) {
        auto& stop = result.emplace_back(problem.weights.size());
        for (std::size_t i = 0; i < named.size(); ++i) {
            if (!named[i]) continue;
            const int v = landmarks[i].vertex;
            if (problem.pinned[i] < 0)
                throw Error(Cause::bad_option, "landmark " + std::to_string(v) + " is on the boundary and has a way",
                            "ways are those of landmarks inside", {Things::vertices, {v}});
            stop[problem.pinned[i]] = named[i]->interpolate(circles.chart.vertices);
        }
    }
    return result;
}

/// The extremal map in the class of the landmarks' ways. Soft landmarks are met first: from there on they move little.
ExtremalMap map_along_ways(const Surface& source, const Problem& problem,
                           std::span<const std::vector<std::optional<Complex>>> stops, ExtremalOptions how) {
    const BraidedStart braided = braided_start(source, problem.constraints, stops);
    how.start = braided.map;
    ExtremalMap result = extremal_map(source, problem.constraints, how);
    if (!result.one_to_one() || !braided.same_class(result.map.head(source.mesh.vertex_count())))
        throw Error(Cause::not_solved,
                    "no map of least dilatation was found in the class that the landmarks' ways say: from the map with "
                    "landmarks led along them the iteration " +
                        std::string(result.one_to_one() ? "left it" : "ended folded"),
                    "refine the mesh of the source, or check that the ways do not wind around each other more often "
                    "than is meant");
    if (!problem.soft) return result;
    how.start = result.map.head(source.mesh.vertex_count());
    return SoftPins(source, problem.constraints, problem.weights, how).settle();
}

/// Boundary vertices at their angles on the target's boundary, the others where the chart has them.
std::vector<MeshPoint> places_on(const Surface& source, const Surface& target, const CircleDomainChart& circles,
                                 const ExtremalMap& found) {
    const Eigen::VectorXcd map = found.map.head(source.mesh.vertex_count());
    std::vector<MeshPoint> places =
        locate_in_chart(target, circles.chart.vertices, std::vector<Complex>(map.begin(), map.end()));
    for (const LoopOnto& onto : found.loops) {
        const int loop = onto.curve == 0 ? circles.outer_loop() : circles.holes[onto.curve - 1].loop;
        const Complex centre = circles.circle(loop).centre;
        for (const int v : source.topology.boundary_loops[onto.loop])
            places[v] = mesh_point(target, boundary_place(target, circles, loop, std::arg(map[v] - centre)));
    }
    return places;
}

/// What the inverse problem has to meet: the nearest vertices of the target at the landmarks, and the loops' partners.
Constraints inverse_constraints(const Surface& target, std::span<const SurfaceLandmark> landmarks,
                                const OpenRegistration& found, const CircleDomainChart& of_source, int outer_loop,
                                Eigen::VectorXcd& images) {
    Constraints result(circle_target(of_source));
    Correspondence& how = result.correspondence;
    how.outer_loop = outer_loop;
    for (const LoopOnto& onto : found.map.loops) {
        int curve = 0;
        for (std::size_t h = 0; h < of_source.holes.size(); ++h)
            if (of_source.holes[h].loop == onto.loop) curve = static_cast<int>(h) + 1;
        how.loops.push_back({onto.curve == 0 ? outer_loop : found.target.holes[onto.curve - 1].loop, curve});
    }
    for (const SurfaceLandmark& landmark : landmarks) {
        const MeshPoint& place = found.places[landmark.vertex];
        const int v = nearest_vertex(place);
        if (vertex_at(place) >= 0) images[v] = of_source.chart.vertices[landmark.vertex];
        if (target.topology.on_boundary[v])
            how.marks.push_back(nearest_mark(*result.domain(), v, images[v]));
        else
            result.pin(v, images[v]);
    }
    return result;
}

/// k after a step from the map back, which takes every vertex of the target to its place in the source's circle domain.
/// @param back places of these vertices on the source
std::optional<double> k_of_inverse(const Surface& source, const Surface& target,
                                   std::span<const SurfaceLandmark> landmarks, const OpenRegistration& found,
                                   std::span<const MeshPoint> back, const OpenRegistrationOptions& options) {
    try {
        const CircleDomainChart of_source = circle_domain_chart(source, options.outer_loop);
        Eigen::VectorXcd images(target.mesh.vertex_count());
        for (std::size_t v = 0; v < back.size(); ++v)
            images[static_cast<Eigen::Index>(v)] = back[v].interpolate(of_source.chart.vertices);
        const Constraints constraints =
            inverse_constraints(target, landmarks, found, of_source, options.target_outer_loop, images);
        ExtremalOptions how;
        how.start = images;
        ExtremalSolver solver(target, constraints, how);
        return solver.update(constraints.prescribed.images, 1).k;
    } catch (const Error& error) {
        if (error.cause() == Cause::cancelled) throw;
        return {};  // a check that cannot be made is no fault of the map
    }
}

/// What is to be known about the map.
void examine(const Surface& source, const Surface& target, std::span<const SurfaceLandmark> landmarks,
             const OpenRegistrationOptions& options, OpenRegistration& result) {
    std::vector<MeshPoint> back;
    try {
        const SurfaceCorrespondence both(source, target, result.target, result.places);
        back = both.back(places_of_vertices(target.mesh));
    } catch (const Error& error) {
        if (error.cause() != Cause::bad_mesh) throw;  // faces are flipped, which is reported of the map
    }
    const Eigen::VectorXcd map = result.map.map.head(source.mesh.vertex_count());
    result.measure(source, target, distortion(source.operators, map).mu, back);
    measure_landmarks(target.mesh, landmarks, result);
    if (options.check_inverse && !back.empty())
        result.inverse_k = k_of_inverse(source, target, landmarks, result, back, options);
}

}  // namespace

OpenRegistration register_open(const Surface& source, const Surface& target, std::span<const SurfaceLandmark> landmarks,
                               const OpenRegistrationOptions& options) {
    require_genus_zero(source);
    require_genus_zero(target);
    const std::size_t loops = source.topology.boundary_loops.size(), others = target.topology.boundary_loops.size();
    if (loops != others)
        throw Error(Cause::bad_mesh,
                    "the source has " + std::to_string(loops) + " boundary loops, the target " + std::to_string(others),
                    "fill holes until they agree");
    require_landmarks(source, landmarks);
    OpenRegistration result;
    result.target = circle_domain_chart(target, options.target_outer_loop);
    const Problem problem = problem_of(source, target, landmarks, result.target, options.outer_loop);
    ExtremalOptions how = options.map;
    if (!options.start.empty()) how.start = wanted_start(source, options.start, result.target);
    if (!options.waypoints.empty()) {
        if (how.start)
            throw Error(Cause::bad_option, "waypoints are given, and a start", "ways choose the class: leave one out");
        result.map =
            map_along_ways(source, problem, stops_in(result.target, problem, options.waypoints, landmarks), how);
    } else {
        result.map = problem.soft ? SoftPins(source, problem.constraints, problem.weights, how).settle()
                                  : extremal_map(source, problem.constraints, how);
    }
    result.map.factorizations += result.target.factorizations;
    result.places = places_on(source, target, result.target, result.map);
    std::vector<SurfaceLandmark> met;  // exactly; others on the boundary went to where that is nearest
    for (std::size_t i = 0; i < landmarks.size(); ++i)
        if (const int vertex = vertex_at(landmarks[i].place);
            problem.pinned[i] >= 0 || (vertex >= 0 && target.topology.on_boundary[vertex]))
            met.push_back(landmarks[i]);
    meet_landmarks(met, result);
    examine(source, target, landmarks, options, result);
    if (!problem.far.empty())
        result.warnings.push_back(
            {WarningKind::marks,
             std::to_string(problem.far.size()) +
                 " landmarks on the boundary have places far from the target's, the first is vertex " +
                 std::to_string(problem.far[0]) + ": they go to the nearest points of it",
             {Things::vertices, problem.far}});
    append(result.warnings, result.target.chart.warnings);
    append(result.warnings, result.map.warnings);
    return result;
}

}  // namespace beltrami
