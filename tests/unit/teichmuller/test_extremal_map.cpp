#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include <beltrami/base/error.h>
#include <beltrami/base/parallel.h>
#include <beltrami/charts/boundary_values.h>
#include <beltrami/generate/sphere.h>
#include <beltrami/solve/beltrami_solver.h>
#include <beltrami/teichmuller/extremal_map.h>

#include "support/cause_of.h"
#include "support/meshes.h"

namespace beltrami {
namespace {

/// Lobes that the coarsest of the meshes below resolves: where a notch counts as a corner of the boundary values, k is
/// not settled to 1e-8.
Complex gentle_lobes(Complex z) {
    const double t = std::arg(z);
    return std::polar(1 + 0.25 * std::cos(3 * t), t + 0.3 * std::sin(t));
}

/// A surface with uneven boundary values carried along by the mesh.
struct Problem {
    Mesh mesh;
    std::vector<std::pair<int, Complex>> values;

    /// A bump over the disk.
    explicit Problem(int triangles) : mesh(test::bump(triangles)) {
        const Surface surface(mesh);
        const BoundaryCondition b = test::boundary_values(surface, gentle_lobes);
        for (std::size_t i = 0; i < b.vertices.size(); ++i) values.emplace_back(b.vertices[i], b.images[i]);
    }
    ExtremalMap solve() const {
        const Surface surface(mesh);
        BoundaryCondition b;
        for (const auto& [v, image] : values) b.pin(v, image);
        return extremal_map(surface, b);
    }
};

/// Sizes on both sides of where the coarse start and where the interpolation of differentials begin.
class Invariance : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Triangles, Invariance, testing::Values(2500, 9000));
INSTANTIATE_TEST_SUITE_P(LargeTriangles, Invariance, testing::Values(50000));

TEST_P(Invariance, PlaceAndScaleInSpace) {
    const Problem original(GetParam());
    const double k = original.solve().k;
    const Eigen::Quaterniond rotation = Eigen::Quaterniond(0.4, 0.2, -0.7, 0.5).normalized();
    for (const double scale : {1e-6, 1e6}) {
        Problem moved = original;
        for (int v = 0; v < moved.mesh.vertex_count(); ++v)
            moved.mesh.positions.row(v) =
                (scale * (rotation * moved.mesh.point(v) + Eigen::Vector3d(10, -20, 5))).transpose();
        for (auto& [v, image] : moved.values) image = 7.0 * scale * std::polar(1.0, 2.0) * image + 3.0 * scale;
        EXPECT_NEAR(moved.solve().k / k, 1, 1e-8) << scale;
    }
}

TEST_P(Invariance, PlaceAndScaleInThePlane) {
    Problem flat(GetParam());
    flat.mesh.positions.col(2).setZero();
    const double k = flat.solve().k;
    for (const double scale : {1e-6, 1e6}) {
        Problem moved = flat;
        for (int v = 0; v < moved.mesh.vertex_count(); ++v) {
            const Complex z =
                scale * (std::polar(1.0, 1.0) * Complex(moved.mesh.positions(v, 0), moved.mesh.positions(v, 1)) + 5.0);
            moved.mesh.positions.row(v) << z.real(), z.imag(), 0;
        }
        EXPECT_NEAR(moved.solve().k / k, 1, 1e-8) << scale;
    }
}

TEST_P(Invariance, Numbering) {
    const Problem original(GetParam());
    const double k = original.solve().k;
    std::vector<int> order(original.mesh.vertex_count());
    std::iota(order.begin(), order.end(), 0);
    for (std::size_t i = 0; i < order.size(); ++i) std::swap(order[i], order[(i * 7919 + 13) % order.size()]);
    Problem renumbered = original;
    renumbered.mesh.faces = {};
    for (std::size_t v = 0; v < order.size(); ++v)
        renumbered.mesh.positions.row(order[v]) = original.mesh.positions.row(static_cast<int>(v));
    for (int f = original.mesh.face_count() - 1; f >= 0; --f) {
        const auto v = original.mesh.faces[f];
        renumbered.mesh.faces.add({order[v[2]], order[v[0]], order[v[1]]});
    }
    for (auto& [v, image] : renumbered.values) v = order[v];
    EXPECT_NEAR(renumbered.solve().k / k, 1, 1e-8);
}

TEST_P(Invariance, SameBytesOnAnyNumberOfThreads) {
    const int before = thread_count();
    const Problem problem(GetParam());
    set_thread_count(1);
    const ExtremalMap one = problem.solve();
    set_thread_count(3);
    const ExtremalMap three = problem.solve();
    set_thread_count(before);
    EXPECT_EQ(one.map, three.map);
    EXPECT_EQ(one.k, three.k);
    EXPECT_EQ(one.K_lower, three.K_lower);
}

TEST(ExtremalMap, IsBetterThanItsStartAndCertified) {
    const ExtremalMap result = Problem(2500).solve();
    EXPECT_EQ(result.termination, Termination::converged);
    EXPECT_TRUE(result.distortion.flipped.empty());
    EXPECT_LE(result.K_lower, result.K);
    EXPECT_LE(result.K, result.K_max);
    EXPECT_LT((result.K - result.K_lower) / result.K, 0.01);
    EXPECT_LT(result.distortion.standard_deviation, 0.03);
    EXPECT_EQ(result.boundary_residual, 0.0);
    for (const Bound& bound : result.bounds) {
        if (bound.of == Bound::Of::extremal) {
            EXPECT_LE(bound.K, result.K_max) << to_string(bound.kind);
        }
    }
    EXPECT_TRUE(result.one_to_one());
}

TEST(ExtremalMap, ConformalBoundaryValuesGiveTheConformalMap) {
    const Surface surface(disk(disk_rings_for_triangles(3000)));
    const auto moebius = [](Complex z) { return (z + 0.4) / (1.0 + 0.4 * z); };
    const ExtremalMap result = extremal_map(surface, test::boundary_values(surface, moebius));
    EXPECT_EQ(result.termination, Termination::converged);
    EXPECT_LT(result.k, 1e-3);
    EXPECT_TRUE(result.distortion.flipped.empty());
    // And the identity, whose coefficient is exactly 0.
    const ExtremalMap identity = extremal_map(surface, test::boundary_values(surface, [](Complex z) { return z; }));
    EXPECT_EQ(identity.termination, Termination::converged);
    EXPECT_LT(identity.k, 1e-10);
}

TEST(ExtremalMap, QuadsGiveTheSameK) {
    const Surface surface(test::quad_disk(22));
    const ExtremalMap result = extremal_map(surface, test::boundary_values(surface, test::exact_composition));
    EXPECT_TRUE(result.distortion.flipped.empty());
    EXPECT_LE(result.K_lower, result.K);
    EXPECT_LE(result.K, result.K_max);
    EXPECT_LE(result.K_lower, 3.0);
    EXPECT_NEAR(result.k, 0.5, 5e-4);
}

TEST(ExtremalMap, ACustomMetricIsTheSourceThatCounts) {
    // The disk with the metric of a surface over it must give what the surface gives, bounds included.
    const Mesh flat = disk(disk_rings_for_triangles(2500)), shape = test::bump(2500, 0.8);
    ASSERT_EQ(flat.faces, shape.faces);
    Positions corners(flat.faces.corner_count(), 3);
    for (int c = 0; c < corners.rows(); ++c) corners.row(c) = shape.positions.row(flat.faces.vertices()[c]);
    std::vector<EdgeLength> lengths;
    const Surface expected(shape);
    for (const auto& [a, b] : expected.topology.edges)
        lengths.push_back({a, b, (shape.point(a) - shape.point(b)).norm()});
    const ExtremalMap truth = extremal_map(expected, boundary_to_disk(expected, 0.7));
    EXPECT_GT(truth.k, 0.05);
    for (const Positions& metric : {corners, corners_from_lengths(flat, lengths)}) {
        const Surface surface(flat, metric);
        const ExtremalMap result = extremal_map(surface, boundary_to_disk(surface, 0.7));
        EXPECT_NEAR(result.k, truth.k, 1e-8);
        EXPECT_NEAR(result.K_lower, truth.K_lower, 1e-7);
        EXPECT_LT((result.map - truth.map).cwiseAbs().maxCoeff(), 1e-7);
    }
}

TEST(ExtremalMap, WhatItCannotDoIsAnErrorWithItsCause) {
    const Surface surface(disk(disk_rings_for_triangles(200)));
    BoundaryCondition part = test::boundary_values(surface, [](Complex z) { return z; });
    BoundaryCondition inside = part;
    part.vertices.pop_back();
    part.images.pop_back();
    EXPECT_EQ(test::cause_of([&] { extremal_map(surface, part); }), Cause::bad_boundary);
    EXPECT_EQ(test::cause_of([&] { extremal_map(icosahedral_sphere(1), part); }), Cause::bad_mesh);
    int inner = 0;
    while (surface.topology.on_boundary[inner]) ++inner;
    inside.pin(inner, 5.0);
    EXPECT_EQ(test::cause_of([&] { extremal_map(surface, inside); }), Cause::bad_boundary);
    ExtremalOptions options;
    options.tolerance = -1;
    EXPECT_EQ(test::cause_of([&] { extremal_map(surface, inside, options); }), Cause::bad_option);
    options = {};
    options.progress = [](int, double) { return false; };
    EXPECT_EQ(
        test::cause_of([&] { extremal_map(surface, test::boundary_values(surface, test::three_lobes), options); }),
        Cause::cancelled);
}

TEST(ExtremalMap, BoundaryValuesThatNoMapHasAreRefused) {
    const Surface surface(disk(8));
    const auto refused = [&](const std::function<Complex(Complex)>& values) {
        try {
            extremal_map(surface, test::boundary_values(surface, values));
        } catch (const Error& error) {
            EXPECT_EQ(error.cause(), Cause::bad_boundary);
            for (const int v : error.indices()) EXPECT_TRUE(surface.topology.on_boundary[v]);
            return true;
        }
        return false;
    };
    EXPECT_TRUE(refused([](Complex z) { return std::conj(z); }));
    EXPECT_TRUE(refused([](Complex) { return Complex(1, 1); }));
    EXPECT_TRUE(refused(
        [](Complex z) { return std::polar(1.0, std::arg(z) + 1.4 * std::sin(std::arg(z))); }));  // runs backwards
    EXPECT_TRUE(refused([](Complex z) { return z + 0.9 * z * z * z; }));                         // crosses itself
    EXPECT_FALSE(refused([](Complex z) { return z + 0.2 * z * z; }));
}

TEST(ExtremalMap, MeshesWithoutInnerVertices) {
    // A strip of triangles with a bend, in the plane and in space: every vertex is prescribed, the map is its own
    // result.
    for (const double height : {0.0, 0.4}) {
        Mesh mesh;
        mesh.positions.resize(8, 3);
        for (int i = 0; i < 4; ++i) {
            mesh.positions.row(2 * i) << i, 0, height * i * i;
            mesh.positions.row(2 * i + 1) << i + 0.1, 1 + 0.2 * i, height * i * i;
        }
        for (int i = 0; i < 3; ++i) {
            mesh.faces.add({2 * i, 2 * i + 2, 2 * i + 1});
            mesh.faces.add({2 * i + 1, 2 * i + 2, 2 * i + 3});
        }
        const Surface surface(mesh);
        const ExtremalMap result = extremal_map(surface, boundary_to_disk(surface, 0.1));
        // So few triangles cannot show the φ that the polygons' corners want.
        EXPECT_NE(result.termination, Termination::iteration_limit);
        EXPECT_TRUE(result.one_to_one());
        EXPECT_LE(result.K_lower_proved, result.K);
        EXPECT_LE(result.K_lower, result.K_max);
    }
}

/// 24 faces stretched twenty times over rough ground: no face of the chart is anywhere near conformal.
TEST(ExtremalMap, PinsWhereTheChartSaysNextToNothing) {
    for (int seed = 0; seed < 8; ++seed) {
        Mesh mesh = disk(2);
        const Positions flat = mesh.positions;
        mesh.positions.resize(flat.rows(), 3);
        for (Eigen::Index v = 0; v < flat.rows(); ++v)
            mesh.positions.row(v) << 20 * flat(v, 0), flat(v, 1),
                0.6 * std::sin(1.7 * (seed + 1) * static_cast<double>(v * v));
        const Surface surface(mesh);
        BoundaryCondition boundary = boundary_to_disk(surface, 0.3);
        const Eigen::VectorXcd harmonic = harmonic_map(surface, boundary);
        int inner = mesh.vertex_count() - 1;
        while (surface.topology.on_boundary[inner]) --inner;
        boundary.pin(inner, harmonic[inner] + 0.02);
        const ExtremalMap result = extremal_map(surface, boundary);
        EXPECT_GT(result.K, 1) << seed;
        EXPECT_LE(result.K_lower_proved, result.K) << seed;
        EXPECT_FALSE(result.warnings.empty()) << seed;
        if (result.one_to_one()) {
            EXPECT_LE(result.K_lower_proved, result.K_max) << seed;
        }
    }
}

TEST(ExtremalMap, AnIterationLimitIsSaid) {
    const Surface surface(disk(disk_rings_for_triangles(500)));
    ExtremalOptions options;
    options.max_iterations = 2;
    const ExtremalMap result = extremal_map(surface, test::boundary_values(surface, test::three_lobes), options);
    EXPECT_EQ(result.termination, Termination::iteration_limit);
    EXPECT_EQ(result.iterations, 2);
    EXPECT_FALSE(result.warnings.empty());
}

}  // namespace
}  // namespace beltrami
