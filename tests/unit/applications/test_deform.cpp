#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include <beltrami/applications/deform.h>
#include <beltrami/applications/handled_surface.h>
#include <beltrami/generate/grids.h>
#include <beltrami/generate/sphere.h>
#include <beltrami/mesh/submesh.h>

#include "support/cause_of.h"
#include "support/meshes.h"

namespace beltrami {
namespace {

constexpr double kPi = std::numbers::pi;

/// A torus of revolution without a disk on its outer equator.
Mesh punctured_torus(int around, int across) {
    const Mesh whole = torus(2, 1, around, across);
    std::vector<int> kept;
    for (int f = 0; f < whole.face_count(); ++f) {
        Eigen::Vector3d middle = Eigen::Vector3d::Zero();
        for (const int v : whole.faces[f]) middle += whole.point(v) / 3;
        if ((middle - Eigen::Vector3d(-3, 0, 0)).norm() > 0.85) kept.push_back(f);
    }
    return remove_unreferenced(keep_faces(whole, kept).mesh).mesh;
}

struct Handles {
    std::vector<int> vertices;
    Positions places;
};

/// The boundary loop turned around its axis and moved along it.
Handles turned_loop(const Surface& surface, double angle, double shift) {
    Handles handles{surface.topology.boundary_loops[0], {}};
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (const int v : handles.vertices) centre += surface.mesh.point(v) / static_cast<double>(handles.vertices.size());
    const Eigen::Vector3d axis = centre.cwiseProduct(Eigen::Vector3d(1, 0, 0)).normalized();
    const Eigen::AngleAxisd turn(angle, axis);
    handles.places.resize(static_cast<Eigen::Index>(handles.vertices.size()), 3);
    for (std::size_t i = 0; i < handles.vertices.size(); ++i)
        handles.places.row(static_cast<Eigen::Index>(i)) =
            centre + turn * (surface.mesh.point(handles.vertices[i]) - centre) + shift * axis;
    return handles;
}

TEST(HandledSurface, RigidMotionsOfHandlesMoveTheWholeRigidly) {
    const Surface surface(punctured_torus(24, 12));
    const std::vector<int> handles = surface.topology.boundary_loops[0];
    const Eigen::AngleAxisd turn(0.7, Eigen::Vector3d(1, 2, 3).normalized());
    Positions moved(surface.mesh.vertex_count(), 3), places(static_cast<Eigen::Index>(handles.size()), 3);
    for (int v = 0; v < surface.mesh.vertex_count(); ++v)
        moved.row(v) = turn * surface.mesh.point(v) + Eigen::Vector3d(1, 0, -2);
    for (std::size_t i = 0; i < handles.size(); ++i) places.row(static_cast<Eigen::Index>(i)) = moved.row(handles[i]);
    const HandledSurface handled(surface, handles);
    EXPECT_LT((handled.as_rigid_as_possible(places, moved) - moved).cwiseAbs().maxCoeff(), 1e-9);
    // Translations pass through the thin plate exactly.
    Positions shifted = places;
    for (std::size_t i = 0; i < handles.size(); ++i)
        shifted.row(static_cast<Eigen::Index>(i)) =
            surface.mesh.positions.row(handles[i]) + Eigen::RowVector3d(1, 2, 3);
    const Positions plate = handled.thin_plate(shifted);
    EXPECT_LT(((plate - surface.mesh.positions).rowwise() - Eigen::RowVector3d(1, 2, 3)).cwiseAbs().maxCoeff(), 1e-8);
}

// The thin plate against the equation that it solves: L M⁻¹ L u = 0 away from the handles, here that affine
// displacements of a plane are reproduced.
TEST(HandledSurface, AffineDisplacementsOfAPlaneAreReproduced) {
    Mesh mesh = test::jittered_square(8);
    mesh.positions.conservativeResize(Eigen::NoChange, 3);
    mesh.positions.col(2).setZero();
    const Surface surface(mesh);
    // Two rows of vertices along the border, so that the slope there is given too.
    std::vector<int> handles;
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        const int i = v % 9, j = v / 9;
        if (i < 2 || j < 2 || i > 6 || j > 6) handles.push_back(v);
    }
    Positions exact = mesh.positions;
    exact.col(2) = 0.3 * mesh.positions.col(0) - 0.2 * mesh.positions.col(1);
    Positions places(static_cast<Eigen::Index>(handles.size()), 3);
    for (std::size_t i = 0; i < handles.size(); ++i) places.row(static_cast<Eigen::Index>(i)) = exact.row(handles[i]);
    EXPECT_LT((HandledSurface(surface, handles).thin_plate(places) - exact).cwiseAbs().maxCoeff(), 1e-10);
}

TEST(Deform, ATurnedLoopBecomesNearlyExtremal) {
    const Surface surface(punctured_torus(40, 20));
    const Handles handles = turned_loop(surface, kPi / 3, 0.8);
    DeformSolver solver(surface, handles.vertices);
    const Deformation result = solver.solve(handles.places);
    EXPECT_TRUE(result.folds.empty());
    EXPECT_TRUE(result.distortion.flipped.empty());
    EXPECT_EQ(result.kind, DeformedSurface::thin_plate);
    for (std::size_t i = 0; i < handles.vertices.size(); ++i)
        EXPECT_LT((result.positions.row(handles.vertices[i]) - handles.places.row(static_cast<Eigen::Index>(i))).norm(),
                  1e-9);
    EXPECT_LT(result.distortion.max, 0.6 * result.of_surface.max);
    EXPECT_LT(result.distortion.max, 1.4 * result.distortion.mean);
    EXPECT_LT(result.distortion.standard_deviation, 0.2 * result.distortion.mean);
}

TEST(Deform, HandlesMoveWarm) {
    const Surface surface(punctured_torus(32, 16));
    DeformOptions options;
    options.surface = DeformedSurface::rigid;
    const Handles near = turned_loop(surface, 0.9, 0.5), there = turned_loop(surface, 1.0, 0.5);
    DeformSolver warm(surface, near.vertices, options), cold(surface, near.vertices, options);
    EXPECT_FALSE(warm.solve(near.places).warm);
    const Deformation again = warm.solve(there.places), fresh = cold.solve(there.places);
    EXPECT_TRUE(again.warm);
    EXPECT_FALSE(fresh.warm);
    EXPECT_LT(again.steps, fresh.steps);
    EXPECT_TRUE(again.folds.empty());
    EXPECT_NEAR(again.distortion.max, fresh.distortion.max, 0.1 * fresh.distortion.max);
}

TEST(Deform, OntoAGivenSurface) {
    const Surface surface(icosahedral_sphere(3));
    Mesh ellipsoid = icosahedral_sphere(4);
    ellipsoid.positions.col(2) *= 1.3;
    const MeshTarget target(ellipsoid);
    Handles handles{{0, 1, 2, 3, 4, 5, 6, 7}, Positions(8, 3)};
    for (int i = 0; i < 8; ++i)
        handles.places.row(i) = surface.mesh.positions.row(i).cwiseProduct(Eigen::RowVector3d(1, 1, 1.3));
    DeformSolver solver(surface, handles.vertices);
    const Deformation result = solver.solve_onto(target, handles.places);
    EXPECT_EQ(result.kind, DeformedSurface::given);
    EXPECT_TRUE(result.distortion.flipped.empty());
    EXPECT_LT((positions_of(nearest_points(target, result.positions)) - result.positions).cwiseAbs().maxCoeff(), 1e-12);
    EXPECT_LT(result.distortion.max, 0.3);
}

TEST(Deform, RefusesWhatCannotBe) {
    const Surface surface(punctured_torus(20, 10));
    EXPECT_EQ(test::cause_of([&] { DeformSolver(surface, {}); }), Cause::bad_boundary);
    EXPECT_EQ(test::cause_of([&] { DeformSolver(surface, {-1}); }), Cause::bad_boundary);
    DeformOptions options;
    options.last_power = 1;
    EXPECT_EQ(test::cause_of([&] { DeformSolver(surface, {0}, options); }), Cause::bad_option);
}

}  // namespace
}  // namespace beltrami
