#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include <beltrami/base/constants.h>
#include <beltrami/base/error.h>
#include <beltrami/base/random.h>
#include <beltrami/generate/double_torus.h>
#include <beltrami/generate/grids.h>
#include <beltrami/generate/round_domains.h>
#include <beltrami/generate/sphere.h>
#include <beltrami/mesh/diagnosis.h>
#include <beltrami/mesh/topology.h>
#include <beltrami/meshing/quality.h>

// Euler characteristics and genera of all generators are tested with topology().

namespace beltrami {
namespace {

constexpr double degree = kPi / 180.0;

double area(const Mesh& mesh) {
    double sum = 0.0;
    for (int f = 0; f < mesh.face_count(); ++f) sum += face_vector_area(mesh, f).norm();
    return sum;
}

/// Volume enclosed by a closed mesh; positive if its normals point outwards.
double volume(const Mesh& mesh) {
    double sum = 0.0;
    for (int f = 0; f < mesh.face_count(); ++f) {
        const std::span<const int> v = mesh.faces[f];
        for (std::size_t i = 1; i + 1 < v.size(); ++i)
            sum += mesh.point(v[0]).dot(mesh.point(v[i]).cross(mesh.point(v[i + 1]))) / 6.0;
    }
    return sum;
}

double smallest_signed_area(const Mesh& mesh) {
    double least = 1e300;
    for (int f = 0; f < mesh.face_count(); ++f) least = std::min(least, face_vector_area(mesh, f).z());
    return least;
}

template <class Make>
void expect_second_order(const Make& error_at, std::initializer_list<int> sizes) {
    double last = 0.0;
    for (const int n : sizes) {
        const double error = std::abs(error_at(n));
        if (last > 0.0) {
            EXPECT_NEAR(std::log2(last / error), 2.0, 0.1) << n;
        }
        last = error;
    }
}

TEST(Disk, CountsShapeAndArea) {
    for (const int rings : {1, 2, 5, 40}) {
        const Mesh mesh = disk(rings, 3.0);
        EXPECT_EQ(mesh.face_count(), 6 * rings * rings);
        EXPECT_EQ(mesh.vertex_count(), 1 + 3 * rings * (rings + 1));
        EXPECT_TRUE(diagnose(mesh).empty());
        EXPECT_GT(smallest_signed_area(mesh), 0.0);
        EXPECT_GE(quality(mesh).min_angle, 43.0 * degree);
        EXPECT_EQ(quality(mesh).ears, 0);
        const Topology topo = topology(mesh);
        ASSERT_EQ(static_cast<int>(topo.boundary_loops[0].size()), 6 * rings);
        for (int i = 0; i < 6 * rings; ++i) {
            EXPECT_EQ(topo.boundary_loops[0][i], mesh.vertex_count() - 6 * rings + i);
            EXPECT_NEAR(mesh.point(topo.boundary_loops[0][i]).norm(), 3.0, 1e-15);
        }
    }
    expect_second_order([](int n) { return area(disk(n)) - kPi; }, {5, 10, 20, 40});
    EXPECT_EQ(disk_rings_for_triangles(4500), 27);
    EXPECT_EQ(disk_rings_for_edge_length(0.1, 2.0), 20);
    EXPECT_THROW(disk(0), Error);
    EXPECT_THROW(disk(8000), Error);
    EXPECT_THROW(disk(3, -1.0), Error);
    EXPECT_THROW(disk(3, 1.0, {.amplitude = 0.6}), Error);
}

TEST(Annulus, EquilateralInLogarithmicCoordinates) {
    const Mesh mesh = annulus(0.1, 1.0, 60);
    EXPECT_TRUE(diagnose(mesh).empty());
    EXPECT_GT(smallest_signed_area(mesh), 0.0);
    EXPECT_GE(quality(mesh).min_angle, 55.0 * degree);
    const Topology topo = topology(mesh);
    ASSERT_EQ(topo.boundary_loops.size(), 2u);
    for (const int v : topo.boundary_loops[0]) EXPECT_NEAR(mesh.point(v).norm(), 1.0, 1e-15);
    for (const int v : topo.boundary_loops[1]) EXPECT_NEAR(mesh.point(v).norm(), 0.1, 1e-15);
    expect_second_order([](int n) { return area(annulus(0.5, 1, n)) - 0.75 * kPi; }, {20, 40, 80, 160});
    EXPECT_EQ(annulus(0.5, 1, 10, 7).face_count(), 140);
    EXPECT_THROW(annulus(1, 0.5, 10), Error);
    EXPECT_THROW(annulus(0, 1, 10), Error);
    EXPECT_THROW(annulus(0.5, 1, 2), Error);
}

TEST(Rectangle, TrianglesAndQuads) {
    for (const Cells cells : {Cells::triangles, Cells::quads}) {
        for (const int nx : {2, 3, 7, 8}) {
            const Mesh mesh = rectangle(3, 0.5, nx, 5, cells);
            EXPECT_TRUE(diagnose(mesh).empty());
            EXPECT_NEAR(area(mesh), 1.5, 1e-14);
            EXPECT_GT(smallest_signed_area(mesh), 0.0);
            EXPECT_EQ(mesh.point(mesh.vertex_count() - 1), Eigen::Vector3d(3, 0.5, 0));
            if (cells == Cells::triangles) {
                EXPECT_EQ(quality(mesh).ears, 0) << nx;
            }
        }
    }
    EXPECT_EQ(rectangle(1, 1, 1, 1).face_count(), 2);
    EXPECT_THROW(rectangle(1, 0, 1, 1), Error);
    EXPECT_THROW(rectangle(1, 1, 0, 1), Error);
    EXPECT_THROW(rectangle(1, 1, 100000, 100000), Error);
}

TEST(Sphere, AreaVolumeAndShape) {
    for (const Mesh& mesh : {icosahedral_sphere(4, 2.0), octahedral_sphere(4, 2.0)}) {
        EXPECT_TRUE(diagnose(mesh).empty());
        EXPECT_NEAR(volume(mesh), 4.0 / 3.0 * kPi * 8.0, 0.25);
        for (int v = 0; v < mesh.vertex_count(); ++v) EXPECT_NEAR(mesh.point(v).norm(), 2.0, 1e-15);
    }
    EXPECT_GE(quality(icosahedral_sphere(5)).min_angle, 53.0 * degree);
    EXPECT_GE(quality(octahedral_sphere(5)).min_angle, 44.0 * degree);
    expect_second_order([](int levels) { return area(icosahedral_sphere(levels)) - 4.0 * kPi; }, {2, 3, 4, 5});
    expect_second_order([](int levels) { return area(octahedral_sphere(levels)) - 4.0 * kPi; }, {3, 4, 5});
    const Mesh octahedron = octahedral_sphere(0);
    EXPECT_EQ(octahedron.face_count(), 8);
    EXPECT_EQ(octahedron.point(4), Eigen::Vector3d(0, 0, 1));
    EXPECT_EQ(octahedral_sphere(3).point(4), Eigen::Vector3d(0, 0, 1));
    EXPECT_THROW(icosahedral_sphere(-1), Error);
    EXPECT_THROW(octahedral_sphere(12), Error);
    EXPECT_THROW(octahedral_sphere(1, 0.0), Error);
}

TEST(Torus, AreaAndVolume) {
    for (const Cells cells : {Cells::triangles, Cells::quads}) {
        EXPECT_TRUE(diagnose(torus(2, 0.7, 12, 8, cells)).empty());
        expect_second_order([&](int n) { return area(torus(2, 0.7, 2 * n, n, cells)) - 4.0 * kPi * kPi * 2 * 0.7; },
                            {10, 20, 40});
        expect_second_order([&](int n) { return volume(torus(2, 0.7, 2 * n, n, cells)) - 2.0 * kPi * kPi * 2 * 0.49; },
                            {10, 20, 40});
    }
    EXPECT_THROW(torus(1, 1, 10, 10), Error);
    EXPECT_THROW(torus(2, 1, 2, 10), Error);
}

TEST(Cylinder, AreaAndNormals) {
    for (const Cells cells : {Cells::triangles, Cells::quads}) {
        const Mesh mesh = cylinder(2, 3, 20, 6, cells);
        EXPECT_TRUE(diagnose(mesh).empty());
        EXPECT_NEAR(area(mesh), 20 * 2 * 2 * std::sin(kPi / 20) * 3, 1e-12);
        for (int f = 0; f < mesh.face_count(); ++f) {
            EXPECT_GT(face_vector_area(mesh, f).head<2>().dot(mesh.point(mesh.faces[f][0]).head<2>()), 0.0);
        }
    }
    EXPECT_THROW(cylinder(0, 1, 5, 5), Error);
}

TEST(DoubleTorus, LiesOnItsSurface) {
    for (const double h : {0.25, 0.1, 0.05}) {
        SCOPED_TRACE(h);
        const Mesh mesh = double_torus(h, 2.0);
        EXPECT_TRUE(diagnose(mesh).empty());
        EXPECT_EQ(topology(mesh).genus, 2);
        EXPECT_GT(volume(mesh), 0.0);
        const MeshQuality shape = quality(mesh);
        EXPECT_GE(shape.min_angle, 20.0 * degree);
        EXPECT_NEAR(shape.mean_edge, 2.0 * h, 0.2 * h);
        for (int v = 0; v < mesh.vertex_count(); ++v) {
            const Eigen::Vector3d p = 0.5 * mesh.point(v);
            const auto hole = [&](double x) { return 1.0 - 0.16 / (std::pow(p.x() - x, 2) + p.y() * p.y()); };
            const double ellipse = 1.0 - p.x() * p.x() / 4.0 - p.y() * p.y() / 1.44;
            EXPECT_NEAR(p.z() * p.z(), 0.25 * ellipse * hole(0.85) * hole(-0.85), 1e-12);
        }
    }
    EXPECT_NEAR(volume(double_torus(0.05)), volume(double_torus(0.1)), 0.02 * volume(double_torus(0.1)));
    EXPECT_THROW(double_torus(0.5), Error);
    EXPECT_THROW(double_torus(0.1, -1), Error);
}

TEST(Jitter, NeverFlipsAndStaysOnTheBoundary) {
    for (const double amplitude : {0.1, 0.3, 0.5}) {
        for (const std::uint64_t seed : {1u, 2u, 3u}) {
            const JitterOptions jitter{.amplitude = amplitude, .seed = seed};
            const Mesh round = disk(15, 2.0, jitter), regular = disk(15, 2.0);
            EXPECT_EQ(round.faces, regular.faces);
            EXPECT_GT(smallest_signed_area(round), 0.0);
            EXPECT_NE(round.positions.row(5), regular.positions.row(5));
            int moved = 0;
            for (int v = round.vertex_count() - 90; v < round.vertex_count(); ++v) {
                EXPECT_NEAR(round.point(v).norm(), 2.0, 1e-15);
                moved += round.point(v) != regular.point(v);
            }
            EXPECT_GT(moved, 80);
            EXPECT_GT(smallest_signed_area(annulus(0.2, 1, 30, 0, jitter)), 0.0);
            for (const Cells cells : {Cells::triangles, Cells::quads}) {
                const Mesh grid = rectangle(1, 1, 12, 12, cells), shaken = jittered(grid, jitter);
                EXPECT_GT(smallest_signed_area(shaken), 0.0);
                EXPECT_NEAR(area(shaken), 1.0, 1e-13);
                const Topology topo = topology(grid);
                for (const int v : topo.boundary_loops[0]) EXPECT_EQ(shaken.point(v), grid.point(v));
                for (int f = 0; f < shaken.face_count(); ++f) {  // quads stay convex
                    const std::span<const int> c = shaken.faces[f];
                    for (std::size_t i = 0; i < c.size(); ++i) {
                        const Eigen::Vector3d a = shaken.point(c[i]), b = shaken.point(c[(i + 1) % c.size()]),
                                              d = shaken.point(c[(i + 2) % c.size()]);
                        EXPECT_GT((b - a).cross(d - b).z(), 0.0);
                    }
                }
            }
        }
    }
}

TEST(Jitter, SeedDecides) {
    EXPECT_EQ(disk(6, 1.0, {0.3, 9}).positions, disk(6, 1.0, {0.3, 9}).positions);
    EXPECT_NE(disk(6, 1.0, {0.3, 9}).positions, disk(6, 1.0, {0.3, 10}).positions);
    EXPECT_EQ(disk(6, 1.0, {0.0, 9}).positions, disk(6).positions);
    // Published first numbers of SplitMix64 for the seed 1234567.
    Random random(1234567);
    EXPECT_EQ(random.next(), 6457827717110365317u);
    EXPECT_EQ(random.next(), 3203168211198807973u);
}

TEST(Quality, KnownShapes) {
    Mesh mesh;
    mesh.positions.resize(3, 2);
    mesh.positions << 0, 0, 3, 0, 0, 4;
    mesh.faces.add({0, 1, 2});
    const MeshQuality q = quality(mesh);
    EXPECT_NEAR(q.min_angle, std::atan(0.75), 1e-15);
    EXPECT_NEAR(q.max_angle, kPi / 2, 1e-15);
    EXPECT_EQ(q.min_edge, 3.0);
    EXPECT_EQ(q.max_edge, 5.0);
    EXPECT_NEAR(q.mean_edge, 4.0, 1e-15);
    EXPECT_NEAR(q.max_aspect, 5.0 / 3.0, 1e-15);
    EXPECT_EQ(q.ears, 1);
    EXPECT_EQ(quality(rectangle(2, 1, 4, 4, Cells::quads)).min_angle, kPi / 2);
    EXPECT_EQ(quality(Mesh{}).face_count, 0);
}

}  // namespace
}  // namespace beltrami
