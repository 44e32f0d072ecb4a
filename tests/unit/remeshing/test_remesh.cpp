#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include <beltrami/base/constants.h>
#include <beltrami/generate/double_torus.h>
#include <beltrami/generate/sphere.h>
#include <beltrami/io/read_mesh.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/remeshing/feature_curves.h>
#include <beltrami/remeshing/mesh_comparison.h>
#include <beltrami/remeshing/remesh.h>
#include <beltrami/space/corner_elements.h>
#include <beltrami/space/reference_shapes.h>

#include "support/cause_of.h"
#include "support/meshes.h"
#include "support/real_mesh.h"

namespace beltrami {
namespace {

/// A box of n cells along every edge, its vertices moved within their faces and edges.
Mesh jittered_box(int n, double amount) {
    Mesh mesh;
    std::vector<Eigen::Vector3d> points;
    const auto index = [&](const Eigen::Vector3i& at) {
        for (std::size_t i = 0; i < points.size(); ++i)
            if ((points[i] - at.cast<double>()).norm() < 1e-9) return static_cast<int>(i);
        points.push_back(at.cast<double>());
        return static_cast<int>(points.size()) - 1;
    };
    for (int axis = 0; axis < 3; ++axis)
        for (const int side : {0, n})
            for (int i = 0; i < n; ++i)
                for (int j = 0; j < n; ++j) {
                    const auto at = [&](int u, int v) {
                        Eigen::Vector3i p;
                        p[axis] = side;
                        p[(axis + 1) % 3] = i + u;
                        p[(axis + 2) % 3] = j + v;
                        return index(p);
                    };
                    const int a = at(0, 0), b = at(1, 0), c = at(1, 1), d = at(0, 1);
                    if (side > 0) {
                        mesh.faces.add({a, b, c});
                        mesh.faces.add({a, c, d});
                    } else {
                        mesh.faces.add({a, c, b});
                        mesh.faces.add({a, d, c});
                    }
                }
    mesh.positions.resize(static_cast<Eigen::Index>(points.size()), 3);
    for (std::size_t v = 0; v < points.size(); ++v) {
        Eigen::Vector3d p = points[v];
        for (int a = 0; a < 3; ++a)
            if (p[a] > 0 && p[a] < n) p[a] += amount * std::sin(37.0 * static_cast<double>(v) + 11 * a);
        mesh.positions.row(static_cast<Eigen::Index>(v)) = p / n;
    }
    return mesh;
}

TEST(FeatureCurves, OfABoxAreItsEdgesAndCorners) {
    const Mesh mesh = jittered_box(5, 0.2);
    const FeatureCurves features = feature_curves(mesh, topology(mesh), 40 * kPi / 180);
    EXPECT_EQ(features.curves.size(), 12u);
    EXPECT_EQ(features.corners.size(), 8u);
    for (const FeatureCurves::Curve& curve : features.curves) EXPECT_EQ(curve.vertices.size(), 6u);
    EXPECT_TRUE(feature_curves(mesh, topology(mesh), {}).curves.empty());
}

TEST(FeatureCurves, OfABorderTurnOnlyAtItsCorners) {
    const Mesh round = disk(6), square = test::jittered_square(6);
    const FeatureCurves of_disk = feature_curves(round, topology(round), {}),
                        of_square = feature_curves(square, topology(square), {});
    ASSERT_EQ(of_disk.curves.size(), 1u);
    EXPECT_TRUE(of_disk.curves[0].closed);
    EXPECT_EQ(of_disk.curves[0].vertices.size(), 36u);
    EXPECT_TRUE(of_disk.corners.empty());
    EXPECT_EQ(of_square.curves.size(), 4u);
    EXPECT_EQ(of_square.corners, (std::vector<int>{0, 6, 42, 48}));
}

TEST(MeshComparison, AnglesOfEquilateralTrianglesAndOfSquares) {
    const AngleStatistics squares = angle_statistics(test::quad_square(4, 0));
    EXPECT_NEAR(squares.smallest, 90, 1e-9);
    EXPECT_NEAR(squares.mean_deviation, 0, 1e-9);
    EXPECT_EQ(squares.histogram[9] + squares.histogram[8], 64);
    const AngleStatistics triangles = angle_statistics(test::square(4, 0, [](int, int) { return false; }));
    EXPECT_NEAR(triangles.smallest, 45, 1e-9);
    EXPECT_NEAR(triangles.largest, 90, 1e-9);
    EXPECT_NEAR(triangles.mean_deviation, 20, 1e-9);
    EXPECT_NEAR(triangles.median_deviation, 15, 1e-9);
}

TEST(MeshComparison, ValenceFloor) {
    EXPECT_NEAR(valence_floor(6), 0, 1e-15);
    EXPECT_NEAR(valence_floor(4), 2 - std::sqrt(3), 1e-12);  // a right triangle
    EXPECT_NEAR(valence_floor(5), 0.114, 5e-4);
    EXPECT_NEAR(valence_floor(8), 0.165, 5e-4);
}

double distance_in_diagonals(const Mesh& mesh, const Positions& positions) {
    Mesh image = mesh;
    image.positions = positions;
    return surface_distance(MeshTarget(mesh), MeshTarget(image)).largest /
           (mesh.positions.colwise().maxCoeff() - mesh.positions.colwise().minCoeff()).norm();
}

AngleStatistics angles_of(const Mesh& mesh, const Positions& positions) {
    Mesh image = mesh;
    image.positions = positions;
    return angle_statistics(image);
}

TEST(Remesh, KeepsEdgesAndCornersOfABox) {
    const Mesh mesh = jittered_box(6, 0.3);
    const Surface surface(mesh);
    RemeshOptions options;
    options.feature_angle = 40 * kPi / 180;
    const RemeshedSurface result = remesh(surface, regular_shapes(mesh.faces), options);
    EXPECT_TRUE(result.settled);
    EXPECT_TRUE(result.unresolved.empty());
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        int before = 0, after = 0;  // faces of the box that the vertex is on
        for (int a = 0; a < 3; ++a) {
            const double x = mesh.positions(v, a), y = result.positions(v, a);
            if (x == 0 || x == 1) before |= 1 << (2 * a + (x == 1));
            if (std::abs(y) < 1e-12 || std::abs(y - 1) < 1e-12) after |= 1 << (2 * a + (y > 0.5));
        }
        EXPECT_EQ(before, after) << v;
    }
    EXPECT_LT(distance_in_diagonals(mesh, result.positions), 1e-9);
    const AngleStatistics before = angle_statistics(mesh), after = angles_of(mesh, result.positions);
    EXPECT_GT(after.smallest, before.smallest + 10);
    EXPECT_LT(after.mean_deviation, before.mean_deviation);
}

// A grid of right triangles has the conformal structure of squares; that of equilateral triangles is another torus,
// exactly |μ| = 2 − √3 away, whatever the vertices do.
TEST(Remesh, OnAGridOfRightTrianglesReachesTheTeichmuellerDistance) {
    Mesh mesh = torus(2, 1, 24, 24);
    mesh.faces = {};
    const auto index = [](int i, int j) { return (i % 24) * 24 + j % 24; };
    for (int i = 0; i < 24; ++i)
        for (int j = 0; j < 24; ++j) {
            mesh.faces.add({index(i, j), index(i + 1, j), index(i + 1, j + 1)});
            mesh.faces.add({index(i, j), index(i + 1, j + 1), index(i, j + 1)});
        }
    const Surface surface(mesh);
    RemeshOptions options;
    options.even_size = 0;
    options.max_distance = 0.03;
    const RemeshedSurface result = remesh(surface, regular_shapes(mesh.faces), options);
    const CornerElements elements = corner_elements(mesh, regular_shapes(mesh.faces));
    const Mesh image{result.positions, mesh.faces, {}};
    const Distortion d = distortion(elements.operators, result.positions, vertex_normals(image));
    EXPECT_TRUE(d.flipped.empty());
    // τ of the torus of revolution (2, 1) is i √3, of the reference e^{2πi/3}, mirrored e^{iπ/3}.
    const Complex a(0, 1 / std::sqrt(3.0)), b = std::polar(1.0, kPi / 3);
    const double moved = std::norm(a - b) / (2 * a.imag() * b.imag());
    const double k = std::tanh(std::acosh(1 + moved) / 2);
    EXPECT_GT(d.mean, 0.97 * k);
    EXPECT_LT(d.max, 1.2 * k);
}

TEST(Remesh, QuadsBecomeSquarer) {
    Mesh mesh = test::quad_square(10, 0.35);
    const Positions flat = mesh.positions;
    mesh.positions.resize(flat.rows(), 3);
    for (Eigen::Index v = 0; v < flat.rows(); ++v)
        mesh.positions.row(v) << flat(v, 0), flat(v, 1), 0.2 * std::sin(3 * flat(v, 0)) * flat(v, 1);
    const Surface surface(mesh);
    const RemeshedSurface result = remesh(surface, regular_shapes(mesh.faces));
    const AngleStatistics before = angle_statistics(mesh), after = angles_of(mesh, result.positions);
    EXPECT_GT(after.smallest, before.smallest + 10);
    EXPECT_LT(after.mean_deviation, 0.5 * before.mean_deviation);
    EXPECT_LT(distance_in_diagonals(mesh, result.positions), 1.4 * 0.003);
}

TEST(Remesh, FastIsALinearSolveThatImproves) {
    Mesh mesh = icosahedral_sphere(3);
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        Eigen::Vector3d p = mesh.point(v);
        p += 0.05 * Eigen::Vector3d(std::sin(40 * p[1]), std::cos(31 * p[2]), std::sin(23 * p[0]));
        mesh.positions.row(v) = p.normalized();
    }
    const Surface surface(mesh);
    RemeshOptions options;
    options.fast = true;
    const RemeshedSurface result = remesh(surface, regular_shapes(mesh.faces), options);
    EXPECT_EQ(result.factorizations, 1);
    EXPECT_LT(angles_of(mesh, result.positions).mean_deviation, 0.75 * angle_statistics(mesh).mean_deviation);
}

