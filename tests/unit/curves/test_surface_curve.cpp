#include <beltrami/curves/surface_curve.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <beltrami/base/error.h>
#include <beltrami/generate/grids.h>
#include <beltrami/generate/sphere.h>
#include <beltrami/locate/surface_locator.h>
#include <beltrami/mesh/topology.h>

#include "support/cause_of.h"

namespace beltrami {
namespace {

int nearest_vertex_to(const Mesh& mesh, const Eigen::Vector3d& point) {
    int best = 0;
    for (int v = 1; v < mesh.vertex_count(); ++v)
        if ((mesh.point(v) - point).norm() < (mesh.point(best) - point).norm()) best = v;
    return best;
}

MeshPoint at_vertex(const Mesh& mesh, int vertex) {
    for (int f = 0; f < mesh.face_count(); ++f)
        for (std::size_t i = 0; i < mesh.faces[f].size(); ++i)
            if (mesh.faces[f][i] == vertex) {
                const auto v = mesh.faces[f];
                return {f, {v[i], v[(i + 1) % v.size()], v[(i + v.size() - 1) % v.size()]}, {1, 0, 0}};
            }
    return {};
}

CurveThrough through(const Mesh& mesh, const std::vector<Eigen::Vector3d>& points, bool closed = false) {
    CurveThrough curve{{}, closed};
    for (const Eigen::Vector3d& point : points) curve.points.push_back(at_vertex(mesh, nearest_vertex_to(mesh, point)));
    return curve;
}

double area(const Mesh& mesh) {
    double sum = 0;
    for (int f = 0; f < mesh.face_count(); ++f) sum += face_vector_area(mesh, f).norm();
    return sum;
}

/// The mesh is the same surface, its faces have an area, and every curve runs along edges.
void expect_sound(const Mesh& mesh, const MeshWithCurves& found) {
    EXPECT_NEAR(area(found.mesh), area(mesh), 1e-12 * area(mesh));
    const Topology before = topology(mesh), after = topology(found.mesh);
    EXPECT_EQ(after.euler_characteristic, before.euler_characteristic);
    EXPECT_EQ(after.boundary_loops.size(), before.boundary_loops.size());
    EXPECT_EQ(static_cast<int>(found.faces.size()), found.mesh.face_count());
    for (int f = 0; f < found.mesh.face_count(); ++f) EXPECT_GT(face_vector_area(found.mesh, f).norm(), 1e-12);
    const std::set<std::array<int, 2>> edges(after.edges.begin(), after.edges.end());
    for (const MeshWithCurves::Chain& curve : found.curves) {
        const std::size_t n = curve.vertices.size();
        for (std::size_t i = 0; i + (curve.closed ? 0 : 1) < n; ++i) {
            const int a = curve.vertices[i], b = curve.vertices[(i + 1) % n];
            EXPECT_TRUE(edges.count({std::min(a, b), std::max(a, b)})) << a << " " << b;
        }
    }
    for (const MeshWithCurves::Chain& curve : found.curves) {  // no edge bridges a curve
        std::map<int, int> at;
        for (std::size_t i = 0; i < curve.vertices.size(); ++i) at[curve.vertices[i]] = static_cast<int>(i);
        const int n = static_cast<int>(curve.vertices.size());
        for (const auto& [a, b] : after.edges) {
            if (at.count(a) == 0 || at.count(b) == 0) continue;
            const int apart = std::abs(at[a] - at[b]);
            EXPECT_TRUE(apart == 1 || (curve.closed && apart == n - 1)) << a << " " << b;
        }
    }
    for (std::size_t i = 0; i < found.places.size(); ++i) {
        const MeshPoint& place = found.places[i];
        Eigen::Vector3d point = Eigen::Vector3d::Zero();
        for (int j = 0; j < 3; ++j) point += place.barycentric[j] * mesh.point(place.vertices[j]);
        EXPECT_LT((point - found.mesh.point(mesh.vertex_count() + static_cast<int>(i))).norm(), 1e-12);
    }
}

TEST(MeshWithCurves, GeodesicsOfThePlaneAreStraight) {
    const Mesh mesh = rectangle(2, 1, 11, 7);
    for (const auto& [a, b] : {std::array<Eigen::Vector3d, 2>{{{0, 0, 0}, {2, 1, 0}}},
                               std::array<Eigen::Vector3d, 2>{{{0.2, 0.9, 0}, {1.7, 0.1, 0}}},
                               std::array<Eigen::Vector3d, 2>{{{0, 0.5, 0}, {2, 0.5, 0}}}}) {
        const CurveThrough curve = through(mesh, {a, b});
        const MeshWithCurves found = mesh_with_curves(mesh, std::array{curve});
        expect_sound(mesh, found);
        const MeshWithCurves::Chain& chain = found.curves[0];
        const Eigen::Vector3d first = found.mesh.point(chain.vertices.front()),
                              last = found.mesh.point(chain.vertices.back());
        EXPECT_NEAR(chain.length, (last - first).norm(), 1e-12);
        for (const int v : chain.vertices)
            EXPECT_LT((last - first).normalized().cross(found.mesh.point(v) - first).norm(), 1e-12);
    }
}

TEST(MeshWithCurves, GeodesicsOfADevelopableSurfaceAreStraightOnceItIsUnrolled) {
    // The polyhedral cylinder has n flat sides.
    const int n = 24;
    const Mesh mesh = cylinder(1, 2, n, 9);
    const double side = 2 * std::sin(std::numbers::pi / n);
    const auto on_side = [&](int i, double z) {
        const double angle = 2 * std::numbers::pi * i / n;
        return Eigen::Vector3d(std::cos(angle), std::sin(angle), z);
    };
    double low = 1e9, high = -1e9;
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        low = std::min(low, mesh.point(v).z());
        high = std::max(high, mesh.point(v).z());
    }
    const CurveThrough curve = through(mesh, {on_side(0, low), on_side(7, high)});
    const MeshWithCurves found = mesh_with_curves(mesh, std::array{curve});
    expect_sound(mesh, found);
    const Eigen::Vector3d a = found.mesh.point(found.curves[0].vertices.front()),
                          b = found.mesh.point(found.curves[0].vertices.back());
    const double angle = std::remainder(std::atan2(b.y(), b.x()) - std::atan2(a.y(), a.x()), 2 * std::numbers::pi);
    const double sides = std::abs(std::round(angle * n / (2 * std::numbers::pi)));
    EXPECT_EQ(sides, 7);
    EXPECT_NEAR(found.curves[0].length, std::hypot(sides * side, high - low), 1e-12);
}

TEST(MeshWithCurves, GeodesicsOfTheSphereTendToGreatCircles) {
    double last = 1;
    for (const int levels : {2, 3, 4}) {
        const Mesh mesh = icosahedral_sphere(levels);
        const CurveThrough curve = through(mesh, {{1, 0.1, 0.2}, {-0.3, 1, -0.4}});
        const MeshWithCurves found = mesh_with_curves(mesh, std::array{curve});
        expect_sound(mesh, found);
        const Eigen::Vector3d a = found.mesh.point(found.curves[0].vertices.front()),
                              b = found.mesh.point(found.curves[0].vertices.back());
        const Eigen::Vector3d normal = a.cross(b).normalized();
        double off = std::abs(found.curves[0].length - std::atan2(a.cross(b).norm(), a.dot(b)));
        EXPECT_LT(off, 0.3 * last);
        last = off;
        for (const int v : found.curves[0].vertices) EXPECT_LT(std::abs(normal.dot(found.mesh.point(v))), 0.05);
    }
    EXPECT_LT(last, 3e-3);
}

TEST(MeshWithCurves, SeveralCurvesAndClosedOnesWithPointsInsideFaces) {
    const Mesh mesh = icosahedral_sphere(3);
    CurveThrough ring = through(mesh, {{1, 0, 0.6}, {0, 1, 0.6}, {-1, 0, 0.6}, {0, -1, 0.6}}, true),
                 arc = through(mesh, {{1, 0, -0.5}, {0, 1, -0.6}});
    const auto v = mesh.faces[100];
    arc.points.push_back({100, {v[0], v[1], v[2]}, {0.5, 0.3, 0.2}});
    if (mesh.point(v[0]).z() > 0.2) arc.points.pop_back();
    const MeshWithCurves found = mesh_with_curves(mesh, std::array{ring, arc});
    expect_sound(mesh, found);
    EXPECT_TRUE(found.curves[0].closed);
    EXPECT_EQ(found.curves[0].given.size(), 4U);
    // Quads that are crossed become triangles, others stay.
    const Mesh quads = rectangle(1, 1, 8, 8, Cells::quads);
    const MeshWithCurves on_quads = mesh_with_curves(quads, std::array{through(quads, {{0.1, 0.2, 0}, {0.9, 0.6, 0}})});
    expect_sound(quads, on_quads);
    EXPECT_EQ(on_quads.mesh.faces.degree(on_quads.mesh.face_count() - 1), 4);
}

TEST(MeshWithCurves, EdgesThatBridgeACurveAreDivided) {
    // A hairpin whose legs lie one cell apart, along edges and across faces.
    for (const Cells cells : {Cells::triangles, Cells::quads})
        for (const double slant : {0.0, 0.1}) {
            const Mesh mesh = rectangle(1, 1, 10, 10, cells);
            const CurveThrough hairpin =
                through(mesh, {{0.1, 0.3, 0}, {0.8, 0.3 + slant, 0}, {0.8, 0.4 + slant, 0}, {0.1, 0.4, 0}});
            const MeshWithCurves found = mesh_with_curves(mesh, std::array{hairpin});
            expect_sound(mesh, found);
            // Middles of bridges are new vertices on no curve.
            const auto& chain = found.curves[0].vertices;
            int middles = 0;
            for (int v = mesh.vertex_count(); v < found.mesh.vertex_count(); ++v)
                middles += std::find(chain.begin(), chain.end(), v) == chain.end();
            EXPECT_GT(middles, slant > 0 ? 0 : 4);
        }
}

TEST(MeshWithCurves, RefusesWhatCannotBe) {
    const Mesh mesh = rectangle(1, 1, 10, 10);
    const CurveThrough one = through(mesh, {{0.1, 0.1, 0}, {0.9, 0.8, 0}}),
                       crossing = through(mesh, {{0.1, 0.8, 0}, {0.9, 0.1, 0}});
    const auto cause = [&](const std::vector<CurveThrough>& curves) {
        return test::cause_of([&] { mesh_with_curves(mesh, curves); });
    };
    EXPECT_EQ(cause({one, crossing}), Cause::bad_boundary);
    EXPECT_EQ(cause({one, one}), Cause::bad_boundary);
    EXPECT_EQ(cause({through(mesh, {{0.1, 0.1, 0}})}), Cause::bad_boundary);
    EXPECT_EQ(cause({through(mesh, {{0.1, 0.1, 0}, {0.1, 0.1, 0}})}), Cause::bad_boundary);
    EXPECT_EQ(cause({through(mesh, {{0.1, 0.1, 0}, {0.9, 0.1, 0}, {0.1, 0.1, 0}})}), Cause::bad_boundary);
    EXPECT_EQ(cause({through(mesh, {{0.1, 0.1, 0}, {0.9, 0.8, 0}, {0.1, 0.8, 0}, {0.9, 0.1, 0}})}),
              Cause::bad_boundary);
    CurveThrough nowhere = one;
    nowhere.points[0].vertices[0] = 5000;
    EXPECT_EQ(cause({nowhere}), Cause::bad_boundary);
}

}  // namespace
}  // namespace beltrami
