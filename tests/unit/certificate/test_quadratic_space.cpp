#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include <beltrami/certificate/edge_split.h>
#include <beltrami/certificate/quadratic_space.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

/// Five triangles around an apex.
Surface pyramid(double height) {
    Mesh mesh;
    mesh.positions.resize(6, 3);
    mesh.positions.row(0) << 0.1, -0.05, height;
    for (int i = 0; i < 5; ++i) {
        const double t = 2 * std::numbers::pi * i / 5 + 0.1 * std::sin(3.0 * i), r = 1 + 0.2 * std::cos(2.0 * i);
        mesh.positions.row(1 + i) << r * std::cos(t), r * std::sin(t), 0;
    }
    for (int i = 0; i < 5; ++i) mesh.faces.add({0, 1 + i, 1 + (i + 1) % 5});
    return Surface(mesh);
}

/// The base as it lies, a little bent: nodes of a map that is one-to-one.
QuadraticMap shaken(const Surface& surface, double amount) {
    Eigen::VectorXcd flat(surface.mesh.vertex_count());
    for (int v = 0; v < flat.size(); ++v)
        flat[v] = Complex(1.3 * surface.mesh.positions(v, 0), surface.mesh.positions(v, 1));
    QuadraticMap map = straight(surface, flat);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(-amount, amount);
    for (Eigen::Index n = 0; n < map.size(); ++n) map[n] += Complex(uniform(random), uniform(random));
    return map;
}

/// μ of value() at a place inside a face, by differences.
Complex difference_quotient(const Surface& surface, const QuadraticSpace& space, const QuadraticMap& map, int face,
                            const std::array<double, 3>& place) {
    const auto g = surface.operators.gradient(face);
    constexpr double h = 1e-5;
    const auto at = [&](Complex step) {
        std::array<double, 3> moved{};
        for (int i = 0; i < 3; ++i) moved[i] = place[i] + std::real(std::conj(g[i]) * step);
        return space.value(map, face, moved);
    };
    const Complex x = (at(h) - at(-h)) / (2 * h), y = (at(Complex(0, h)) - at(Complex(0, -h))) / (2 * h), i(0, 1);
    return (x + i * y) / (x - i * y);
}

TEST(QuadraticSpace, PowerElementsHaveTheirDerivatives) {
    const Surface surface = pyramid(0.6);
    const std::vector<ConePoint> cones = cone_points(surface);
    ASSERT_EQ(cones.size(), 1u);
    EXPECT_EQ(cones[0].vertex, 0);
    EXPECT_GT(cones[0].stretch, 1.1);
    const QuadraticSpace space(surface, {0});
    const QuadraticMap map = shaken(surface, 0.02);
    for (int f = 0; f < 5; ++f) {
        EXPECT_NEAR(space.power(f), cones[0].stretch, 1e-12);
        for (int q = 1; q < 6; ++q) {  // the ray through s = q/6, at .6 of the way
            const double s = q / 6.0;
            const auto [dz, dzbar] = space.samples().derivatives(space.first_sample(f) + q, map);
            const Complex found = difference_quotient(surface, space, map, f, {0.4, 0.6 * (1 - s), 0.6 * s});
            EXPECT_LT(std::abs(dzbar / dz - found), 1e-8);
        }
    }
    // They are continuous across the edges at the apex, where f_edge has the same end.
    EXPECT_LT(std::abs(space.value(map, 0, {0.3, 0, 0.7}) - space.value(map, 1, {0.3, 0.7, 0})), 1e-14);
}

TEST(QuadraticSpace, BoundsHoldEverywhereAndAreClose) {
    for (const bool cone : {false, true}) {
        const Surface surface = pyramid(cone ? 0.6 : 0.0);
        const QuadraticSpace space(surface, cone ? std::vector<int>{0} : std::vector<int>{});
        const QuadraticMap map = shaken(surface, 0.02);
        const std::vector<double> bounds = space.bounds(map);
        const double largest = *std::max_element(bounds.begin(), bounds.end());
        ASSERT_LT(largest, 1);
        double attained = 0;
        for (int f = 0; f < 5; ++f)
            for (int i = 1; i < 60; ++i)
                for (int j = 1; i + j < 60; ++j) {
                    const double mu =
                        std::abs(difference_quotient(surface, space, map, f, {1 - (i + j) / 60.0, i / 60.0, j / 60.0}));
                    EXPECT_LE(mu, bounds[f] + 1e-7);
                    attained = std::max(attained, mu);
                }
        EXPECT_LT(largest, attained + 0.02);
    }
}

TEST(QuadraticSpace, FoldsAreNotBounded) {
    const Surface surface(disk(2));
    QuadraticMap map = straight(surface, test::complex_positions(surface.mesh));
    const QuadraticSpace space(surface, {});
    for (const double bound : space.bounds(map)) EXPECT_LT(bound, 1e-7);
    map[0] = 0.9;  // over the rim of its star
    const std::vector<double> bounds = space.bounds(map);
    EXPECT_GE(*std::max_element(bounds.begin(), bounds.end()), 1);
}

TEST(EdgeSplit, IsTheSameSurfaceWithTheSameValues) {
    const Surface surface(test::bump(100));
    const BoundaryCondition boundary = test::boundary_values(surface, [](Complex z) { return z + 0.1 * z * z; });
    std::vector<char> marked(surface.topology.edge_count(), 0);
    for (std::size_t e = 0; e < marked.size(); ++e) marked[e] = e % 3 != 0;
    const SplitEdges fine = split_edges(surface, boundary, marked);
    EXPECT_NEAR(fine.surface.operators.area(), surface.operators.area(), 1e-12);
    EXPECT_EQ(fine.surface.topology.boundary_loops.size(), 1u);
    EXPECT_TRUE(unprescribed_boundary(fine.boundary, fine.surface).empty());
    for (int f = 0; f < fine.surface.mesh.face_count(); ++f)
        for (int c = 0; c < 3; ++c) {
            Eigen::Vector3d at = Eigen::Vector3d::Zero();
            for (int i = 0; i < 3; ++i)
                at += fine.places[3 * f + c][i] * surface.mesh.point(surface.mesh.faces[fine.parents[f]][i]);
            EXPECT_LT((at - fine.surface.mesh.point(fine.surface.mesh.faces[f][c])).norm(), 1e-14);
        }
    // Values are linear along the old edges.
    const Eigen::VectorXcd before = prescribed_values(boundary, surface),
                           after = prescribed_values(fine.boundary, fine.surface);
    int next = surface.mesh.vertex_count();
    for (int e = 0; e < surface.topology.edge_count(); ++e) {
        if (!marked[e]) continue;
        const auto [a, b] = surface.topology.edges[e];
        if (surface.topology.edge_faces[e][0] < 0 || surface.topology.edge_faces[e][1] < 0) {
            EXPECT_LT(std::abs(after[next] - 0.5 * (before[a] + before[b])), 1e-15);
        }
        ++next;
    }
}

}  // namespace
}  // namespace beltrami
