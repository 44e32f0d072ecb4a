#pragma once

// Surfaces and landmarks that tests of registrations use.

#include <array>
#include <cmath>
#include <vector>

#include <beltrami/generate/grids.h>
#include <beltrami/generate/sphere.h>
#include <beltrami/registration/surface_landmarks.h>

namespace beltrami::test {

/// A ball with waves; those of other phases have other conformal maps.
inline Mesh bumpy_ball(int levels, double phase) {
    Mesh mesh = icosahedral_sphere(levels);
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        const Eigen::Vector3d p = mesh.point(v);
        mesh.positions.row(v) *= 1 + 0.2 * std::sin(3 * p.x() + phase) + 0.1 * p.y();
    }
    return mesh;
}

/// A square sheet of n×n cells, raised; the same with its vertices moved along it.
inline Mesh raised_sheet(int n, double moved) {
    Mesh mesh = rectangle(2, 2, n, n);
    Positions positions(mesh.vertex_count(), 3);
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        const double x = mesh.positions(v, 0), y = mesh.positions(v, 1);
        const double u = x + moved * x * (2 - x) * std::sin(2 * y);
        positions.row(v) << u, y, 0.3 * std::sin(u) * y;
    }
    mesh.positions = positions;
    return mesh;
}

/// Vertices of the source and of the target.
inline std::vector<SurfaceLandmark> landmarks_between(const Mesh& target,
                                                      const std::vector<std::array<int, 2>>& pairs) {
    std::vector<SurfaceLandmark> landmarks;
    for (const auto& [a, b] : pairs) landmarks.push_back({a, place_of_vertex(target, b)});
    return landmarks;
}

}  // namespace beltrami::test
