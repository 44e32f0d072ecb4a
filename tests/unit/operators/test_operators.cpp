#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <random>

#include <beltrami/base/error.h>
#include <beltrami/mesh/topology.h>
#include <beltrami/operators/operators.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

using test::complex_positions;

/// ∂f and ∂̄f of f = p z + q z̄ must be p and q on any element.
void expect_exact_on_linear(const Operators& operators, const Eigen::VectorXcd& z, double tolerance) {
    const Complex p(0.7, -1.3), q(0.4, 0.2);
    const Eigen::VectorXcd f = p * z + q * z.conjugate();
    for (int s = 0; s < operators.sample_count(); ++s) {
        const auto [dz, dzbar] = operators.derivatives(s, f);
        EXPECT_NEAR(std::abs(dz - p), 0, tolerance);
        EXPECT_NEAR(std::abs(dzbar - q), 0, tolerance);
    }
}

TEST(Operators, ExactOnLinearFunctions) {
    for (const Mesh& mesh : {test::jittered_square(9), test::quad_square(7, 0.3), test::mixed_square(6)}) {
        const Operators o = operators(mesh);
        expect_exact_on_linear(o, complex_positions(mesh), 1e-11);
        EXPECT_NEAR(o.area(), 1.0, 1e-12);
    }
}

TEST(Operators, SparseMatricesAreTheSameOperators) {
    const Mesh mesh = test::mixed_square(5);
    const Operators o = operators(mesh);
    const Eigen::VectorXcd f = Eigen::VectorXcd::Random(mesh.vertex_count());
    const Eigen::VectorXcd dz = o.d_z() * f, dzbar = o.d_zbar() * f;
    for (int s = 0; s < o.sample_count(); ++s) {
        EXPECT_NEAR(std::abs(dz[s] - o.derivatives(s, f)[0]), 0, 1e-12);
        EXPECT_NEAR(std::abs(dzbar[s] - o.derivatives(s, f)[1]), 0, 1e-12);
    }
}

TEST(Operators, QuadsHaveFourSamplesTrianglesOne) {
    const Mesh mesh = test::mixed_square(4);
    const Operators o = operators(mesh);
    int expected = 0;
    for (int f = 0; f < mesh.face_count(); ++f) expected += mesh.faces.degree(f) == 4 ? 4 : 1;
    EXPECT_EQ(o.sample_count(), expected);
}

TEST(Operators, InSpaceDependOnTheShapeOnly) {
    // A planar mesh moved rigidly into space: |∂f| and |∂̄f| are those of the plane, whatever the frames.
    for (const Mesh& planar : {test::jittered_square(6), test::quad_square(5, 0.3)}) {
        const Eigen::Quaterniond rotation = Eigen::Quaterniond(0.3, -0.5, 0.7, 0.2).normalized();
        Mesh moved = planar;
        moved.positions.resize(planar.vertex_count(), 3);
        for (int v = 0; v < planar.vertex_count(); ++v)
            moved.positions.row(v) = (rotation * planar.point(v) + Eigen::Vector3d(3, -2, 5)).transpose();
        const Operators flat = operators(planar), space = operators(moved);
        const Eigen::VectorXcd f = Eigen::VectorXcd::Random(planar.vertex_count());
        for (int s = 0; s < flat.sample_count(); ++s) {
            EXPECT_NEAR(std::abs(flat.derivatives(s, f)[0]), std::abs(space.derivatives(s, f)[0]), 1e-10);
            EXPECT_NEAR(std::abs(flat.derivatives(s, f)[1]), std::abs(space.derivatives(s, f)[1]), 1e-10);
            EXPECT_NEAR(flat.weights[s], space.weights[s], 1e-13);
        }
    }
}

TEST(Operators, FromLengthsEqualThoseOfTheSurface) {
    const Mesh mesh = test::bump(300);
    std::vector<EdgeLength> lengths;
    for (const auto& [a, b] : topology(mesh).edges) lengths.push_back({b, a, (mesh.point(a) - mesh.point(b)).norm()});
    const Operators of_lengths = operators_from_corners(mesh, corners_from_lengths(mesh, lengths)),
                    of_surface = operators(mesh);
    for (std::size_t i = 0; i < of_surface.gradients.size(); ++i)
        EXPECT_NEAR(std::abs(of_lengths.gradients[i] - of_surface.gradients[i]), 0,
                    1e-9 * std::abs(of_surface.gradients[i]));
    for (int s = 0; s < of_surface.sample_count(); ++s)
        EXPECT_NEAR(of_lengths.weights[s], of_surface.weights[s], 1e-11 * of_surface.weights[s]);
}

TEST(Operators, LengthsThatCannotBeAreNamed) {
    Mesh mesh = test::jittered_square(2);
    const auto edges = topology(mesh).edges;
    std::vector<EdgeLength> good;
    for (const auto& [a, b] : edges) good.push_back({a, b, (mesh.point(a) - mesh.point(b)).norm()});
    const auto expect_error = [&](std::vector<EdgeLength> lengths, const char* words) {
        try {
            corners_from_lengths(mesh, lengths);
            ADD_FAILURE() << "accepted: " << words;
        } catch (const Error& error) {
            EXPECT_EQ(error.cause(), Cause::bad_mesh);
            EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
        }
    };
    auto lengths = good;
    lengths.pop_back();
    expect_error(lengths, "no length");
    lengths = good;
    lengths.push_back(good[0]);
    expect_error(lengths, "twice");
    lengths = good;
    lengths[0].length = -1;
    expect_error(lengths, "not positive");
    lengths = good;
    lengths[0].length = 100;
    expect_error(lengths, "triangle inequality");
    lengths = good;
    lengths[0].a = lengths[0].b;
    expect_error(lengths, "not an edge");
}

TEST(Operators, FromCornersAreThoseOfTheReferenceShapes) {
    const Mesh mesh = test::mixed_square(4);
    Positions corners(mesh.faces.corner_count(), 2);
    for (int c = 0; c < corners.rows(); ++c) corners.row(c) = 2.0 * mesh.positions.row(mesh.faces.vertices()[c]);
    const Operators doubled = operators_from_corners(mesh, corners), own = operators(mesh);
    for (int s = 0; s < own.sample_count(); ++s) EXPECT_NEAR(doubled.weights[s], 4 * own.weights[s], 1e-13);
    const Eigen::VectorXcd f = Eigen::VectorXcd::Random(mesh.vertex_count());
    for (int s = 0; s < own.sample_count(); ++s)
        EXPECT_NEAR(2 * std::abs(doubled.derivatives(s, f)[0]), std::abs(own.derivatives(s, f)[0]), 1e-11);
}

TEST(Operators, SeenFromBelowWhenAllFacesAreClockwise) {
    Mesh mesh = test::jittered_square(4);
    mesh.positions.col(0) *= -1;
    const Operators o = operators(mesh);
    for (const double w : o.weights) EXPECT_GT(w, 0);
    expect_exact_on_linear(o, complex_positions(mesh).conjugate(), 1e-11);
}

TEST(Operators, FacesWithoutAreaAreNamed) {
    Mesh mesh;
    mesh.positions.resize(4, 2);
    mesh.positions << 0, 0, 1, 0, 2, 0, 0, 1;
    mesh.faces.add({0, 1, 3});
    mesh.faces.add({0, 1, 2});
    try {
        operators(mesh);
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.indices(), std::vector<int>{1});
    }
}

}  // namespace
}  // namespace beltrami
