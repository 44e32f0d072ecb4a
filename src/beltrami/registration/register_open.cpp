#include <beltrami/registration/register_open.h>

#include <algorithm>
#include <cmath>
#include <string>

#include <beltrami/base/error.h>
#include <beltrami/charts/chart_places.h>
#include <beltrami/registration/soft_pins.h>
#include <beltrami/starts/target_model.h>

namespace beltrami {

namespace {

/// The problem on the target's circle domain.
struct Problem {
    Constraints constraints;
    std::vector<double> weights;  ///< of the pins
    bool soft = false;
};

Positions plane_positions(const Eigen::VectorXcd& plane) {
    Positions positions(plane.size(), 2);
    positions << plane.real(), plane.imag();
    return positions;
}

Problem problem_of(const Surface& source, const Surface& target, std::span<const SurfaceLandmark> landmarks,
                   const CircleDomainChart& circles, int outer_loop) {
    Problem problem{Constraints(circle_target(circles)), {}, false};
    problem.constraints.correspondence.outer_loop = outer_loop;
    const Positions chart = plane_positions(circles.chart.vertices);
    for (const SurfaceLandmark& landmark : landmarks) {
        const int v = landmark.vertex;
        if (v < 0 || v >= source.mesh.vertex_count())
            throw Error(Cause::bad_boundary, "landmark " + std::to_string(v) + " is no vertex of the surface",
                        "name a vertex of a face", {Things::vertices, {v}});
        const Complex image = landmark.place.interpolate(circles.chart.vertices);
        const bool soft = std::isfinite(landmark.weight);
        if (source.topology.on_boundary[v]) {
            if (soft)
                throw Error(Cause::bad_option, "landmark " + std::to_string(v) + " is soft and on the boundary",
                            "boundaries slide: leave it out, or prescribe it without a weight",
                            {Things::vertices, {v}});
            problem.constraints.correspondence.marks.push_back(nearest_mark(*problem.constraints.domain(), v, image));
            continue;
        }
        problem.constraints.pin(v, image);
        problem.weights.push_back(landmark.weight * squared_scale(target, chart, landmark.place));
        problem.soft = problem.soft || soft;
    }
    return problem;
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
    OpenRegistration result;
    result.target = circle_domain_chart(target, options.target_outer_loop);
    const Problem problem = problem_of(source, target, landmarks, result.target, options.outer_loop);
    result.map = problem.soft ? SoftPins(source, problem.constraints, problem.weights, options.map).settle()
                              : extremal_map(source, problem.constraints, options.map);
    result.map.factorizations += result.target.factorizations;
    const Eigen::VectorXcd map = result.map.map.head(source.mesh.vertex_count());
    result.places = locate_in_chart(target, result.target.chart.vertices, std::vector<Complex>(map.begin(), map.end()));
    meet_landmarks(landmarks, result);
    result.measure(source, target, distortion(source.operators, map).mu);
    measure_landmarks(target.mesh, landmarks, result);
    result.warnings = result.target.chart.warnings;
    append(result.warnings, result.map.warnings);
    return result;
}

}  // namespace beltrami
