#include <cmath>

#include <gtest/gtest.h>

#include <beltrami/base/random.h>
#include <beltrami/generate/sphere.h>
#include <beltrami/sphere/unit_sphere.h>
#include <beltrami/unfold/sphere_faces.h>
#include <beltrami/unfold/sphere_repair.h>
#include <beltrami/unfold/sphere_tutte.h>

namespace beltrami {
namespace {

TEST(SphereRepair, LeavesAMapWithoutFlipsAlone) {
    const Surface surface(icosahedral_sphere(2));
    Positions points = surface.mesh.positions;
    const SphereRepair repair = repair_sphere_map(surface, SphereFaces(surface), points);
    EXPECT_EQ(points, surface.mesh.positions);
    EXPECT_TRUE(repair.flipped.empty());
    EXPECT_EQ(repair.averaged + repair.unfolded, 0);
}

TEST(SphereRepair, TurnsFlippedFacesUpAndMovesLittleElse) {
    const Surface surface(icosahedral_sphere(4));
    const SphereFaces faces(surface);
    Positions points = surface.mesh.positions;
    // Vertices pushed over their neighbours at three places, one of them in a region made tiny.
    for (const int v : {100, 900, 2000}) {
        const int beyond = surface.mesh.faces[0][0];
        points.row(v) = (points.row(v) + 0.12 * (points.row(beyond) - points.row(v)).normalized()).normalized();
    }
    const std::vector<int> before = faces.flipped(points);
    ASSERT_FALSE(before.empty());
    const SphereRepair repair = repair_sphere_map(surface, faces, points);
    EXPECT_TRUE(repair.flipped.empty());
    EXPECT_TRUE(faces.flipped(points).empty());
    EXPECT_GT(repair.averaged, 0);
    int moved = 0;
    for (int v = 0; v < surface.mesh.vertex_count(); ++v) moved += (points.row(v) != surface.mesh.positions.row(v));
    EXPECT_LT(moved, 200);
    EXPECT_NEAR(covering_degree(surface.mesh.faces, points), 1, 1e-12);
}

TEST(SphereFaces, QuadsAreLookedAtInEveryCornerThatIsNotReflex) {
    Mesh cube;
    cube.positions.resize(8, 3);
    for (int v = 0; v < 8; ++v) cube.positions.row(v) << 2 * (v % 2) - 1, 2 * (v / 2 % 2) - 1, 2 * (v / 4) - 1;
    for (const auto& f : {std::array{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}})
        cube.faces.add({f[0], f[1], f[2], f[3]});
    const Surface surface(cube);
    const SphereFaces faces(surface);
    Positions points = cube.positions.rowwise().normalized();
    EXPECT_TRUE(faces.flipped(points).empty());
    // Past the diagonal the quads at a corner turn in there, while triangles of one split stay upright.
    points.row(7) = Eigen::RowVector3d(-0.2, 0.1, 1).normalized();
    EXPECT_FALSE(faces.flipped(points).empty());
    EXPECT_TRUE(faces.upright_as_triangles(cube.positions.rowwise().normalized()));
    points.row(7) = Eigen::RowVector3d(-1, -1, -2).normalized();
    EXPECT_FALSE(faces.upright_as_triangles(points));
}

TEST(SphereTutte, HasNoFoldsFromAnyOfItsRoots) {
    Mesh mesh = icosahedral_sphere(3);
    for (int v = 0; v < mesh.vertex_count(); ++v) mesh.positions.row(v) *= 1 + 0.5 * std::sin(5 * mesh.positions(v, 0));
    const Surface surface(mesh);
    const Eigen::VectorXd weights = Eigen::VectorXd::Ones(mesh.vertex_count());
    const std::vector<int> roots = tutte_roots(surface, 8);
    ASSERT_EQ(roots.size(), 8U);
    for (const int root : roots) {
        const auto points = sphere_tutte(surface, root, weights);
        ASSERT_TRUE(points);
        EXPECT_TRUE(SphereFaces(surface).flipped(*points).empty()) << root;
        EXPECT_LT(points->colwise().sum().norm(), 1e-9);
        EXPECT_NEAR(covering_degree(mesh.faces, *points), 1, 1e-12);
    }
}

}  // namespace
}  // namespace beltrami
