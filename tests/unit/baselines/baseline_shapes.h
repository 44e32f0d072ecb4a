#pragma once

#include <cmath>
#include <complex>
#include <functional>
#include <numbers>
#include <vector>

#include <beltrami/constraints/boundary_condition.h>
#include <beltrami/mesh/mesh.h>

namespace beltrami::baseline_tests {

/// A ringed_disk of rings: 1 + 3·rings·(rings + 1) vertices, 6·rings² triangles, the boundary last and
/// counter-clockwise.
inline Mesh ringed_disk(
    int rings, const std::function<Complex(Complex)>& place = [](Complex z) { return z; }) {
    Mesh mesh;
    mesh.positions.resize(1 + 3 * rings * (rings + 1), 2);
    const auto index = [](int ring, int k) { return ring == 0 ? 0 : 1 + 3 * ring * (ring - 1) + k % (6 * ring); };
    const auto put = [&](int v, Complex z) {
        const Complex p = place(z);
        mesh.positions.row(v) << p.real(), p.imag();
    };
    put(0, 0);
    for (int ring = 1; ring <= rings; ++ring)
        for (int k = 0; k < 6 * ring; ++k)
            put(index(ring, k), std::polar(static_cast<double>(ring) / rings, k * std::numbers::pi / (3 * ring)));
    for (int ring = 1; ring <= rings; ++ring)
        for (int sector = 0; sector < 6; ++sector)
            for (int k = 0; k < ring; ++k) {
                const int outer = sector * ring + k, inner = sector * (ring - 1) + k;
                mesh.faces.add({index(ring - 1, inner), index(ring, outer), index(ring, outer + 1)});
                if (k + 1 < ring)
                    mesh.faces.add({index(ring - 1, inner), index(ring, outer + 1), index(ring - 1, inner + 1)});
            }
    return mesh;
}

/// n×n cells over the unit square, vertices inside shifted by a part of a cell so that no two are alike; quads or
/// triangles.
inline Mesh square(int n, bool quads, double part = 0.2) {
    Mesh mesh;
    mesh.positions.resize((n + 1) * (n + 1), 2);
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) {
            const bool inside = i > 0 && i < n && j > 0 && j < n;
            const double shift = inside ? part / n : 0.0;
            mesh.positions.row(j * (n + 1) + i) << static_cast<double>(i) / n + shift * std::sin(3.0 * i + 5.0 * j),
                static_cast<double>(j) / n + shift * std::cos(7.0 * i - 2.0 * j);
        }
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const int a = j * (n + 1) + i, b = a + 1, c = a + n + 2, d = a + n + 1;
            if (quads) {
                mesh.faces.add({a, b, c, d});
            } else {
                mesh.faces.add({a, b, c});
                mesh.faces.add({a, c, d});
            }
        }
    return mesh;
}

/// The same mesh with every point moved into space.
inline Mesh bent(const Mesh& mesh, const std::function<Eigen::Vector3d(double, double)>& place) {
    Mesh result;
    result.faces = mesh.faces;
    result.positions.resize(mesh.vertex_count(), 3);
    for (int v = 0; v < mesh.vertex_count(); ++v)
        result.positions.row(v) = place(mesh.positions(v, 0), mesh.positions(v, 1));
    return result;
}

inline Mesh scaled(Mesh mesh, double factor) {
    mesh.positions *= factor;
    return mesh;
}

inline Eigen::VectorXcd points(const Mesh& mesh) {
    Eigen::VectorXcd z(mesh.vertex_count());
    for (int v = 0; v < mesh.vertex_count(); ++v) z[v] = {mesh.positions(v, 0), mesh.positions(v, 1)};
    return z;
}

/// Every boundary vertex of a planar mesh sent to image(its point).
inline BoundaryCondition prescribe(const Surface& source, const std::function<Complex(Complex)>& image) {
    const Eigen::VectorXcd z = points(source.mesh);
    BoundaryCondition boundary;
    for (const auto& loop : source.topology.boundary_loops)
        for (const int v : loop) boundary.pin(v, image(z[v]));
    return boundary;
}

/// The unit circle to three lobes, turned unevenly: the harmonic map with these boundary values folds.
inline Complex three_lobes(Complex z) {
    const double t = std::arg(z);
    return std::polar(1 + 0.45 * std::cos(3 * t), t + 0.4 * std::sin(t) + 0.1 * std::sin(3 * t));
}

/// Largest distance between two maps relative to the second's diameter.
inline double difference(const Eigen::VectorXcd& a, const Eigen::VectorXcd& b) {
    const double size = (b.array() - b[0]).abs().maxCoeff();
    return (a - b).cwiseAbs().maxCoeff() / size;
}

/// The same after the best similarity has been applied to the first.
inline double difference_up_to_similarity(const Eigen::VectorXcd& a, const Eigen::VectorXcd& b) {
    const Eigen::VectorXcd x = a.array() - a.mean(), y = b.array() - b.mean();
    const Complex factor = x.dot(y) / x.squaredNorm();  // dot conjugates x
    return (factor * x - y).cwiseAbs().maxCoeff() / y.cwiseAbs().maxCoeff();
}

}  // namespace beltrami::baseline_tests
