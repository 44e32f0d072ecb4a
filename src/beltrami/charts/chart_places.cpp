#include <beltrami/charts/chart_places.h>

#include <algorithm>
#include <cmath>
#include <string>

#include <beltrami/base/constants.h>
#include <beltrami/base/error.h>
#include <beltrami/base/parallel.h>

namespace beltrami {

namespace {

/// In [0, 2π).
double wrapped(double angle) {
    const double rest = std::fmod(angle, kTurn), positive = rest < 0 ? rest + kTurn : rest;
    return positive < kTurn ? positive : 0.0;
}

}  // namespace

std::vector<MeshPoint> locate_in_chart(const Surface& surface, const Eigen::VectorXcd& chart,
                                       std::span<const Complex> points, double tolerance) {
    Mesh drawn;
    drawn.faces = surface.mesh.faces;
    drawn.positions = Positions::Zero(chart.size(), 2);
    for (const int v : drawn.faces.vertices()) drawn.positions.row(v) << chart[v].real(), chart[v].imag();
    const PlanarLocator locator(drawn);
    std::vector<MeshPoint> places(points.size());
    std::vector<char> outside(points.size(), 0);
    parallel_for(
        0, static_cast<int>(points.size()),
        [&](int first, int last) {
            for (int i = first; i < last; ++i) {
                places[i] = locator.nearest(points[i]);
                const double distance = std::abs(places[i].interpolate(chart) - points[i]);
                outside[i] = !(distance <= tolerance * locator.diameter());
            }
        },
        256);
    std::vector<int> far;
    for (int i = 0; i < static_cast<int>(points.size()); ++i)
        if (outside[i]) far.push_back(i);
    if (!far.empty())
        throw Error(
            Cause::bad_boundary,
            std::to_string(far.size()) + " points lie outside the chart, the first is point " + std::to_string(far[0]),
            "only points of the circle domain have a place on the surface", {Things::points, far});
    return places;
}

Positions positions_on(const Mesh& mesh, std::span<const MeshPoint> places) {
    Positions result(static_cast<Eigen::Index>(places.size()), mesh.positions.cols());
    for (std::size_t i = 0; i < places.size(); ++i) {
        result.row(static_cast<Eigen::Index>(i)).setZero();
        for (int j = 0; j < 3; ++j)
            result.row(static_cast<Eigen::Index>(i)) +=
                places[i].barycentric[j] * mesh.positions.row(places[i].vertices[j]);
    }
    return result;
}

BoundaryPlace boundary_place(const Surface& surface, const CircleDomainChart& chart, int loop, double angle) {
    const std::vector<int>& vertices = surface.topology.boundary_loops[loop];
    const Complex centre = chart.circle(loop).centre;
    // Faces are on the left: holes are run around clockwise.
    const double direction = loop == chart.outer_loop() ? 1 : -1;
    const int n = static_cast<int>(vertices.size());
    const auto arm = [&](int i) { return chart.chart.vertices[vertices[i % n]] - centre; };
    const double wanted = wrapped(direction * (angle - std::arg(arm(0))));
    double passed = 0;
    for (int i = 0; i < n; ++i) {
        const double increment = direction * std::arg(arm(i + 1) * std::conj(arm(i)));
        if (wanted < passed + increment || i + 1 == n) {
            const double fraction = increment > 0 ? (wanted - passed) / increment : 0.0;
            if (fraction < 1) return {loop, i, std::max(0.0, fraction)};
            return {loop, (i + 1) % n, 0};
        }
        passed += increment;
    }
    return {loop, 0, 0};
}

MeshPoint mesh_point(const Surface& surface, const BoundaryPlace& place) {
    const Topology& topology = surface.topology;
    const std::vector<int>& loop = topology.boundary_loops[place.loop];
    const int a = loop[place.edge], b = loop[(place.edge + 1) % loop.size()];
    const auto edge = std::lower_bound(topology.edges.begin(), topology.edges.end(),
                                       std::array<int, 2>{std::min(a, b), std::max(a, b)});
    const auto& sides = topology.edge_faces[edge - topology.edges.begin()];
    MeshPoint point;
    point.face = std::max(sides[0], sides[1]);
    int third = a;
    for (const int v : surface.mesh.faces[point.face])
        if (v != a && v != b) third = v;
    point.vertices = {a, b, third};
    point.barycentric = {1 - place.fraction, place.fraction, 0};
    return point;
}

}  // namespace beltrami
