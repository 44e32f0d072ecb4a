#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include <beltrami/base/constants.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/space/corner_elements.h>
#include <beltrami/space/reference_shapes.h>
#include <beltrami/space/uniform_map.h>

#include "support/cause_of.h"
#include "support/meshes.h"

namespace beltrami {
namespace {

using test::complex_positions;

TEST(CornerElements, CoverEveryPolygonOnce) {
    for (const Mesh& mesh : {test::jittered_square(5), test::quad_square(5, 0.25), test::mixed_square(5)})
        EXPECT_NEAR(corner_elements(mesh).operators.area(), 1, 1e-14);
    for (int n = 3; n <= 9; ++n) {  // a regular polygon
        Mesh mesh;
        mesh.positions.resize(n, 2);
        std::vector<int> face;
        for (int j = 0; j < n; ++j) {
            mesh.positions.row(j) << std::cos(2 * kPi * j / n), std::sin(2 * kPi * j / n);
            face.push_back(j);
        }
        mesh.faces.add(face);
        EXPECT_NEAR(corner_elements(mesh).operators.area(), n / 2.0 * std::sin(2 * kPi / n), 1e-14) << n;
    }
}

TEST(CornerElements, AffineMapsHaveOneCoefficientInAPlanarQuad) {
    const Complex mu = std::polar(0.4, 0.7);
    const Mesh mesh = test::mixed_square(9);
    const CornerElements elements = corner_elements(mesh);
    const Eigen::VectorXcd z = complex_positions(mesh);
    const Eigen::VectorXcd got = beltrami_coefficient(elements.operators, z + mu * z.conjugate());
    EXPECT_LT((got.array() - mu).abs().maxCoeff(), 1e-13);
    // In the frames of the elements of the same mesh turned in space it is one value a face as well.
    Mesh turned = mesh;
    turned.positions.resize(mesh.vertex_count(), 3);
    const Eigen::AngleAxisd turn(1.1, Eigen::Vector3d(1, -2, 0.5).normalized());
    for (int v = 0; v < mesh.vertex_count(); ++v) turned.positions.row(v) = turn * mesh.point(v);
    const CornerElements in_space = corner_elements(turned);
    const Eigen::VectorXcd there = beltrami_coefficient(in_space.operators, z + mu * z.conjugate());
    const Eigen::VectorXcd faces = face_means(in_space.operators, there);
    EXPECT_LT((there - face_values_at_samples(in_space.operators, faces)).cwiseAbs().maxCoeff(), 1e-13);
    EXPECT_LT((there.cwiseAbs().array() - 0.4).abs().maxCoeff(), 1e-13);
    // And smoothing over the edges keeps it: the phases go from frame to frame by e^{∓2iθ}.
    EXPECT_LT((smoothed_over_edges(in_space, turned, faces, 3) - faces).cwiseAbs().maxCoeff(), 1e-13);
}

TEST(CornerElements, FoldExactlyWhereACornerDoes) {
    const Mesh mesh = test::quad_square(1, 0);
    const CornerElements elements = corner_elements(mesh);
    Eigen::VectorXcd f = complex_positions(mesh);
    f[3] = {0.48, 0.48};  // a corner just beyond the diagonal: reflex, still positive at the 2×2 Gauss points
    EXPECT_EQ(distortion(elements.operators, f).flipped.size(), 1u);
    EXPECT_TRUE(distortion(operators(mesh), f).flipped.empty());
}

TEST(CornerElements, NameFacesThatFold) {
    Mesh mesh = test::quad_square(3, 0);
    mesh.positions.row(5) << 0.9, 0.9;  // the first inner vertex, far into other cells
    std::vector<int> indices;
    EXPECT_EQ(test::cause_of([&] { corner_elements(mesh); }, &indices), Cause::bad_mesh);
    ASSERT_FALSE(indices.empty());
    EXPECT_NE(std::find(indices.begin(), indices.end(), 4), indices.end());  // the one in the middle
}

TEST(ReferenceShapes, ByValenceHaveTheAnglesThatTheirVerticesWant) {
    // An icosahedron cap: the apex has five faces, so each has 2π/5 there, which is the largest and is kept.
    Mesh mesh;
    mesh.positions.resize(6, 2);
    mesh.positions.row(0).setZero();
    for (int j = 0; j < 5; ++j) {
        mesh.positions.row(j + 1) << std::cos(2 * kPi * j / 5), std::sin(2 * kPi * j / 5);
        mesh.faces.add({0, j + 1, (j + 1) % 5 + 1});
    }
    const Positions shapes = valence_shapes(mesh);
    for (int f = 0; f < 5; ++f) {
        const Complex b(shapes(3 * f + 1, 0), shapes(3 * f + 1, 1)), c(shapes(3 * f + 2, 0), shapes(3 * f + 2, 1));
        // At the rim of two faces each π/2; the largest angle is not alone: all are scaled by π/(π + 2π/5).
        EXPECT_NEAR(std::arg(c / b), 2 * kPi / 5 / 1.4, 1e-12);
        EXPECT_NEAR(0.5 * std::imag(std::conj(b) * c), std::sqrt(3.0) / 4, 1e-12);
    }
    // Inside a grid all angles of a quad are right: squares. At a corner of the grid one quad ends.
    const Mesh quads = test::quad_square(4, 0.2);
    const Positions squares = valence_shapes(quads);
    const int inner = 5;
    for (int j = 0; j < 4; ++j) {
        EXPECT_NEAR((squares.row(4 * inner + j) - squares.row(4 * inner + (j + 1) % 4)).norm(), 1, 1e-12);
        EXPECT_NEAR((squares.row(4 * inner + j) - squares.row(4 * inner + (j + 2) % 4)).norm(), std::sqrt(2), 1e-12);
    }
    EXPECT_NO_THROW(corner_elements(quads, squares));
}

TEST(ReferenceShapes, ByAnglesOfATangentialQuad) {
    const Mesh mesh = test::quad_square(1, 0);
    Eigen::VectorXd angles(4);
    angles << 1.2, 1.9, 1.4, 2 * kPi - 4.5;
    const Positions shape = shapes_from_angles(mesh.faces, angles);
    double alternating = 0, area = 0;
    for (int j = 0; j < 4; ++j) {
        const Eigen::Vector2d at = shape.row(j), to = shape.row((j + 1) % 4), from = shape.row((j + 3) % 4);
        const Eigen::Vector2d u = to - at, v = from - at;
        EXPECT_NEAR(std::acos(u.dot(v) / (u.norm() * v.norm())), angles[j], 1e-12);
        alternating += (j % 2 ? -1 : 1) * u.norm();
        area += 0.5 * (at[0] * to[1] - at[1] * to[0]);
    }
    EXPECT_NEAR(alternating, 0, 1e-12);  // Pitot's theorem
    EXPECT_NEAR(area, 1, 1e-12);
    angles[0] += 0.1;
    EXPECT_EQ(test::cause_of([&] { shapes_from_angles(mesh.faces, angles); }), Cause::bad_option);
}

}  // namespace
}  // namespace beltrami
