#include <beltrami/applications/held_maps.h>

#include <algorithm>
#include <utility>

#include <beltrami/base/error.h>
#include <beltrami/baselines/baseline.h>
#include <beltrami/charts/shape.h>
#include <beltrami/mesh/planar.h>
#include <beltrami/targets/mesh_target.h>
#include <beltrami/teichmuller/extremal_between.h>

namespace beltrami {

namespace {

constexpr double kUniformTolerance = 1e-3;

/// Why a surface with such vertices held is none of those above.
std::string refusal_of(const Surface& source, const std::vector<int>& held) {
    const Topology& topology = source.topology;
    if (topology.components != 1) return "the surface has " + std::to_string(topology.components) + " components";
    if (topology.boundary_loops.empty()) return "the surface is closed";
    if (topology.genus > 0) return "the surface has genus " + std::to_string(topology.genus);
    for (int f = 0; f < source.mesh.face_count(); ++f)
        if (source.mesh.faces.degree(f) > 4) return "faces have more than four corners";
    const std::vector<int> sorted = [&] {
        std::vector<int> result = held;
        std::sort(result.begin(), result.end());
        return result;
    }();
    for (const auto& loop : topology.boundary_loops)
        for (const int v : loop)
            if (!std::binary_search(sorted.begin(), sorted.end(), v))
                return "vertex " + std::to_string(v) + " of the boundary has no place";
    return {};
}

}  // namespace

/// Where the image lies as a domain of the plane.
struct HeldMaps::Plane {
    std::unique_ptr<const Surface> surface;  // null where the image is the plane's itself
    Eigen::VectorXcd vertices;               // #V the image's own
    BoundaryCondition boundary;
    int factorizations = 0;
    Warnings warnings;
};

struct HeldMaps::Last {
    std::vector<MeshPoint> places;  // of a map onto a mesh in space
    Eigen::VectorXcd map;           // of one in the plane
};

HeldMaps::HeldMaps(const Surface& source, std::vector<int> held)
    : source_(source),
      held_(std::move(held)),
      refusal_(refusal_of(source, held_)),
      shape_(std::make_unique<Shape>(source)),
      last_(std::make_unique<Last>()) {}

HeldMaps::~HeldMaps() = default;

HeldMaps::Plane HeldMaps::plane_of(const Mesh& image) const {
    Plane plane;
    std::vector<char> pinned(static_cast<std::size_t>(image.vertex_count()), 0);
    if (is_planar(image)) {
        plane.vertices = planar_coordinates(image);
    } else {
        plane.surface = std::make_unique<const Surface>(image);
        std::vector<std::array<int, 2>> pairs;
        for (const auto& loop : source_.topology.boundary_loops)
            for (const int v : loop) pairs.push_back({v, v});
        PrescribedTarget target = prescribed_target(source_, *plane.surface, pairs);
        plane.vertices = target.circles.chart.vertices;
        plane.boundary = std::move(target.boundary);
        plane.factorizations = target.circles.factorizations;
        plane.warnings = target.circles.chart.warnings;
        for (const int v : plane.boundary.vertices) pinned[v] = 1;
    }
    for (const int v : held_)
        if (!pinned[v]) plane.boundary.pin(v, plane.vertices[v]);
    return plane;
}

/// Positions of the source's vertices; further ones of the map, as of split edges, do not count.
Positions HeldMaps::positions_of(const Mesh& image, const Plane& plane, const Eigen::VectorXcd& map) {
    const int n = source_.mesh.vertex_count();
    Positions positions(n, 3);
    if (!plane.surface) {
        last_->map = map.head(n);
        const double side = seen_from_below(image) ? -1 : 1, height = image.point(0).z();
        for (int v = 0; v < n; ++v) positions.row(v) << map[v].real(), side * map[v].imag(), height;
    } else {
        const std::vector<Complex> points(map.begin(), map.begin() + n);
        last_->places = locate_in_chart(*plane.surface, plane.vertices, points);
        const MeshTarget target(image);
        for (const int v : held_) last_->places[v] = target.at_vertex(v).place;
        positions = positions_on(image, last_->places);
    }
    for (const int v : held_) positions.row(v) = image.point(v);
    return positions;
}

HeldMap HeldMaps::extremal(const Mesh& image, const Progress& progress) {
    const Plane plane = plane_of(image);
    ExtremalOptions options;
    options.progress = progress;
    options.shapes = {shape_.get()};
    if (!plane.surface && last_->map.size() > 0) options.start = last_->map;
    if (plane.surface && !last_->places.empty()) {
        Eigen::VectorXcd start = Eigen::VectorXcd::Zero(image.vertex_count());
        for (int v = 0; v < image.vertex_count(); ++v)
            for (int i = 0; i < 3; ++i)
                start[v] += last_->places[v].barycentric[i] * plane.vertices[last_->places[v].vertices[i]];
        options.start = std::move(start);
    }
    HeldMap result;
    result.extremal = extremal_map(source_, Constraints(plane.boundary), options);
    if (plane.surface) {  // conformal up to the error of the mesh
        for (Bound& bound : result.extremal->bounds) bound.rigorous = false;
        result.extremal->K_lower_proved = 1;
    }
    result.positions = positions_of(image, plane, result.extremal->map);
    result.steps = result.extremal->iterations;
    result.settled = result.extremal->termination == Termination::converged;
    result.factorizations = result.extremal->factorizations + plane.factorizations;
    result.warnings = plane.warnings;
    append(result.warnings, result.extremal->warnings);
    return result;
}

HeldMap HeldMaps::uniform(const Mesh& image, int max_iterations, const Progress& progress) {
    const Plane plane = plane_of(image);
    BaselineOptions options;
    options.max_iterations = max_iterations;
    options.tolerance = kUniformTolerance;
    options.progress = progress;
    const BaselineMap map = qc_iteration_baseline(source_, plane.boundary, options);
    HeldMap result;
    result.positions = positions_of(image, plane, map.map);
    result.steps = map.iterations;
    result.settled = map.converged;
    result.factorizations = map.factorizations + plane.factorizations;
    result.warnings = plane.warnings;
    return result;
}

}  // namespace beltrami
