#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <cmath>
#include <limits>

#include <beltrami/operators/distortion.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

using test::complex_positions;

/// |μ| of the linear map between two triangles in space from singular values, with the sign of orientation: independent
/// of ∂, ∂̄.
double abs_mu_by_singular_values(const Eigen::Matrix<double, 3, 2>& source, const Eigen::Matrix<double, 3, 2>& image,
                                 double side) {
    const auto in_plane = [](const Eigen::Matrix<double, 3, 2>& edges) {
        Eigen::Matrix<double, 3, 2> frame;
        frame.col(0) = edges.col(0).normalized();
        frame.col(1) = (edges.col(1) - edges.col(1).dot(frame.col(0)) * frame.col(0)).normalized();
        return Eigen::Matrix2d(frame.transpose() * edges);
    };
    const Eigen::Matrix2d J = in_plane(image) * in_plane(source).inverse();
    const Eigen::Vector2d sigma = J.jacobiSvd().singularValues();
    const double ratio = (sigma[0] - sigma[1]) / (sigma[0] + sigma[1]);
    return side * J.determinant() > 0 ? ratio : 1 / ratio;
}

TEST(Distortion, AgreesWithSingularValues) {
    const Mesh mesh = test::bump(400);
    const Operators o = operators(mesh);
    const Eigen::VectorXcd f =
        complex_positions(mesh).unaryExpr([](Complex z) { return z + 0.2 * z * z + 0.3 * std::conj(z); });
    const Distortion d = distortion(o, f);
    for (int t = 0; t < mesh.face_count(); ++t) {
        const auto v = mesh.faces[t];
        Eigen::Matrix<double, 3, 2> source, image;
        for (int j = 0; j < 2; ++j) {
            source.col(j) = mesh.point(v[j + 1]) - mesh.point(v[0]);
            image.col(j) << f[v[j + 1]].real() - f[v[0]].real(), f[v[j + 1]].imag() - f[v[0]].imag(), 0;
        }
        const double side = image(0, 0) * image(1, 1) - image(1, 0) * image(0, 1) > 0 ? 1 : -1;
        EXPECT_NEAR(d.face_abs_mu[t], abs_mu_by_singular_values(source, image, side), 1e-12);
    }
}

TEST(Distortion, FindsEveryFlipAndNothingElse) {
    Mesh mesh = test::jittered_square(12);
    const Operators o = operators(mesh);
    Eigen::VectorXcd f = complex_positions(mesh);
    for (int v = 0; v < mesh.vertex_count(); v += 7) f[v] += Complex(0.09 * std::sin(v), 0.11 * std::cos(3 * v));
    std::vector<int> flipped;
    for (int t = 0; t < mesh.face_count(); ++t) {
        const auto v = mesh.faces[t];
        if (std::imag(std::conj(f[v[1]] - f[v[0]]) * (f[v[2]] - f[v[0]])) < 0) flipped.push_back(t);
    }
    ASSERT_GT(flipped.size(), 5u);
    const Distortion d = distortion(o, f);
    EXPECT_EQ(d.flipped, flipped);
    for (int t = 0; t < mesh.face_count(); ++t)
        EXPECT_EQ(d.face_abs_mu[t] > 1, std::find(flipped.begin(), flipped.end(), t) != flipped.end()) << t;
}

TEST(Distortion, FlipsInSpaceAreJudgedByTheImagesNormals) {
    const Mesh source = test::bump(300);
    Mesh image = source;  // the same surface turned upside down as a whole is not flipped …
    const Eigen::AngleAxisd turn(2.5, Eigen::Vector3d(1, 2, 0.5).normalized());
    for (int v = 0; v < image.vertex_count(); ++v) image.positions.row(v) = (turn * source.point(v)).transpose();
    const Operators o = operators(source);
    Distortion d = distortion(o, image.positions, vertex_normals(image));
    EXPECT_TRUE(d.flipped.empty());
    EXPECT_LT(d.max, 1e-12);
    // … but a vertex pulled through its neighbours' faces is.
    const int inner = source.vertex_count() / 4;
    const Eigen::Vector3d normal = vertex_normals(image).row(inner);
    Eigen::Vector3d across = normal.unitOrthogonal();
    image.positions.row(inner) += 0.5 * across.transpose();
    const Positions normals = vertex_normals(image);
    d = distortion(o, image.positions, normals);
    std::vector<int> opposed;
    for (int f = 0; f < image.face_count(); ++f) {
        const auto v = image.faces[f];
        const Eigen::Vector3d around = (normals.row(v[0]) + normals.row(v[1]) + normals.row(v[2])).transpose();
        if (face_vector_area(image, f).dot(around) < 0) opposed.push_back(f);
    }
    EXPECT_FALSE(opposed.empty());
    EXPECT_EQ(d.flipped, opposed);
    for (const int f : d.flipped) EXPECT_GT(d.face_abs_mu[f], 1);
}

