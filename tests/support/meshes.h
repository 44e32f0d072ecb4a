#pragma once

// Small meshes and boundary values that several tests use.

#include <cmath>
#include <functional>
#include <numbers>

#include <beltrami/constraints/boundary_condition.h>
#include <beltrami/generate/grids.h>
#include <beltrami/generate/round_domains.h>
#include <beltrami/mesh/mesh.h>
#include <beltrami/mesh/subdivide.h>

namespace beltrami::test {

inline Eigen::VectorXcd complex_positions(const Mesh& mesh) {
    Eigen::VectorXcd z(mesh.vertex_count());
    for (int v = 0; v < mesh.vertex_count(); ++v) z[v] = {mesh.positions(v, 0), mesh.positions(v, 1)};
    return z;
}

/// The mesh with its vertices moved by a function of x + iy.
template <class Map>
Mesh moved(Mesh mesh, const Map& map) {
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        const Complex w = map(Complex(mesh.positions(v, 0), mesh.positions(v, 1)));
        mesh.positions.row(v) << w.real(), w.imag();
    }
    return mesh;
}

/// Largest distance after the best similarity (orientation kept), relative to the size of the target.
inline double distance_up_to_similarity(const Eigen::VectorXcd& map, const Eigen::VectorXcd& target) {
    const Eigen::VectorXcd a = map.array() - map.mean(), b = target.array() - target.mean();
    const Complex factor = a.dot(b) / a.squaredNorm();
    return (factor * a - b).cwiseAbs().maxCoeff() / (2 * b.cwiseAbs().maxCoeff());
}

/// By inverse stereographic projection, which is conformal.
inline Mesh on_sphere(const Mesh& mesh) {
    Mesh result = mesh;
    result.positions.resize(mesh.vertex_count(), 3);
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        const double x = mesh.positions(v, 0), y = mesh.positions(v, 1), n = x * x + y * y;
        result.positions.row(v) << 2 * x / (1 + n), 2 * y / (1 + n), (n - 1) / (1 + n);
    }
    return result;
}

/// The unit square in n×n cells; a cell becomes one quad or two triangles, as the function of its column and row says.
/// Inner vertices are moved by up to `amount` of a cell, deterministically.
inline Mesh square(int n, double amount, const std::function<bool(int, int)>& as_quad) {
    Mesh mesh;
    mesh.positions.resize((n + 1) * (n + 1), 2);
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) {
            const bool inner = i > 0 && i < n && j > 0 && j < n;
            const double dx = inner ? amount * std::sin(12.9898 * i + 78.233 * j) : 0,
                         dy = inner ? amount * std::cos(39.425 * i - 17.31 * j) : 0;
            mesh.positions.row(j * (n + 1) + i) << (i + dx) / n, (j + dy) / n;
        }
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const int a = j * (n + 1) + i, b = a + 1, c = b + n + 1, d = a + n + 1;
            if (as_quad(i, j)) {
                mesh.faces.add({a, b, c, d});
            } else {
                mesh.faces.add({a, b, c});
                mesh.faces.add({a, c, d});
            }
        }
    return mesh;
}

inline Mesh jittered_square(int n) {
    return square(n, 0.25, [](int, int) { return false; });
}
inline Mesh quad_square(int n, double amount) {
    return square(n, amount, [](int, int) { return true; });
}
inline Mesh mixed_square(int n) {
    return square(n, 0.2, [](int i, int j) { return (i + j) % 2 == 0; });
}

/// The unit disk in quads: every triangle of concentric rings is cut into three.
inline Mesh quad_disk(int rings) {
    const Mesh triangles = disk(rings);
    const SubdividedMesh fine = midpoint_subdivide(triangles);
    const int corners = triangles.vertex_count(), middles = fine.mesh.vertex_count();
    Mesh mesh;
    mesh.positions.resize(middles + triangles.face_count(), 2);
    mesh.positions.topRows(middles) = fine.mesh.positions;
    for (int v = corners; v < middles; ++v) {
        const auto& parents = fine.parents[v - corners];
        if (triangles.positions.row(parents[0]).norm() > 1 - 1e-9 &&
            triangles.positions.row(parents[1]).norm() > 1 - 1e-9)
            mesh.positions.row(v).normalize();
    }
    // Of the four triangles in place of one, each names one old corner and two middles.
    for (int f = 0; f < triangles.face_count(); ++f) {
        const int centre = middles + f;
        mesh.positions.row(centre).setZero();
        for (const int v : triangles.faces[f]) mesh.positions.row(centre) += triangles.positions.row(v) / 3;
        for (int part = 4 * f; part < 4 * f + 4; ++part) {
            const auto v = fine.mesh.faces[part];
            for (int j = 0; j < 3; ++j)
                if (v[j] < corners) mesh.faces.add({v[j], v[(j + 1) % 3], centre, v[(j + 2) % 3]});
        }
    }
    return mesh;
}

/// A bump over the unit disk of about so many triangles.
inline Mesh bump(int triangles, double height = 0.5) {
    Mesh mesh = disk(disk_rings_for_triangles(triangles));
    const Positions flat = mesh.positions;
    mesh.positions.resize(flat.rows(), 3);
    for (Eigen::Index v = 0; v < flat.rows(); ++v) {
        const double x = flat(v, 0), y = flat(v, 1);
        mesh.positions.row(v) << x, y, height * std::exp(-4 * ((x - 0.2) * (x - 0.2) + y * y));
    }
    return mesh;
}

/// Boundary values given as a function of the vertex' position in the plane.
inline BoundaryCondition boundary_values(const Surface& surface, const std::function<Complex(Complex)>& f) {
    BoundaryCondition boundary;
    for (const auto& loop : surface.topology.boundary_loops)
        for (const int v : loop) boundary.pin(v, f({surface.mesh.positions(v, 0), surface.mesh.positions(v, 1)}));
    return boundary;
}

/// exp(0.6(g + ½ ḡ)), g = z + 0.3 z²: a Teichmüller map with k = ½, φ = g′².
inline Complex exact_composition(Complex z) {
    const Complex g = z + 0.3 * z * z;
    return std::exp(0.6 * (g + 0.5 * std::conj(g)));
}

/// The disk's boundary sent around three lobes.
inline Complex three_lobes(Complex z) {
    const double t = std::arg(z);
    return std::polar(1 + 0.45 * std::cos(3 * t), t + 0.4 * std::sin(t) + 0.1 * std::sin(3 * t));
}

}  // namespace beltrami::test
