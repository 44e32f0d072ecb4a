#include <beltrami/charts/vertex_source.h>

#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

#include <beltrami/charts/chart.h>
#include <beltrami/linear/graph_laplacian.h>
#include <beltrami/plane/increasing.h>
#include <beltrami/uniformize/intrinsic_triangulation.h>

namespace beltrami {

namespace {

/// Of the mean step around it, what every step of the rim has at least: vertices that only touch the rim have no flux.
constexpr double kLeastOfNeighbours = 0.1;

/// The corners of the surface's triangles; quads are cut along their shorter diagonals, as the intrinsic triangulation
/// has no use for anything else.
std::vector<std::array<int, 3>> triangle_corners(const FaceList& faces,
                                                 const std::function<double(int, int)>& distance) {
    std::vector<std::array<int, 3>> result;
    result.reserve(static_cast<std::size_t>(faces.corner_count()));
    for (int f = 0; f < faces.size(); ++f) {
        const int c = faces.first_corner(f);
        if (faces.degree(f) == 3) {
            result.push_back({c, c + 1, c + 2});
        } else if (distance(c, c + 2) <= distance(c + 1, c + 3)) {
            result.push_back({c, c + 1, c + 2});
            result.push_back({c, c + 2, c + 3});
        } else {
            result.push_back({c, c + 1, c + 3});
            result.push_back({c + 1, c + 2, c + 3});
        }
    }
    return result;
}

/// The surface's triangles by their edge lengths, flipped until they are Delaunay.
IntrinsicTriangulation delaunay_of(const Surface& source) {
    const FaceList& faces = source.mesh.faces;
    const auto point = [&](int corner) -> Eigen::RowVectorXd {
        if (source.metric) return source.metric->row(corner);
        return source.mesh.positions.row(faces.vertices()[corner]);
    };
    const auto distance = [&](int a, int b) { return (point(a) - point(b)).stableNorm(); };
    // Both sides of an edge agree: the mean, where faces of a metric differ about it.
    std::vector<double> lengths(source.topology.edges.size(), -1);
    std::vector<int> edge_after(static_cast<std::size_t>(faces.corner_count()));  // the corner where an edge ends
    for (int f = 0; f < faces.size(); ++f)
        for (int first = faces.first_corner(f), i = 0; i < faces.degree(f); ++i) {
            const int c = first + i, next = first + (i + 1) % faces.degree(f);
            edge_after[c] = next;
            const double length = distance(c, next);
            double& known = lengths[source.topology.corner_edges[c]];
            known = known < 0 ? length : std::midpoint(known, length);
        }
    FaceList triangles;
    std::vector<double> logarithms;
    const auto corners = triangle_corners(faces, distance);
    triangles.reserve(static_cast<int>(corners.size()), static_cast<int>(3 * corners.size()));
    logarithms.reserve(3 * corners.size());
    for (const auto& t : corners) {
        triangles.add({faces.vertices()[t[0]], faces.vertices()[t[1]], faces.vertices()[t[2]]});
        for (std::size_t k = 0; k < 3; ++k) {
            const int c = t[k], next = t[(k + 1) % 3];
            logarithms.push_back(
                std::log(edge_after[c] == next ? lengths[source.topology.corner_edges[c]] : distance(c, next)));
        }
    }
    IntrinsicTriangulation triangulation(triangles, source.mesh.vertex_count(), std::move(logarithms));
    triangulation.make_delaunay();
    return triangulation;
}

/// The cotangent Laplacian with the rim held; every half-edge is an edge, with the weight of its triangle.
GraphLaplacian laplacian_of(const Surface& source, const IntrinsicTriangulation& triangulation) {
    std::vector<char> held(static_cast<std::size_t>(source.mesh.vertex_count()), 1);
    for (const int v : source.mesh.faces.vertices()) held[v] = source.topology.on_boundary[v];
    std::vector<std::array<int, 2>> edges;
    std::vector<double> weights;
    edges.reserve(static_cast<std::size_t>(triangulation.halfedge_count()));
    weights.reserve(edges.capacity());
    const Eigen::VectorXd as_it_is = Eigen::VectorXd::Zero(triangulation.vertex_count());
    for (int t = 0; t < triangulation.triangle_count(); ++t) {
        const TriangleAngles triangle = triangulation.angles(t, as_it_is);
        for (int k = 0; k < 3; ++k) {
            edges.push_back({triangulation.tail(3 * t + k), triangulation.head(3 * t + k)});
            weights.push_back(0.5 * triangle.cotangents[k]);
        }
    }
    GraphLaplacian laplacian(std::move(edges), held);
    laplacian.set(weights);
    laplacian.factorize();
    return laplacian;
}

}  // namespace

std::optional<Eigen::VectorXcd> disk_map_by_vertex_source(const Surface& source, int* factorizations) {
    const GraphLaplacian laplacian = laplacian_of(source, delaunay_of(source));
    if (laplacian.unknown_count() == 0) return {};
    ++*factorizations;
    Eigen::VectorXd load = vertex_areas(source.operators);
    Eigen::Index deepest = 0;
    laplacian.solve(load).col(0).maxCoeff(&deepest);
    load.setZero();
    load[deepest] = 1;
    const Eigen::VectorXd flux = laplacian.flux(laplacian.solve(load));

    const auto& rim = source.topology.boundary_loops[0];
    const std::size_t n = rim.size();
    std::vector<double> steps(n);
    for (std::size_t i = 0; i < n; ++i) steps[i] = 0.5 * (flux[rim[i]] + flux[rim[(i + 1) % n]]);
    if (!(std::accumulate(steps.begin(), steps.end(), 0.0) > 0)) return {};
    raise_to_neighbours(steps, kLeastOfNeighbours);
    const double total = std::accumulate(steps.begin(), steps.end(), 0.0);
    Eigen::VectorXcd g = Eigen::VectorXcd::Zero(load.size());
    double angle = 0;
    for (std::size_t i = 0; i < n; ++i) {
        g[rim[i]] = std::polar(1.0, angle);
        angle += 2 * std::numbers::pi * steps[i] / total;
    }
    return laplacian.extend(std::move(g));
}

}  // namespace beltrami