TEST(Distortion, AClockwiseSourceIsLookedAtFromBelow) {
    Mesh clockwise = test::jittered_square(6);
    clockwise.positions.col(0) *= -1;
    const Mesh upright = test::jittered_square(6);
    EXPECT_LT(distortion_to(clockwise, clockwise).max, 1e-12);
    EXPECT_EQ(distortion_to(clockwise, upright).flipped.size(), static_cast<std::size_t>(upright.face_count()));
    EXPECT_EQ(distortion_to(upright, clockwise).flipped.size(), static_cast<std::size_t>(upright.face_count()));
    Positions corners(clockwise.faces.corner_count(), 2);
    for (int c = 0; c < corners.rows(); ++c) corners.row(c) = clockwise.positions.row(clockwise.faces.vertices()[c]);
    EXPECT_LT(distortion_to_corners(clockwise, corners).max, 1e-12);
}

TEST(Distortion, CollapsedFacesAreUndefinedNotZero) {
    Mesh mesh = test::jittered_square(5);
    const Operators o = operators(mesh);
    Eigen::VectorXcd f = complex_positions(mesh);
    const auto v = mesh.faces[10];
    f[v[1]] = f[v[2]] = f[v[0]];
    const Distortion d = distortion(o, f);
    EXPECT_TRUE(std::isnan(d.face_abs_mu[10]));
    EXPECT_NE(std::find(d.degenerate.begin(), d.degenerate.end(), 10), d.degenerate.end());
    EXPECT_EQ(std::find(d.flipped.begin(), d.flipped.end(), 10), d.flipped.end());
    EXPECT_TRUE(std::isfinite(d.mean) && std::isfinite(d.standard_deviation) && std::isfinite(d.p99));
}

TEST(Distortion, ConstantMapAndReflection) {
    const Mesh mesh = test::jittered_square(4);
    const Operators o = operators(mesh);
    const Distortion constant = distortion(o, Eigen::VectorXcd(Eigen::VectorXcd::Zero(mesh.vertex_count())));
    EXPECT_EQ(constant.degenerate.size(), static_cast<std::size_t>(mesh.face_count()));
    EXPECT_TRUE(std::isnan(constant.mean));
    const Distortion reflected = distortion(o, Eigen::VectorXcd(complex_positions(mesh).conjugate()));
    EXPECT_EQ(reflected.flipped.size(), static_cast<std::size_t>(mesh.face_count()));
}

TEST(Distortion, StatisticsAreWeightedByArea) {
    Eigen::VectorXcd mu(4);
    mu << 0.1, Complex(0, 0.3), std::numeric_limits<double>::quiet_NaN(), 0.5;
    const MuStatistics s = mu_statistics(mu, {1.0, 2.0, 100.0, 1.0});
    EXPECT_NEAR(s.mean, (0.1 + 0.6 + 0.5) / 4, 1e-15);
    EXPECT_NEAR(s.standard_deviation, std::sqrt((0.04 + 0 + 0.04) / 4), 1e-15);
    EXPECT_NEAR(s.max, 0.5, 1e-15);
    Eigen::VectorXcd many(1000);
    for (int i = 0; i < 1000; ++i) many[i] = i / 1000.0;
    EXPECT_NEAR(mu_statistics(many, std::vector<double>(1000, 1.0)).p99, 0.989, 1e-12);
}

TEST(Distortion, PerCornerSeesTheSameAsPerVertexWithoutSeams) {
    const Mesh mesh = test::mixed_square(6);
    const Operators o = operators(mesh);
    Positions image(mesh.vertex_count(), 2), corners(mesh.faces.corner_count(), 2);
    for (int v = 0; v < mesh.vertex_count(); ++v)
        image.row(v) << mesh.positions(v, 0) + 0.3 * mesh.positions(v, 1) * mesh.positions(v, 1),
            0.7 * mesh.positions(v, 1);
    for (int c = 0; c < corners.rows(); ++c) corners.row(c) = image.row(mesh.faces.vertices()[c]);
    const Distortion by_vertex = distortion(o, image), by_corner = distortion(per_corner(o, mesh.faces), corners);
    EXPECT_EQ(by_vertex.mu, by_corner.mu);
}

TEST(Coefficients, Dilatation) {
    EXPECT_DOUBLE_EQ(dilatation(0.5), 3.0);
    EXPECT_TRUE(std::isinf(dilatation(1.0)));
    EXPECT_DOUBLE_EQ(dilatation(2.0), 3.0);
}

TEST(Coefficients, CompositionOfLinearMaps) {
    // f = p z + q z̄, g = r w + s w̄; μ_{g∘f} and back.
    const Complex p(1.2, 0.4), q(0.3, -0.2), r(0.8, -0.5), s(0.1, 0.35);
    const Complex composed = (r * q + s * std::conj(p)) / (r * p + s * std::conj(q));
    const Complex found = compose_coefficients(q / p, s / r, p);
    EXPECT_NEAR(std::abs(found - composed), 0, 1e-15);
    EXPECT_NEAR(std::abs(decompose_coefficients(q / p, composed, p) - s / r), 0, 1e-15);
}

TEST(Coefficients, ChangeOfFrame) {
    // In the frame turned by a, f(z) = p z + q z̄ reads p e^{ia} z' + q e^{-ia} z̄'.
    const Complex p(1, 0.3), q(0.2, -0.4);
    const double a = 0.7;
    EXPECT_NEAR(std::abs(change_frame(q / p, a) - q * std::polar(1.0, -a) / (p * std::polar(1.0, a))), 0, 1e-15);
}

}  // namespace
}  // namespace beltrami
