#include <beltrami/teichmuller/sharpened_bound.h>

#include <algorithm>
#include <cmath>

#include <beltrami/mesh/quad_split.h>
#include <beltrami/mesh/subdivide.h>

namespace beltrami {

namespace {

/// k of the f-step stays below this.
constexpr double kLargest = 0.9999;
/// A second f-step where the estimate of K differs by more than this part from that of the first k.
constexpr double kOtherK = 2e-3;
constexpr int kMostSteps = 3;

/// A mesh with its metric and everything that the bound needs of the problem on it.
struct Level {
    Surface surface;
    BoundaryCondition boundary;
    Eigen::VectorXcd chart;  ///< positions of the vertices
};

bool all_triangles(const Mesh& mesh) {
    for (int f = 0; f < mesh.face_count(); ++f)
        if (mesh.faces.degree(f) != 3) return false;
    return true;
}

Surface made(Mesh mesh, std::optional<Positions> metric) {
    return metric ? Surface(std::move(mesh), std::move(*metric)) : Surface(std::move(mesh));
}

Surface cut_into_triangles(const Surface& source) {
    const Mesh& mesh = source.mesh;
    Mesh result;
    result.positions = mesh.positions;
    std::vector<int> corners;  // old corner of every new one
    for (int f = 0; f < mesh.face_count(); ++f) {
        const auto v = mesh.faces[f];
        const int first = mesh.faces.first_corner(f);
        if (v.size() == 3) {
            result.faces.add(v);
            for (int j = 0; j < 3; ++j) corners.push_back(first + j);
            continue;
        }
        for (const auto& [a, b, c] :
             split_quad({mesh.point(v[0]), mesh.point(v[1]), mesh.point(v[2]), mesh.point(v[3])})) {
            result.faces.add({v[a], v[b], v[c]});
            for (const int j : {a, b, c}) corners.push_back(first + j);
        }
    }
    std::optional<Positions> metric;
    if (source.metric) metric = (*source.metric)(corners, Eigen::all);
    return made(std::move(result), std::move(metric));
}

Level subdivided(const Level& old) {
    SubdividedMesh fine = midpoint_subdivide(old.surface.mesh);
    const int vertices = old.surface.mesh.vertex_count();
    std::optional<Positions> metric;
    if (old.surface.metric) {
        const Positions& corners = *old.surface.metric;
        metric.emplace(4 * corners.rows(), corners.cols());
        for (int f = 0; f < old.surface.mesh.face_count(); ++f) {
            const int first = old.surface.mesh.faces.first_corner(f);
            const Positions v = corners.middleRows(first, 3);
            Positions m(3, corners.cols());
            for (int j = 0; j < 3; ++j) m.row(j) = 0.5 * (v.row(j) + v.row((j + 1) % 3));
            for (int j = 0; j < 3; ++j) {
                metric->row(4 * first + 3 * j) = v.row(j);
                metric->row(4 * first + 3 * j + 1) = m.row(j);
                metric->row(4 * first + 3 * j + 2) = m.row((j + 2) % 3);
            }
            metric->middleRows(4 * first + 9, 3) = m;
        }
    }
    const Topology& topology = old.surface.topology;
    Eigen::VectorXcd values = prescribed_values(old.boundary, old.surface);
    BoundaryCondition boundary = old.boundary;
    Eigen::VectorXcd chart(vertices + static_cast<Eigen::Index>(fine.parents.size()));
    chart.head(vertices) = old.chart;
    for (int e = 0; e < topology.edge_count(); ++e) {
        const auto& [a, b] = topology.edges[e];
        chart[vertices + e] = 0.5 * (old.chart[a] + old.chart[b]);
        if (topology.edge_faces[e][0] < 0 || topology.edge_faces[e][1] < 0)
            boundary.pin(vertices + e, 0.5 * (values[a] + values[b]));
    }
    return {made(std::move(fine.mesh), std::move(metric)), std::move(boundary), std::move(chart)};
}

}  // namespace

SharpenedBound sharpened_bound(const Surface& source, const BoundaryCondition& boundary, const Chart& chart,
                               const DifferentialSpace& space, const Eigen::VectorXcd& coefficients, double k,
                               const SharpenedBoundOptions& options) {
    SharpenedBound result;
    std::optional<Level> level;
    if (!all_triangles(source.mesh)) level = Level{cut_into_triangles(source), boundary, chart.vertices};
    for (int i = 0; i < options.subdivisions; ++i) {
        const int faces = (level ? level->surface : source).mesh.face_count();
        if (faces > options.most_triangles / 4) break;
        level = subdivided(level ? *level : Level{source, boundary, chart.vertices});
    }
    std::optional<Chart> finer;
    if (level) {
        finer = make_chart(level->surface, level->chart, chart.exact);
        finer->analytic = chart.analytic;
        if (chart.exact && chart.analytic) std::fill(finer->excluded.begin(), finer->excluded.end(), 0);
    }
    const Surface& surface = level ? level->surface : source;
    const Chart& own = finer ? *finer : chart;
    result.triangles = surface.mesh.face_count();
    QuadraticStep step(surface, level ? level->boundary : boundary, own, space, coefficients);
    for (int i = 0; i < kMostSteps; ++i) {
        QuadraticMap map = step.solve(k);
        if (!straighten(surface, map).empty()) break;
        const ReichStrebel integrals = reich_strebel_quadratic(surface, own, space, coefficients, map);
        if (!integrals.valid) break;
        result.integrals = integrals;
        result.map = std::move(map);
        const bool rigorous = integrals.resolved && proves(surface, own);
        if (integrals.lower > result.lower) result.lower = integrals.lower, result.rigorous = rigorous;
        const double last = (1 + k) / (1 - k);
        k = std::min((integrals.estimate - 1) / (integrals.estimate + 1), kLargest);
        if (std::abs(integrals.estimate - last) < kOtherK * last) break;
    }
    result.factorizations = step.factorizations();
    if (level) result.refined = std::move(level->surface);
    return result;
}

}  // namespace beltrami
