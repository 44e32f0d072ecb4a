#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <beltrami/base/constants.h>
#include <beltrami/base/error.h>
#include <beltrami/homotopy/homotopy.h>
#include <beltrami/meshing/planar_domains.h>
#include <beltrami/plane/inside_polygon.h>
#include <beltrami/solve/beltrami_solver.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

constexpr double kInner = 0.05;

/// z|z|^{κ−1} e^{is log|z|}: turned by `angle` at |z| = kInner against |z| = 1.
Complex turned(Complex z, double kappa, double angle) {
    const double r = std::abs(z);
    return z * std::pow(r, kappa - 1) * std::polar(1.0, angle / std::log(kInner) * std::log(r));
}

Eigen::VectorXcd images(const Eigen::VectorXcd& z, const std::function<Complex(Complex)>& f) {
    Eigen::VectorXcd result(z.size());
    for (Eigen::Index v = 0; v < z.size(); ++v) result[v] = f(z[v]);
    return result;
}

TEST(PointInside, IsInsideWhereTheCentreOfAreaIsNot) {
    const std::vector<Complex> square{{10, 10}, {12, 10}, {12, 12}, {10, 12}};
    EXPECT_NEAR(std::abs(point_inside(square) - Complex(11, 11)), 0, 1e-14);
    const std::vector<Complex> horseshoe{{0, 0}, {4, 0}, {4, 5}, {3, 5}, {3, 1}, {1, 1}, {1, 5}, {0, 5}};
    EXPECT_EQ(winding_number(horseshoe, {2, 3}), 0);
    EXPECT_EQ(winding_number(horseshoe, point_inside(horseshoe)), 1);
    const std::vector<Complex> clockwise(horseshoe.rbegin(), horseshoe.rend());
    EXPECT_EQ(winding_number(clockwise, point_inside(clockwise)), -1);
    EXPECT_EQ(point_inside({{1, 2}, {1, 2}, {1, 2}}), Complex(1, 2));  // a loop collapsed to a point
    EXPECT_NEAR(turning_angle({{1, 0}, {0, 1}, {-1, 0}, {0, -1}}, 0), 1.5 * std::numbers::pi, 1e-15);
}

TEST(LoopPaths, AreRadialInAConcentricAnnulus) {
    for (const double amount : {0.0, 0.2}) {
        JitterOptions jitter;
        jitter.amplitude = amount;
        const Mesh mesh = annulus(kInner, 1, 48, 0, jitter);
        const Surface surface(mesh);
        const Eigen::VectorXcd z = test::complex_positions(mesh);
        const auto paths = loop_paths(surface, z, 0);
        ASSERT_EQ(paths.size(), 1u);
        EXPECT_EQ(paths[0].loop, 1);
        const auto& path = paths[0].vertices;
        EXPECT_NEAR(std::abs(z[path.front()]), 1, 1e-12);
        EXPECT_NEAR(std::abs(z[path.back()]), kInner, 1e-12);
        for (std::size_t i = 0; i < path.size(); ++i) {
            EXPECT_LT(std::abs(std::arg(z[path[i]] / z[path[0]])), 1.5 * kTurn / 48);
            EXPECT_EQ(surface.topology.on_boundary[path[i]] != 0, i == 0 || i + 1 == path.size());
        }
    }
}

TEST(LoopPaths, GoRoundAHoleThatStandsBefore) {
    // The small hole lies inside the horseshoe of the other one, which hides the outer loop except through its mouth.
    const Polygon outer{{-4, -4}, {8, -4}, {8, 4}, {-4, 4}};
    const Polygon horseshoe{{-3, -3}, {5, -3}, {5, -2}, {-2, -2}, {-2, 2}, {5, 2}, {5, 3}, {-3, 3}};
    const Polygon small{{-1, -0.5}, {0, -0.5}, {0, 0.5}, {-1, 0.5}};
    DomainOptions options;
    options.edge_length = 0.5;
    const Mesh mesh = polygon_domain(outer, {horseshoe, small}, options);
    const Surface surface(mesh);
    const Eigen::VectorXcd z = test::complex_positions(mesh);
    for (const LoopPath& path : loop_paths(surface, z, 0)) {
        double length = 0;
        for (std::size_t i = 1; i < path.vertices.size(); ++i) {
            length += std::abs(z[path.vertices[i]] - z[path.vertices[i - 1]]);
            EXPECT_EQ(surface.topology.on_boundary[path.vertices[i]] != 0, i + 1 == path.vertices.size());
        }
        const bool is_small = std::abs(z[path.vertices.back()]) < 1.9;
        EXPECT_GT(length, is_small ? 7.9 : 0.99);
        EXPECT_LT(length, is_small ? 11 : 1.5);
    }
}