TEST(Remesh, SizesFollow) {
    const Mesh mesh = icosahedral_sphere(3);
    const Surface surface(mesh);
    RemeshOptions options;
    options.even_size = 1;
    options.max_distance = 0.05;
    options.sizing = Eigen::VectorXd(mesh.vertex_count());
    for (int v = 0; v < mesh.vertex_count(); ++v) (*options.sizing)[v] = std::exp(0.4 * mesh.positions(v, 2));
    const RemeshedSurface result = remesh(surface, regular_shapes(mesh.faces), options);
    const Mesh image{result.positions, mesh.faces, {}};
    double above = 0, below = 0;
    int count_above = 0, count_below = 0;
    for (int f = 0; f < mesh.face_count(); ++f) {
        double z = 0;
        for (const int v : mesh.faces[f]) z += image.positions(v, 2) / 3;
        if (z > 0.6) above += face_vector_area(image, f).norm(), ++count_above;
        if (z < -0.6) below += face_vector_area(image, f).norm(), ++count_below;
    }
    EXPECT_GT((above / count_above) / (below / count_below), 1.5);
}

TEST(Remesh, SmallAnglesAreOpened) {
    for (const bool smooth : {true, false}) {
        const Mesh mesh = smooth ? double_torus(0.16) : jittered_box(7, 0.3);
        const Surface surface(mesh);
        RemeshOptions options;
        options.feature_angle = 40 * kPi / 180;
        const RemeshedSurface closed = remesh(surface, regular_shapes(mesh.faces), options);
        options.open_angles = true;
        const RemeshedSurface opened = remesh(surface, regular_shapes(mesh.faces), options);
        const AngleStatistics before = angles_of(mesh, closed.positions), after = angles_of(mesh, opened.positions);
        EXPECT_GE(after.smallest, before.smallest);
        EXPECT_GE(after.one_percent, before.one_percent);
        if (smooth) {
            EXPECT_GT(after.smallest, before.smallest + 2);
            EXPECT_GT(after.one_percent, before.one_percent + 1);
        }
        EXPECT_TRUE(opened.settled);
        EXPECT_TRUE(opened.unresolved.empty());
        EXPECT_LE(opened.distance, 1.4 * options.max_distance);
    }
}

