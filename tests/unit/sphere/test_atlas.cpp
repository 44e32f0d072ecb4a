#include <beltrami/sphere/atlas.h>

#include <cmath>

#include <gtest/gtest.h>

#include <beltrami/generate/sphere.h>
#include <beltrami/sphere/unit_sphere.h>

namespace beltrami {
namespace {

TEST(Atlas, SpinorsOfBothChartsAreThePoint) {
    const Mesh mesh = icosahedral_sphere(2);
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        const Eigen::Vector3d point = mesh.point(v);
        const auto [xi, eta] = atlas::unit_spinor(point);
        EXPECT_NEAR(std::norm(xi) + std::norm(eta), 1, 1e-14);
        EXPECT_LT((sphere_point(xi / eta) - point).norm(), 1e-14);
        if (std::abs(point.z()) > 0.4) continue;
        const auto north = atlas::spinor(atlas::place(point, false)), south = atlas::spinor(atlas::place(point, true));
        EXPECT_LT(std::abs(north[0] * south[1] - north[1] * south[0]), 1e-14);
    }
    EXPECT_EQ(atlas::place({0, 0, -1}, true), Complex(atlas::kSouth));
    EXPECT_EQ(atlas::unit_spinor({0, 0, -1})[1], Complex(0));
}

TEST(Atlas, FacesOfBothChartsRunCounterClockwise) {
    const Mesh mesh = icosahedral_sphere(3);
    const Eigen::VectorXcd places = atlas::corner_places(mesh.faces, mesh.positions);
    int south = 0;
    for (int f = 0; f < mesh.face_count(); ++f) {
        const Complex a = places[3 * f], b = places[3 * f + 1], c = places[3 * f + 2];
        EXPECT_GT(std::imag(std::conj(b - a) * (c - a)), 0);
        // All corners are in one chart, and none is far out.
        south += a.real() > atlas::kSouth / 2;
        for (const Complex z : {a, b, c}) {
            EXPECT_EQ(z.real() > atlas::kSouth / 2, a.real() > atlas::kSouth / 2);
            EXPECT_LT(std::abs(z.real() > atlas::kSouth / 2 ? z - atlas::kSouth : z), 1.3);
        }
    }
    EXPECT_NEAR(south, mesh.face_count() / 2, 60);
}

}  // namespace
}  // namespace beltrami