TEST(HomotopyClass, CountsTheTurnsOfTheClosedForm) {
    const Mesh mesh = annulus(kInner, 1, 96, 106);
    const Surface surface(mesh);
    const Eigen::VectorXcd z = test::complex_positions(mesh);
    const auto paths = loop_paths(surface, z, 0);
    for (const int turns : {0, 1, -1, 2})
        for (const double smallest : {0.0, 0.4, -2.0, 3.1}) {
            const double angle = kTurn * turns + smallest;
            const HomotopyClass found =
                homotopy_class(surface, paths, images(z, [&](Complex p) { return 3.0 + turned(p, 0.9, angle); }));
            ASSERT_EQ(found.holes.size(), 1u);
            EXPECT_EQ(found.holes[0].turns, turns);
            EXPECT_NEAR(found.holes[0].angle, angle, 1e-9);
            EXPECT_TRUE(found.holes[0].meaningful);
            EXPECT_EQ(found.holes[0].outer_vertex, paths[0].vertices.front());
            EXPECT_EQ(found.holes[0].hole_vertex, paths[0].vertices.back());
            EXPECT_TRUE(found.same_turns(found));
        }
}

TEST(HomotopyClass, DoesNotDependOnRotationScaleOrNumbering) {
    const Mesh mesh = annulus(kInner, 1, 64, 64);
    const Eigen::VectorXcd z = test::complex_positions(mesh);
    const Eigen::VectorXcd f = images(z, [&](Complex p) { return turned(p, 1.2, kTurn + 0.7); });
    Mesh other;  // numbered backwards, turned, scaled and moved
    const int n = mesh.vertex_count();
    const Complex a = std::polar(1e3, 0.37), b(1e4, -2e4);
    other.positions.resize(n, 2);
    Eigen::VectorXcd g(n);
    for (int v = 0; v < n; ++v) {
        const Complex w = a * z[v] + b;
        other.positions.row(n - 1 - v) << w.real(), w.imag();
        g[n - 1 - v] = std::polar(1e-3, 2.0) * f[v];
    }
    for (int face = 0; face < mesh.face_count(); ++face) {
        const auto v = mesh.faces[face];
        other.faces.add({n - 1 - v[0], n - 1 - v[1], n - 1 - v[2]});
    }
    const HomotopyClass one = homotopy_class(Surface(mesh), z, f),
                        two = homotopy_class(Surface(other), test::complex_positions(other), g);
    EXPECT_EQ(one.holes[0].turns, 1);
    EXPECT_TRUE(one.same_turns(two));
    EXPECT_NEAR(one.holes[0].angle, two.holes[0].angle, 1e-6);
}

TEST(HomotopyClass, IsMeaninglessWhereThePathIsFolded) {
    // One vertex of the path is pulled over to the other side of the hole.
    const Mesh mesh = annulus(0.2, 1, 48, 12);
    const Surface surface(mesh);
    const Eigen::VectorXcd z = test::complex_positions(mesh);
    const auto paths = loop_paths(surface, z, 0);
    Eigen::VectorXcd f = z;
    EXPECT_TRUE(homotopy_class(surface, paths, f).holes[0].meaningful);
    f[paths[0].vertices[4]] *= -0.5;
    EXPECT_FALSE(homotopy_class(surface, paths, f).holes[0].meaningful);
}

TEST(HomotopyClass, DisksHaveNoHolesAndHandlesAreRefused) {
    const Mesh round = disk(4);
    const Surface surface(round);
    EXPECT_TRUE(homotopy_class(surface, test::complex_positions(round), test::complex_positions(round)).holes.empty());
    EXPECT_THROW(loop_paths(surface, test::complex_positions(round), 1), Error);
}

}  // namespace
}  // namespace beltrami