TEST(Remesh, WhatIsTooFarAwayIsNotCalledSettled) {
    const Mesh mesh = icosahedral_sphere(2);
    const Surface surface(mesh);
    RemeshOptions options;
    options.max_distance = 1e-12;
    const RemeshedSurface result = remesh(surface, regular_shapes(mesh.faces), options);
    EXPECT_EQ(result.settled, result.distance <= 1.4 * options.max_distance);
}

TEST(Remesh, RefusesImpossibleOptions) {
    const Mesh mesh = icosahedral_sphere(1);
    const Surface surface(mesh);
    const Positions shapes = regular_shapes(mesh.faces);
    RemeshOptions options;
    options.power = 1;
    EXPECT_EQ(test::cause_of([&] { remesh(surface, shapes, options); }), Cause::bad_option);
    options.power = 4;
    options.sizing = Eigen::VectorXd::Ones(3);
    EXPECT_EQ(test::cause_of([&] { remesh(surface, shapes, options); }), Cause::bad_option);
}

// Numbers of an independent implementation, within five percent.
TEST(Remesh, APuncturedTorus) {
    const auto path = test::real_mesh("punctured_torus.obj");
    if (path.empty()) GTEST_SKIP();
    Mesh mesh = read_mesh(path.string()).mesh;
    mesh.texture.reset();  // its seams would hold vertices
    const Surface surface(mesh);
    RemeshOptions options;
    options.power = 2;
    const RemeshedSurface two = remesh(surface, regular_shapes(mesh.faces), options);
    const AngleStatistics angles = angles_of(mesh, two.positions);
    EXPECT_GT(angles.one_percent, 0.95 * 43.0);
    EXPECT_LT(angles.mean_deviation, 1.05 * 6.2);
    EXPECT_LT(two.distance, 1.4 * 0.003);
    EXPECT_TRUE(two.unresolved.empty());
    options.power = 8;
    const RemeshedSurface eight = remesh(surface, regular_shapes(mesh.faces), options);
    const AngleStatistics worst = angles_of(mesh, eight.positions);
    EXPECT_GT(worst.smallest, 0.95 * 39.9);
    EXPECT_GT(worst.one_percent, 0.95 * 45.0);
    EXPECT_LT(worst.mean_deviation, 1.05 * 7.2);
    EXPECT_LT(eight.distance, 1.4 * 0.003);
    EXPECT_TRUE(eight.unresolved.empty());
}

