#include <gtest/gtest.h>

#include <cmath>

#include <beltrami/base/constants.h>
#include <beltrami/base/error.h>
#include <beltrami/mesh/diagnosis.h>
#include <beltrami/mesh/topology.h>
#include <beltrami/meshing/quality.h>
#include <beltrami/targets/target_mesh.h>

namespace beltrami {
namespace {

TargetCurve flower(Complex centre, double radius) {
    std::vector<Complex> points;
    for (int i = 0; i < 60; ++i) {
        const double t = 2 * kPi * i / 60;
        points.push_back(centre + std::polar(radius * (1 + 0.25 * std::cos(5 * t)), t));
    }
    return TargetCurve::spline(points);
}

TargetDomain mixed() {
    return target_domain(TargetCurve::polygon({{-3, -2}, {3, -2}, {3, 2}, {0.5, 2}, {0.5, 1.2}, {-3, 2.5}}),
                         {flower({-1.5, 0}, 0.7), TargetCurve::circle({1.5, -0.5}, 0.6),
                          TargetCurve::polygon({{0, -1.5}, {0.4, -1.5}, {0.2, -1}})});
}

double area_of(const Mesh& mesh) {
    double area = 0;
    for (int f = 0; f < mesh.face_count(); ++f) {
        EXPECT_GT(face_vector_area(mesh, f).z(), 0);
        area += face_vector_area(mesh, f).z();
    }
    return area;
}

void expect_on_curves(const TargetMesh& target, const TargetDomain& domain) {
    EXPECT_TRUE(require_sound(target.mesh).empty());
    const Topology topo = topology(target.mesh);
    ASSERT_EQ(topo.boundary_loops.size(), static_cast<std::size_t>(domain.curve_count()));
    EXPECT_EQ(topo.components, 1);
    for (std::size_t l = 0; l < topo.boundary_loops.size(); ++l) {
        const auto& loop = topo.boundary_loops[l];
        const TargetCurve& curve = domain.curve(target.curve_of_loop[l]);
        double around = 0;
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const int v = loop[i], next = loop[(i + 1) % loop.size()];
            EXPECT_EQ(target.curve[v], target.curve_of_loop[l]);
            const Complex z(target.mesh.positions(v, 0), target.mesh.positions(v, 1));
            EXPECT_LT(std::abs(curve.point(target.parameter[v]) - z), 1e-13);
            around += curve.ahead(target.parameter[v], target.parameter[next]);
        }
        EXPECT_NEAR(around, curve.length(), 1e-9);
        // Corners are vertices.
        for (const double s : curve.corners()) {
            bool found = false;
            for (const int v : loop) found |= target.parameter[v] == s;
            EXPECT_TRUE(found);
        }
    }
    for (int v = 0; v < target.mesh.vertex_count(); ++v) EXPECT_EQ(target.curve[v] >= 0, topo.on_boundary[v] == 1);
}

TEST(TargetMesh, FollowsEveryKindOfCurve) {
    const TargetDomain domain = mixed();
    for (const double h : {0.3, 0.1}) {
        const TargetMesh target = target_mesh(domain, {.edge_length = h});
        expect_on_curves(target, domain);
        const MeshQuality shape = quality(target.mesh);
        EXPECT_LT(shape.max_edge, 2 * h);
        EXPECT_GT(shape.min_angle, 0.35);
        EXPECT_EQ(shape.ears, 0);
    }
}

TEST(TargetMesh, AreaConvergesWithOrderTwo) {
    const TargetDomain domain =
        target_domain(TargetCurve::circle(0, 3), {TargetCurve::polygon({{0, 0}, {1, 0}, {0, 1}})});
    double last = 0;
    for (const double h : {0.2, 0.1, 0.05}) {
        const double error = std::abs(
            area_of(target_mesh(domain, {.edge_length = h, .least_edges = 6, .max_turn = 2 * h}).mesh) - domain.area());
        if (last > 0) {
            EXPECT_NEAR(std::log2(last / error), 2, 0.4);
        }
        last = error;
    }
}

TEST(TargetMesh, ResolvesNarrowGaps) {
    // A gap of a thousandth between circles, and two arms of one spline close to each other.
    const TargetDomain rings = target_domain(TargetCurve::circle(0, 1), {TargetCurve::circle(0.299, 0.7)});
    expect_on_curves(target_mesh(rings, {.edge_length = 0.2}), rings);
    const TargetDomain arms =
        target_domain(TargetCurve::spline({{0, 0}, {4, 0}, {4, 1}, {1, 1.3}, {1, 1.35}, {4, 1.6}, {4, 3}, {0, 3}}));
    expect_on_curves(target_mesh(arms, {.edge_length = 1}), arms);
}

TEST(TargetMesh, KeepsToItsOptions) {
    const TargetDomain ring = target_domain(TargetCurve::circle(0, 1), {TargetCurve::circle(0.2, 0.3)});
    const TargetMesh usual = target_mesh(ring);
    EXPECT_GT(usual.mesh.vertex_count(), 2500);
    EXPECT_LT(usual.mesh.vertex_count(), 10000);
    const TargetMesh fine_hole = target_mesh(ring, {.edge_length = 0.2, .hole_edge_length = 0.01});
    const Topology topo = topology(fine_hole.mesh);
    EXPECT_GE(topo.boundary_loops[1].size(), 188u);
    EXPECT_LT(topo.boundary_loops[0].size(), 64u);
    const TargetMesh coarse = target_mesh(ring, {.edge_length = 5});
    for (const auto& loop : topology(coarse.mesh).boundary_loops) EXPECT_GE(loop.size(), 32u);
    for (const TargetMeshOptions& bad :
         {TargetMeshOptions{.edge_length = -1}, TargetMeshOptions{.edge_length = std::nan("")},
          TargetMeshOptions{.hole_edge_length = -1}, TargetMeshOptions{.least_edges = 3},
          TargetMeshOptions{.max_turn = 0}, TargetMeshOptions{.edge_length = 1e-6}})
        EXPECT_THROW(target_mesh(ring, bad), Error);
}

}  // namespace
}  // namespace beltrami
