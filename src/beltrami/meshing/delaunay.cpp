#include <beltrami/meshing/delaunay.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>

#include <beltrami/base/error.h>
#include <beltrami/meshing/refinement.h>
#include <beltrami/meshing/triangulation.h>

namespace beltrami {
namespace {

/// Position of a cell of a 2^16 × 2^16 grid along the Hilbert curve: near numbers are near places.
std::uint32_t hilbert_index(std::uint32_t x, std::uint32_t y) {
    std::uint32_t index = 0;
    for (std::uint32_t s = 1u << 15; s > 0; s >>= 1) {
        const std::uint32_t right = (x & s) ? 1 : 0, up = (y & s) ? 1 : 0;
        index += s * s * ((3 * right) ^ up);
        if (!up) {
            if (right) {
                x = 0xFFFF - x;
                y = 0xFFFF - y;
            }
            std::swap(x, y);
        }
    }
    return index;
}

void validate(const PlanarDomain& domain) {
    const int n = static_cast<int>(domain.points.size());
    for (int i = 0; i < n; ++i) {
        if (!domain.points[i].allFinite()) {
            throw Error(Cause::bad_option, "point " + std::to_string(i) + " of the domain is not finite", "",
                        {Things::points, {i}});
        }
    }
    if (domain.segments.size() < 3 || domain.curves.size() != domain.segments.size()) {
        throw Error(Cause::bad_option, "the domain has fewer than 3 boundary segments, or not one curve number each");
    }
    for (std::size_t i = 0; i < domain.segments.size(); ++i) {
        const auto& [a, b] = domain.segments[i];
        if (a < 0 || b < 0 || a >= n || b >= n || a == b || domain.curves[i] < 0) {
            throw Error(Cause::bad_option,
                        "segment " + std::to_string(i) + " of the domain has impossible ends or curve", "",
                        {Things::points, {static_cast<int>(i)}});
        }
    }
}

/// Inserts the points in an order that keeps neighbours together.
/// @return vertex of each point
std::vector<int> insert_points(Triangulation& triangulation, const std::vector<Eigen::Vector2d>& points,
                               const Eigen::AlignedBox2d& box) {
    const double scale = 65535.0 / std::max(box.sizes().maxCoeff(), 1e-300);
    std::vector<std::pair<std::uint32_t, int>> order(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Eigen::Vector2d q = scale * (points[i] - box.min());
        order[i] = {hilbert_index(static_cast<std::uint32_t>(q.x()), static_cast<std::uint32_t>(q.y())),
                    static_cast<int>(i)};
    }
    std::sort(order.begin(), order.end());
    std::vector<int> vertex_of(points.size());
    std::vector<int> point_of(Triangulation::corner_count, -1);
    int hint = 0;
    for (const auto& [key, i] : order) {
        const int vertex = triangulation.insert(points[i], triangulation.locate(points[i], hint));
        if (vertex < static_cast<int>(point_of.size())) {
            const int first = vertex < 0 ? -1 : std::min(point_of[vertex], i),
                      second = vertex < 0 ? i : std::max(point_of[vertex], i);
            throw Error(
                Cause::bad_option,
                "points " + std::to_string(first) + " and " + std::to_string(second) + " of the domain coincide",
                "give every point once", {Things::points, {first, second}});
        }
        point_of.push_back(i);
        vertex_of[i] = vertex;
        hint = triangulation.triangle_of(vertex);
    }
    return vertex_of;
}

/// For each curve the vertices where it ends; {-1, -1} for a closed one.
std::vector<std::array<int, 2>> curve_ends(const PlanarDomain& domain, const std::vector<int>& vertex_of) {
    const int count = *std::max_element(domain.curves.begin(), domain.curves.end()) + 1;
    std::vector<std::pair<int, int>> uses;  // (curve, vertex)
    for (std::size_t i = 0; i < domain.segments.size(); ++i) {
        for (const int point : domain.segments[i]) uses.emplace_back(domain.curves[i], vertex_of[point]);
    }
    std::sort(uses.begin(), uses.end());
    std::vector<std::array<int, 2>> ends(count, {-1, -1});
    for (std::size_t i = 0; i < uses.size();) {
        const std::size_t same = std::count(uses.begin() + i, uses.begin() + std::min(i + 3, uses.size()), uses[i]);
        if (same == 1) (ends[uses[i].first][0] < 0 ? ends[uses[i].first][0] : ends[uses[i].first][1]) = uses[i].second;
        i += same;
    }
    return ends;
}

/// The inside triangles as a mesh: the points in their order, then the other vertices.
Mesh extract(const Triangulation& triangulation, const std::vector<int>& vertex_of) {
    const int total = static_cast<int>(triangulation.points().size());
    std::vector<char> used(total, 0);
    int faces = 0;
    for (const Triangulation::Triangle& triangle : triangulation.triangles()) {
        if (!triangle.inside) continue;
        ++faces;
        for (const int v : triangle.vertices) used[v] = 1;
    }
    std::vector<int> index(total, -1);
    std::vector<int> order = vertex_of;
    for (std::size_t i = 0; i < vertex_of.size(); ++i) {
        if (!used[vertex_of[i]]) {
            throw Error(Cause::bad_option, "point " + std::to_string(i) + " lies outside the domain",
                        "check that the boundary is closed and the point inside",
                        {Things::points, {static_cast<int>(i)}});
        }
        index[vertex_of[i]] = static_cast<int>(i);
    }
    for (int v = 0; v < total; ++v) {
        if (!used[v] || index[v] >= 0) continue;
        index[v] = static_cast<int>(order.size());
        order.push_back(v);
    }
    Mesh mesh;
    mesh.positions.resize(static_cast<Eigen::Index>(order.size()), 2);
    for (std::size_t i = 0; i < order.size(); ++i)
        mesh.positions.row(static_cast<Eigen::Index>(i)) = triangulation.point(order[i]).transpose();
    mesh.faces.reserve(faces, 3 * faces);
    for (const Triangulation::Triangle& triangle : triangulation.triangles()) {
        if (!triangle.inside) continue;
        mesh.faces.add({index[triangle.vertices[0]], index[triangle.vertices[1]], index[triangle.vertices[2]]});
    }
    return mesh;
}

}  // namespace

void TriangulateOptions::validate() const {
    if (!(min_angle >= 0.0 && min_angle <= std::numbers::pi / 6.0)) {
        throw Error(Cause::bad_option, "min_angle is " + std::to_string(min_angle) + " radians",
                    "give an angle from 0 to 30 degrees (0.5235 radians)");
    }
    if (smoothing_passes < 0 || max_vertices < 3) {
        throw Error(Cause::bad_option, "smoothing_passes or max_vertices is impossibly small");
    }
}

Mesh triangulate(const PlanarDomain& domain, const TriangulateOptions& options) {
    options.validate();
    validate(domain);
    Eigen::AlignedBox2d box;
    for (const Eigen::Vector2d& p : domain.points) box.extend(p);
    Triangulation triangulation(box.min(), box.max());
    const std::vector<int> vertex_of = insert_points(triangulation, domain.points, box);
    for (std::size_t i = 0; i < domain.segments.size(); ++i) {
        triangulation.constrain(vertex_of[domain.segments[i][0]], vertex_of[domain.segments[i][1]], domain.curves[i]);
    }
    triangulation.restore_delaunay();
    triangulation.mark_inside();
    Refinement refinement(triangulation, domain, options, curve_ends(domain, vertex_of));
    if (options.size || options.min_angle > 0.0) refinement.refine();
    refinement.smooth();
    if (options.split_ears) refinement.split_ears();
    return extract(triangulation, vertex_of);
}

std::vector<double> spread(double length, const std::function<double(double)>& size, int least) {
    // The number of edges up to a parameter is the integral of 1 / size; invert it at equal steps.
    constexpr int samples = 2048;
    std::vector<double> count(samples + 1, 0.0);
    for (int i = 0; i < samples; ++i) count[i + 1] = count[i] + length / samples / size((i + 0.5) / samples);
    if (!(count[samples] >= 0.0 && count[samples] < 1e8)) {
        throw Error(Cause::bad_option,
                    "the size field asks for " + std::to_string(count[samples]) + " edges along one curve",
                    "give positive edge lengths that suit the size of the domain");
    }
    const int n = std::max(std::max(least, 1), static_cast<int>(std::lround(count[samples])));
    std::vector<double> parameters{0.0};
    for (int k = 1, i = 0; k < n; ++k) {
        const double target = count[samples] * k / n;
        while (count[i + 1] < target) ++i;
        parameters.push_back((i + (target - count[i]) / (count[i + 1] - count[i])) / samples);
    }
    parameters.push_back(1.0);
    return parameters;
}

}  // namespace beltrami