// Of quads, with fins whose ridges turn by more than a right angle: there a face must not hold up all others.
TEST(Remesh, LargeAFishOfQuads) {
    const auto path = test::real_mesh("fish_quad.obj");
    if (path.empty()) GTEST_SKIP();
    Mesh mesh = read_mesh(path.string()).mesh;
    mesh.texture.reset();
    const Surface surface(mesh);
    RemeshOptions options;
    const RemeshedSurface four = remesh(surface, regular_shapes(mesh.faces), options);
    const AngleStatistics angles = angles_of(mesh, four.positions);
    EXPECT_GT(angles.one_percent, 0.95 * 54.1);
    EXPECT_LT(angles.mean_deviation, 1.05 * 11.3);
    EXPECT_LT(four.distance, 1.4 * 0.003);
    EXPECT_TRUE(four.unresolved.empty());
    EXPECT_LT(four.factorizations, 60);
    options.open_angles = true;
    const RemeshedSurface opened = remesh(surface, regular_shapes(mesh.faces), options);
    const AngleStatistics worst = angles_of(mesh, opened.positions);
    EXPECT_GT(worst.smallest, 50);
    EXPECT_GT(worst.one_percent, 60);
    EXPECT_LT(opened.distance, 1.4 * 0.003);
    EXPECT_TRUE(opened.unresolved.empty());
}

// Horns and ears so coarse that faces oppose the surface already: there are not more of them afterwards, and they are
// named.
TEST(Remesh, LargeACowDoesNotGetMoreOpposedFaces) {
    const auto path = test::real_mesh("cow.off");
    if (path.empty()) GTEST_SKIP();
    const Surface surface(read_mesh(path.string()).mesh);
    RemeshOptions options;
    options.power = 2;
    const RemeshedSurface result = remesh(surface, regular_shapes(surface.mesh.faces), options);
    EXPECT_FALSE(result.opposed_before.empty());
    EXPECT_LE(result.unresolved.size(), result.opposed_before.size());
    EXPECT_LT(result.distance, 1.4 * 0.003);
    ASSERT_FALSE(result.warnings.empty());
    EXPECT_EQ(result.warnings.back().where.indices, result.unresolved);
    EXPECT_LT(angles_of(surface.mesh, result.positions).mean_deviation, angle_statistics(surface.mesh).mean_deviation);
}

}  // namespace
}  // namespace beltrami
