#include <gtest/gtest.h>

#include <random>

#include <beltrami/locate/surface_locator.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

std::vector<std::array<int, 3>> triangles_of(const Mesh& mesh) {
    std::vector<std::array<int, 3>> result;
    for (int f = 0; f < mesh.face_count(); ++f)
        result.push_back({mesh.faces[f][0], mesh.faces[f][1], mesh.faces[f][2]});
    return result;
}

Eigen::Vector3d position(const Mesh& mesh, const SurfaceLocator::Place& place) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (int j = 0; j < 3; ++j) sum += place.barycentric[j] * mesh.point(mesh.faces[place.triangle][j]);
    return sum;
}

TEST(SurfaceLocator, FindsPointsOfTheSurfaceWhereTheyAre) {
    const Mesh mesh = test::bump(2000);
    const SurfaceLocator locator(mesh.positions, triangles_of(mesh));
    std::mt19937 random(5);
    std::uniform_real_distribution<double> weight(0.01, 1);
    for (int f = 0; f < mesh.face_count(); ++f) {
        const double a = weight(random), b = weight(random), c = weight(random), sum = a + b + c;
        const Eigen::Vector3d p =
            (a * mesh.point(mesh.faces[f][0]) + b * mesh.point(mesh.faces[f][1]) + c * mesh.point(mesh.faces[f][2])) /
            sum;
        const SurfaceLocator::Place place = locator.nearest(p);
        EXPECT_EQ(place.triangle, f);
        EXPECT_LT(place.distance, 1e-14);
        EXPECT_NEAR(place.barycentric[0], a / sum, 1e-12);
        EXPECT_NEAR(place.barycentric[1], b / sum, 1e-12);
    }
}

TEST(SurfaceLocator, IsNeverBeatenByAnotherPointOfTheSurface) {
    const Mesh mesh = test::bump(300);
    const SurfaceLocator locator(mesh.positions, triangles_of(mesh));
    std::mt19937 random(6);
    std::uniform_real_distribution<double> coordinate(-1.5, 1.5), weight(0, 1);
    for (int i = 0; i < 200; ++i) {
        const Eigen::Vector3d p(coordinate(random), coordinate(random), coordinate(random));
        const SurfaceLocator::Place place = locator.nearest(p);
        EXPECT_NEAR((position(mesh, place) - p).norm(), place.distance, 1e-14);
        for (const int guess : {0, 17, mesh.face_count() - 1}) {
            const SurfaceLocator::Place again = locator.nearest(p, guess);
            EXPECT_EQ(again.triangle, place.triangle);
            EXPECT_EQ(again.barycentric, place.barycentric);
        }
        double least = std::numeric_limits<double>::infinity();
        for (int f = 0; f < mesh.face_count(); ++f)
            for (int n = 0; n < 20; ++n) {
                double a = weight(random), b = weight(random);
                if (a + b > 1) a = 1 - a, b = 1 - b;
                const SurfaceLocator::Place other{f, {1 - a - b, a, b}, 0};
                least = std::min(least, (position(mesh, other) - p).norm());
            }
        EXPECT_LE(place.distance, least + 1e-14);
        for (const double w : place.barycentric) EXPECT_GE(w, 0);
    }
}

TEST(SurfaceLocator, KnowsCornersAndEdges) {
    Mesh mesh;
    mesh.positions.resize(3, 3);
    mesh.positions << 0, 0, 0, 2, 0, 0, 0, 1, 0;
    mesh.faces.add({0, 1, 2});
    const SurfaceLocator locator(mesh.positions, triangles_of(mesh));
    EXPECT_EQ(locator.nearest({-1, -2, 3}).barycentric, (std::array<double, 3>{1, 0, 0}));
    EXPECT_EQ(locator.nearest({5, -1, 3}).barycentric, (std::array<double, 3>{0, 1, 0}));
    EXPECT_EQ(locator.nearest({-0.1, 7, 0}).barycentric, (std::array<double, 3>{0, 0, 1}));
    EXPECT_EQ(locator.nearest({0.5, -4, 0}).barycentric, (std::array<double, 3>{0.75, 0.25, 0}));
    EXPECT_EQ(locator.nearest({-4, 0.25, 1}).barycentric, (std::array<double, 3>{0.75, 0, 0.25}));
    EXPECT_DOUBLE_EQ(locator.nearest({0.5, 0.25, -3}).distance, 3);
    const SurfaceLocator::Place middle = locator.nearest({2, 2.5, 0});  // (1, ½) is the middle of the long side
    EXPECT_NEAR(middle.barycentric[1], 0.5, 1e-15);
    EXPECT_NEAR(middle.barycentric[2], 0.5, 1e-15);
}

}  // namespace
}  // namespace beltrami
