#include <cmath>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <beltrami/base/constants.h>
#include <beltrami/base/random.h>
#include <beltrami/sphere/centring.h>
#include <beltrami/sphere/stereographic_charts.h>
#include <beltrami/sphere/unit_sphere.h>

namespace beltrami {
namespace {

Positions random_points(int count, std::uint64_t seed) {
    Random random(seed);
    Positions points(count, 3);
    for (int v = 0; v < count; ++v) {
        do {
            for (int d = 0; d < 3; ++d) points(v, d) = random.uniform(-1, 1);
        } while (points.row(v).norm() > 1 || points.row(v).norm() < 0.1);
        points.row(v).normalize();
    }
    return points;
}

FaceList octahedron_faces() {
    FaceList faces;
    for (const auto& f :
         {std::array{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}})
        faces.add({f[0], f[1], f[2]});
    return faces;
}

Positions octahedron() {
    Positions p(6, 3);
    p << 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1;
    return p;
}

TEST(UnitSphere, StereographicProjectionKeepsOrientationAndInverts) {
    for (const Complex z : {Complex(0, 0), Complex(0.3, -0.2), Complex(-40, 7), Complex(1e-9, 2e-9)}) {
        const Eigen::Vector3d p = sphere_point(z);
        EXPECT_NEAR(p.norm(), 1, 1e-15);
        EXPECT_LT(std::abs(stereographic(p) - z), 1e-12 * (1 + std::norm(z)));
        const double h = 1e-3 * (1 + std::abs(z));
        EXPECT_GT(oriented_volume(p, sphere_point(z + h), sphere_point(z + Complex(0, h))), 0);
    }
    EXPECT_EQ(sphere_point(1e200), Eigen::Vector3d(0, 0, -1));
}

TEST(UnitSphere, SolidAnglesOfAnOctahedronCoverItOnce) {
    const Positions p = octahedron();
    EXPECT_NEAR(solid_angle(p.row(0), p.row(2), p.row(4)), kPi / 2, 1e-15);
    EXPECT_NEAR(solid_angle(p.row(2), p.row(0), p.row(4)), -kPi / 2, 1e-15);
    EXPECT_NEAR(covering_degree(octahedron_faces(), p), 1, 1e-15);
    EXPECT_NEAR(covering_degree(octahedron_faces(), -p), -1, 1e-15);  // mirrored: turned inside out
}

TEST(UnitSphere, GnomonicChartsKeepOrientationOfTinyTriangles) {
    const Positions around = random_points(50, 3);
    for (int v = 0; v < 50; ++v) {
        const Eigen::Vector3d centre = around.row(v);
        const GnomonicChart chart(centre);
        const TangentFrame frame(centre);
        EXPECT_NEAR(frame.first.cross(frame.second).dot(centre), 1, 1e-14);
        for (const double size : {1.0, 1e-6, 1e-12}) {
            const Complex z[3] = {0.0, size, Complex(0, size)};
            EXPECT_GT(oriented_volume(chart.point(z[0]), chart.point(z[1]), chart.point(z[2])), 0);
            EXPECT_LT(std::abs(chart(chart.point(z[2])) - z[2]), 1e-15 + 1e-3 * size);
        }
    }
}

TEST(StereographicCharts, KeepOrientationSideBySide) {
    const FaceList faces = octahedron_faces();
    Positions points = octahedron();
    points = points * Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 0).normalized()).toRotationMatrix();
    const TextureCoordinates charts = stereographic_charts(faces, points);
    ASSERT_EQ(charts.corners.size(), 24U);
    EXPECT_GT(charts.points.rows(), 6);  // seams: a vertex of both charts has two points
    double north = -1e9, south = 1e9;
    for (int f = 0; f < 8; ++f) {
        Complex z[3];
        double height = 0;
        for (int i = 0; i < 3; ++i) {
            const int c = charts.corners[3 * f + i];
            z[i] = {charts.points(c, 0), charts.points(c, 1)};
            height += points(faces[f][i], 2);
        }
        EXPECT_GT(std::imag(std::conj(z[1] - z[0]) * (z[2] - z[0])), 0) << f;
        for (const Complex& corner : z)
            if (height >= 0)
                north = std::max(north, corner.real());
            else
                south = std::min(south, corner.real());
        // In the first chart points are those of the projection.
        if (height >= 0) {
            EXPECT_LT(std::abs(z[0] - stereographic(points.row(faces[f][0]))), 1e-15);
        }
    }
    EXPECT_LT(north, south);
}

TEST(Centring, UndoesAMoebiusMapUpToRotation) {
    // Points in general position, centred; then sent off by a Möbius map and centred again: distances are those of
    // before.
    Eigen::VectorXd weights = Eigen::VectorXd::LinSpaced(200, 0.5, 2);
    const CentredSphere first = centred(random_points(200, 5), weights);
    EXPECT_LT(first.centre_distance, 1e-13);
    EXPECT_LT((weights.transpose() * first.points).norm() / weights.sum(), 1e-13);
    Eigen::VectorXcd z(200);
    for (int v = 0; v < 200; ++v) z[v] = stereographic(first.points.row(v));
    const Complex a(0.3, 2), b(1, -4), c(0.2, 0.1), d(1, 0);
    const Eigen::VectorXcd moved = (a * z.array() + b) / (c * z.array() + d);
    const CentredSphere again = centred(sphere_points(moved), weights);
    EXPECT_LT(again.centre_distance, 1e-13);
    EXPECT_LT(again.iterations, 30);
    const Eigen::MatrixXd before = first.points * first.points.transpose(),
                          after = again.points * again.points.transpose();
    EXPECT_LT((before - after).cwiseAbs().maxCoeff(), 1e-10);
}

TEST(Centring, PointsWithoutWeightComeAlong) {
    Positions points = random_points(40, 9);
    Eigen::VectorXd weights = Eigen::VectorXd::Ones(40);
    const CentredSphere all = centred(points, weights);
    Positions more(41, 3);
    more << points, 0, 0, 1;
    Eigen::VectorXd with_zero(41);
    with_zero << weights, 0;
    const CentredSphere result = centred(more, with_zero);
    EXPECT_LT((result.points.topRows(40) - all.points).cwiseAbs().maxCoeff(), 1e-13);
    EXPECT_NEAR(result.points.row(40).norm(), 1, 1e-15);
}

TEST(Centring, SaysWhereHalfOfTheWeightIsAtOnePoint) {
    Positions points(4, 3);
    points << 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, 0, 1;
    const CentredSphere result = centred(points, Eigen::Vector4d(10, 1, 1, 1));
    EXPECT_GT(result.centre_distance, 0.1);
    EXPECT_TRUE(result.points.allFinite());
}

TEST(Centring, MediansOfThePlane) {
    Eigen::VectorXcd z(5);
    z << Complex(100, 0), Complex(102, 0), Complex(104, 0), Complex(102, 3), Complex(1e9, 1);
    const Eigen::VectorXcd result = around_median(z, Eigen::VectorXd::Ones(5));
    EXPECT_EQ(result[1], Complex(0, 0));
    EXPECT_EQ(std::abs(result[0]), 1 * std::abs(result[2]));
    EXPECT_LT(std::abs(result[0]), 1.01);
}

}  // namespace
}  // namespace beltrami
