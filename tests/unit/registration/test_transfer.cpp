// Maps between surfaces at any points, and what they carry.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include <gtest/gtest.h>

#include <beltrami/base/error.h>
#include <beltrami/charts/chart_places.h>
#include <beltrami/curves/surface_curve.h>
#include <beltrami/generate/grids.h>
#include <beltrami/registration/nearest_places.h>
#include <beltrami/registration/overlay.h>
#include <beltrami/registration/register_open.h>
#include <beltrami/registration/register_spheres.h>
#include <beltrami/registration/transfer.h>
#include <beltrami/registration/transferred_polyline.h>

#include "support/cause_of.h"
#include "support/registration.h"

namespace beltrami {
namespace {

using test::bumpy_ball;
using test::landmarks_between;

/// Corners − sides + pieces.
int euler(const Overlay& both) {
    std::set<std::array<int, 2>> sides;
    for (const Overlay::Piece& piece : both.pieces)
        for (std::size_t i = 0; i < piece.corners.size(); ++i) {
            const int a = piece.corners[i], b = piece.corners[(i + 1) % piece.corners.size()];
            sides.insert({std::min(a, b), std::max(a, b)});
        }
    return static_cast<int>(both.corners.size()) - static_cast<int>(sides.size()) +
           static_cast<int>(both.pieces.size());
}

double area(const Mesh& mesh) {
    double sum = 0;
    for (int f = 0; f < mesh.face_count(); ++f) sum += face_vector_area(mesh, f).norm();
    return sum;
}

/// Largest distance of points of a mesh from where they come back to.
double farthest(const Mesh& mesh, std::span<const MeshPoint> from, std::span<const MeshPoint> to) {
    return (positions_on(mesh, from) - positions_on(mesh, to)).rowwise().norm().maxCoeff();
}

std::vector<MeshPoint> some_places(const Mesh& mesh, int stride) {
    std::vector<MeshPoint> places;
    for (int f = 0; f < mesh.face_count(); f += stride) {
        const auto v = mesh.faces[f];
        places.push_back({f, {v[0], v[1], v[2]}, {0.2, 0.3, 0.5}});
    }
    return places;
}

/// Both surfaces are covered, piece by piece, and by the overlay as a mesh.
void expect_covered(const SurfaceCorrespondence& map, int euler_characteristic) {
    const Overlay both = overlay(map);
    Eigen::VectorXd of_source = Eigen::VectorXd::Zero(map.source().face_count()),
                    of_target = Eigen::VectorXd::Zero(map.target().face_count());
    for (const Overlay::Piece& piece : both.pieces) {
        of_source[piece.source_face] += piece.part_of_source;
        of_target[piece.target_face] += piece.part_of_target;
    }
    EXPECT_LT((of_source.array() - 1).abs().maxCoeff(), 1e-9);
    EXPECT_LT((of_target.array() - 1).abs().maxCoeff(), 1e-9);
    EXPECT_EQ(euler(both), euler_characteristic);
    EXPECT_NEAR(area(overlay_mesh(map).mesh), area(map.target()), 1e-9 * area(map.target()));
    EXPECT_NEAR(area(overlay_mesh(map, TransferWay::to_source).mesh), area(map.source()), 1e-9 * area(map.source()));
}

TEST(SurfaceCorrespondence, ComesBackToWhereItBegan) {
    const Surface source(bumpy_ball(3, 0)), target(bumpy_ball(4, 1));
    const SphereRegistration found =
        register_spheres(source, target, landmarks_between(target.mesh, {{0, 0}, {1, 1}, {2, 2}, {3, 3}, {4, 4}}));
    const SurfaceCorrespondence map(source.mesh, target.mesh, found.target_sphere.positions, found.places);
    std::vector<MeshPoint> places;
    for (int f = 0; f < source.mesh.face_count(); f += 5) {
        const auto v = source.mesh.faces[f];
        places.push_back({f, {v[0], v[1], v[2]}, {0.2, 0.3, 0.5}});
    }
    const std::vector<MeshPoint> again = map.back(map.forward(places));
    EXPECT_LT((positions_on(source.mesh, again) - positions_on(source.mesh, places)).rowwise().norm().maxCoeff(), 1e-9);
    // Constants stay, and a vertex that is a landmark keeps its value.
    Positions values(source.mesh.vertex_count(), 2);
    values.col(0).setConstant(3);
    for (int v = 0; v < values.rows(); ++v) values(v, 1) = v;
    const Positions there = transferred_vertex_values(map, values);
    EXPECT_LT((there.col(0).array() - 3).abs().maxCoeff(), 1e-12);
    EXPECT_NEAR(there(3, 1), 3, 1e-6);
    Positions areas = Positions::Ones(target.mesh.face_count(), 1);
    EXPECT_LT((transferred_face_values(map, areas, TransferWay::to_source).array() - 1).abs().maxCoeff(), 1e-12);
    // Exactly: integrals of values over the parts of faces are the same on both sides.
    const Overlay both = overlay(map);
    Eigen::VectorXd of_source = Eigen::VectorXd::Zero(source.mesh.face_count()),
                    of_target = Eigen::VectorXd::Zero(target.mesh.face_count());
    for (const Overlay::Piece& piece : both.pieces) {
        of_source[piece.source_face] += piece.part_of_source;
        of_target[piece.target_face] += piece.part_of_target;
    }
    EXPECT_LT((of_source.array() - 1).abs().maxCoeff(), 1e-9);
    EXPECT_LT((of_target.array() - 1).abs().maxCoeff(), 1e-9);
    Positions numbers(source.mesh.face_count(), 1);
    for (int f = 0; f < numbers.rows(); ++f) numbers(f, 0) = f;
    const Positions means = transferred_face_values(map, numbers);
    double whole = 0, expected = 0;
    for (int f = 0; f < target.mesh.face_count(); ++f) whole += means(f, 0) * face_vector_area(target.mesh, f).norm();
    for (const Overlay::Piece& piece : both.pieces)
        expected += piece.source_face * piece.part_of_target * face_vector_area(target.mesh, piece.target_face).norm();
    EXPECT_NEAR(whole, expected, 1e-9 * expected);
    EXPECT_EQ(test::cause_of([&] { transferred_vertex_values(map, values.topRows(3)); }), Cause::bad_option);
    EXPECT_EQ(test::cause_of([&] { transferred_texture(map); }), Cause::bad_mesh);
    // Places that swap two vertices flip faces.
    std::vector<MeshPoint> swapped = found.places;
    std::swap(swapped[20], swapped[25]);
    EXPECT_EQ(test::cause_of(
                  [&] { SurfaceCorrespondence(source.mesh, target.mesh, found.target_sphere.positions, swapped); }),
              Cause::bad_mesh);
}

/// Distance of a point from a polyline.
double distance_from(const Positions& polyline, const Eigen::RowVector3d& point) {
    double least = std::numeric_limits<double>::infinity();
    for (Eigen::Index i = 0; i + 1 < polyline.rows(); ++i) {
        const Eigen::RowVector3d way = polyline.row(i + 1) - polyline.row(i), off = point - polyline.row(i);
        const double t = std::clamp(off.dot(way) / std::max(way.squaredNorm(), 1e-300), 0.0, 1.0);
        least = std::min(least, (off - t * way).norm());
    }
    return least;
}

TEST(TransferredPolyline, BendsWhereItCrossesEdgesOfEitherSurface) {
    const Surface source(bumpy_ball(3, 0)), target(bumpy_ball(4, 1));
    const SphereRegistration found = register_spheres(source, target, {});
    const SurfaceCorrespondence map(source.mesh, target.mesh, found.target_sphere.positions, found.places);
    const std::vector<MeshPoint> some = some_places(source.mesh, 300);
    const std::vector<MeshPoint> points{some[0], some[1], some[1], place_of_vertex(source.mesh, 70), some[3], some[0]};
    const TransferredPolyline line = transferred_polyline(map, points);
    const Positions there = positions_on(target.mesh, line.places);
    // Given points are met, those inside of the way in its order.
    ASSERT_EQ(line.given.size(), points.size());
    const Positions images = positions_on(target.mesh, map.forward(points));
    for (std::size_t i = 0; i < points.size(); ++i)
        EXPECT_LT((there.row(line.given[i]) - images.row(static_cast<Eigen::Index>(i))).norm(), 1e-12);
    EXPECT_TRUE(std::is_sorted(line.given.begin(), line.given.end()));
    EXPECT_EQ(line.given.back(), static_cast<int>(line.places.size()) - 1);
    // Points in the middle of the geodesics' pieces go to the polyline, and it is no longer than that needs.
    const CurveThrough through{{some[0], some[1], place_of_vertex(source.mesh, 70)}, false};
    const MeshWithCurves with_curve = mesh_with_curves(source.mesh, std::array{through});
    const std::vector<int>& chain = with_curve.curves[0].vertices;
    Positions between(static_cast<Eigen::Index>(5 * (chain.size() - 1)), 3);
    for (Eigen::Index i = 0; i < between.rows(); ++i) {
        const double t = 0.1 + 0.2 * static_cast<double>(i % 5);
        between.row(i) = ((1 - t) * with_curve.mesh.point(chain[static_cast<std::size_t>(i / 5)]) +
                          t * with_curve.mesh.point(chain[static_cast<std::size_t>(i / 5) + 1]))
                             .transpose();
    }
    std::vector<MeshPoint> on_source;
    for (const NearestPlace& nearest : nearest_places(source.mesh, between)) on_source.push_back(nearest.place);
    const Positions straight = positions_on(target.mesh, map.forward(on_source));
    for (const auto& point : straight.rowwise()) EXPECT_LT(distance_from(there, point), 1e-9);
    EXPECT_GT(line.places.size(), chain.size());
    // Back it is where it was.
    const TransferredPolyline back = transferred_polyline(map, line.places, TransferWay::to_source);
    const Positions here = positions_on(source.mesh, map.back(line.places)),
                    again = positions_on(source.mesh, back.places);
    for (const auto& point : again.rowwise()) EXPECT_LT(distance_from(here, point), 1e-9);
    EXPECT_TRUE(transferred_polyline(map, {}).places.empty());
    EXPECT_EQ(transferred_polyline(map, std::span(points).first(1)).places.size(), 1U);
}

TEST(Overlay, OfSurfacesWithoutCommonVerticesIsASphere) {
    const Surface source(bumpy_ball(2, 0)), target(bumpy_ball(3, 1));
    const SphereRegistration found = register_spheres(source, target, {});
    const Overlay both =
        overlay(SurfaceCorrespondence(source.mesh, target.mesh, found.target_sphere.positions, found.places));
    EXPECT_EQ(euler(both), 2);
    EXPECT_GT(both.pieces.size(), 2U * static_cast<std::size_t>(target.mesh.face_count()));
    // Corners are the same points on both.
    const SurfaceCorrespondence map(source.mesh, target.mesh, found.target_sphere.positions, found.places);
    std::vector<MeshPoint> here, there;
    for (const Overlay::Corner& corner : both.corners) {
        here.push_back(corner.on_source);
        there.push_back(corner.on_target);
    }
    EXPECT_LT(
        (positions_on(target.mesh, map.forward(here)) - positions_on(target.mesh, there)).rowwise().norm().maxCoeff(),
        1e-9);
}

TEST(Overlay, OfSurfacesWithCommonVerticesIsASphereToo) {
    const Surface source(bumpy_ball(3, 0)), target(bumpy_ball(3, 1));
    const SphereRegistration found =
        register_spheres(source, target, landmarks_between(target.mesh, {{0, 0}, {1, 1}, {2, 30}, {3, 3}, {4, 4}}));
    expect_covered(SurfaceCorrespondence(source.mesh, target.mesh, found.target_sphere.positions, found.places), 2);
    // All vertices are common, and all edges.
    const SurfaceCorrespondence same(source.mesh, source.mesh, found.source_sphere.positions,
                                     places_of_vertices(source.mesh));
    expect_covered(same, 2);
    EXPECT_EQ(static_cast<int>(overlay(same).pieces.size()), source.mesh.face_count());
}

/// A disk and a ring, of the same meshes and of others, both ways.
TEST(SurfaceCorrespondence, OfSurfacesWithBoundaryIsOneToOne) {
    const Surface sheet(test::raised_sheet(12, 0)), finer(test::raised_sheet(17, 0.1)), tube(cylinder(1, 2, 16, 6)),
        other_tube(cylinder(1.2, 2.1, 23, 9)), quads(cylinder(1.2, 2.1, 23, 9, Cells::quads));
    const auto check = [](const Surface& source, const Surface& target, const OpenRegistration& found, int euler) {
        const SurfaceCorrespondence map(source, target, found.target, found.places);
        expect_covered(map, euler);
        for (const bool back : {false, true}) {
            const Mesh &from = back ? target.mesh : source.mesh, &to = back ? source.mesh : target.mesh;
            const auto go = [&](const std::vector<MeshPoint>& p) { return back ? map.back(p) : map.forward(p); };
            const auto come = [&](const std::vector<MeshPoint>& p) { return back ? map.forward(p) : map.back(p); };
            std::vector<MeshPoint> places = some_places(from, 3);
            EXPECT_LT(farthest(from, places, come(go(places))), 1e-9);
            // Boundary vertices go to the boundary, and come back.
            places.clear();
            for (const auto& loop : (back ? target : source).topology.boundary_loops)
                for (const int v : loop) places.push_back(place_of_vertex(from, v));
            const std::vector<MeshPoint> there = go(places);
            EXPECT_LT(farthest(from, places, come(there)), 1e-9);
            const Surface& of = back ? source : target;
            for (const MeshPoint& place : there)
                for (int i = 0; i < 3; ++i)
                    EXPECT_LT(of.topology.on_boundary[place.vertices[i]] ? 0.0 : place.barycentric[i], 1e-9);
            const Positions ones = Positions::Ones(from.face_count(), 1);
            const TransferWay way = back ? TransferWay::to_source : TransferWay::to_target;
            EXPECT_LT((transferred_face_values(map, ones, way).array() - 1).abs().maxCoeff(), 1e-9);
            EXPECT_EQ(transferred_vertex_values(map, Positions::Ones(from.vertex_count(), 1), way).rows(),
                      to.vertex_count());
        }
    };
    check(sheet, finer, register_open(sheet, finer, landmarks_between(finer.mesh, {{40, 75}, {80, 150}})), 1);
    check(finer, sheet, register_open(finer, sheet, {}), 1);
    check(tube, other_tube, register_open(tube, other_tube, {}), 0);
    check(other_tube, tube, register_open(other_tube, tube, {}), 0);
    // Another loop outside.
    OpenRegistrationOptions inside_out;
    inside_out.outer_loop = inside_out.target_outer_loop = 1;
    check(tube, other_tube, register_open(tube, other_tube, {}, inside_out), 0);
    // Quads are two triangles.
    const OpenRegistration found = register_open(tube, quads, {});
    const SurfaceCorrespondence onto_quads(tube, quads, found.target, found.places);
    EXPECT_EQ(euler(overlay(onto_quads)), 0);
    EXPECT_NEAR(area(overlay_mesh(onto_quads).mesh), area(quads.mesh), 1e-9 * area(quads.mesh));
}

TEST(Overlay, HasTheExactTexture) {
    Mesh textured = test::raised_sheet(9, 0);
    textured.texture.emplace();
    textured.texture->points = textured.positions.leftCols(2);
    textured.texture->corners = textured.faces.vertices();
    const Surface source(textured), target(test::raised_sheet(13, 0.1));
    const OpenRegistration found = register_open(source, target, landmarks_between(target.mesh, {{34, 75}, {70, 150}}));
    const SurfaceCorrespondence map(source, target, found.target, found.places);
    const OverlayMesh both = overlay_mesh(map);
    ASSERT_TRUE(both.mesh.texture);
    const Overlay pieces = overlay(map);
    // The texture is where the points are on the source, whichever face they are seen from.
    for (int f = 0; f < both.mesh.face_count(); ++f)
        for (int i = 0; i < 3; ++i) {
            const MeshPoint& place = pieces.corners[both.mesh.faces[f][i]].on_source;
            const Eigen::RowVector2d point = both.mesh.texture->points.row(both.mesh.texture->corners[3 * f + i]);
            EXPECT_LT((point - positions_on(textured, std::array{place}).leftCols(2)).norm(), 1e-9);
        }
    EXPECT_FALSE(overlay_mesh(map, TransferWay::to_source).mesh.texture);
}

}  // namespace
}  // namespace beltrami
