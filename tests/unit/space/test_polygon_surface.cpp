#include <gtest/gtest.h>

#include <cmath>

#include <Eigen/Geometry>

#include <beltrami/base/constants.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/remeshing/mesh_comparison.h>
#include <beltrami/remeshing/remesh.h>
#include <beltrami/space/corner_elements.h>
#include <beltrami/space/polygon_surface.h>
#include <beltrami/space/reference_shapes.h>

#include "support/cause_of.h"

namespace beltrami {
namespace {

/// A hexagonal honeycomb of rings around a cell, its vertices moved; where height is positive, on a bump.
Mesh honeycomb(int rings, double amount, double height) {
    Mesh mesh;
    std::vector<Eigen::Vector2d> points;
    const auto index = [&](const Eigen::Vector2d& at) {
        for (std::size_t i = 0; i < points.size(); ++i)
            if ((points[i] - at).norm() < 1e-6) return static_cast<int>(i);
        points.push_back(at);
        return static_cast<int>(points.size()) - 1;
    };
    for (int a = -rings; a <= rings; ++a)
        for (int b = -rings; b <= rings; ++b) {
            if (std::abs(a + b) > rings) continue;
            const Eigen::Vector2d centre(std::sqrt(3.0) * (a + 0.5 * b), 1.5 * b);
            std::vector<int> face;
            for (int j = 0; j < 6; ++j) {
                const double angle = kPi / 6 + j * kPi / 3;
                face.push_back(index(centre + Eigen::Vector2d(std::cos(angle), std::sin(angle))));
            }
            mesh.faces.add(face);
        }
    mesh.positions.resize(static_cast<Eigen::Index>(points.size()), 3);
    for (std::size_t v = 0; v < points.size(); ++v) {
        const auto i = static_cast<double>(v);
        const double x = points[v].x() + amount * std::sin(37 * i), y = points[v].y() + amount * std::sin(59 * i + 1);
        mesh.positions.row(static_cast<Eigen::Index>(v)) << x, y, height * std::exp(-0.05 * (x * x + y * y));
    }
    return mesh;
}

TEST(PolygonSurface, HasThePolygonsTopologyAndTheirCornerTriangles) {
    const Mesh mesh = honeycomb(3, 0.1, 0);
    const Surface surface = polygon_surface(mesh);
    EXPECT_EQ(surface.mesh.face_count(), 37);
    EXPECT_EQ(surface.operators.sample_count(), 6 * 37);
    EXPECT_EQ(surface.topology.genus, 0);
    ASSERT_EQ(surface.topology.boundary_loops.size(), 1U);
    EXPECT_EQ(surface.topology.boundary_loops[0].size(), surface.boundary_edge_lengths[0].size());
    double around = 0;
    for (const double length : surface.boundary_edge_lengths[0]) around += length;
    EXPECT_GT(around, 6.0 * 7 - 10);
}

// 1/(4 sin²(π/n)) of the corner triangles' areas: exact for regular polygons.
TEST(PolygonSurface, RegularPolygonsHaveTheirAreas) {
    for (int n = 3; n <= 12; ++n) {
        Mesh mesh;
        mesh.positions.resize(n, 2);
        std::vector<int> face;
        for (int j = 0; j < n; ++j) {
            mesh.positions.row(j) << std::cos(2 * kPi * j / n), std::sin(2 * kPi * j / n);
            face.push_back(j);
        }
        mesh.faces.add(face);
        EXPECT_NEAR(corner_elements(mesh).operators.area(), 0.5 * n * std::sin(2 * kPi / n), 1e-12) << n;
    }
}

TEST(PolygonSurface, AffineMapsHaveOneCoefficient) {
    const Mesh mesh = honeycomb(2, 0.1, 0);
    const CornerElements elements = corner_elements(mesh);
    const Complex mu(0.3, -0.2);
    Positions image(mesh.vertex_count(), 2);
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        const Complex z(mesh.positions(v, 0), mesh.positions(v, 1)), w = z + mu * std::conj(z);
        image.row(v) << w.real(), w.imag();
    }
    const Distortion d = distortion(elements.operators, image);
    EXPECT_NEAR(d.mean, std::abs(mu), 1e-12);
    EXPECT_LT(d.standard_deviation, 1e-12);
    EXPECT_LT((d.mu.array() - mu).abs().maxCoeff(), 1e-12);
}

TEST(PolygonSurface, RemeshingKeepsThePolygons) {
    const Surface surface = polygon_surface(honeycomb(5, 0.22, 1.5));
    RemeshOptions options;
    options.max_distance = 0.01;
    const RemeshedSurface result = remesh(surface, regular_shapes(surface.mesh.faces), options);
    Mesh image = surface.mesh;
    image.positions = result.positions;
    const AngleStatistics before = angle_statistics(surface.mesh), after = angle_statistics(image);
    EXPECT_GT(after.one_percent, before.one_percent);
    EXPECT_LT(after.mean_deviation, 0.7 * before.mean_deviation);
    EXPECT_TRUE(result.unresolved.empty());
}

TEST(PolygonSurface, WhatIsNotConvexIsNamedOrCut) {
    Mesh mesh = honeycomb(1, 0, 0);
    const int corner = mesh.faces[3][0];
    mesh.positions.row(corner) = 0.3 * mesh.positions.row(corner) + 0.7 * mesh.positions.row(mesh.faces[3][3]);
    const std::vector<int> folded = folded_corner_faces(mesh);
    ASSERT_FALSE(folded.empty());
    EXPECT_EQ(test::cause_of([&] { polygon_surface(mesh); }), Cause::bad_mesh);
    const SplitMesh split = split_folded_polygons(mesh);
    EXPECT_EQ(split.cut, folded);
    EXPECT_EQ(split.mesh.face_count(), mesh.face_count() + 3 * static_cast<int>(folded.size()));
    EXPECT_TRUE(has_polygons(split.mesh));
    EXPECT_TRUE(folded_corner_faces(split.mesh).empty());
}

}  // namespace
}  // namespace beltrami
