#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include <beltrami/base/error.h>
#include <beltrami/mesh/topology.h>
#include <beltrami/uniformize/flatten.h>

#include "support/cause_of.h"
#include "support/meshes.h"

namespace beltrami {
namespace {

/// The same faces with every vertex of the plane moved.
Mesh deformed(Mesh mesh, const std::function<Eigen::Vector3d(double, double)>& place) {
    const Positions flat = mesh.positions;
    mesh.positions.resize(flat.rows(), 3);
    for (Eigen::Index v = 0; v < flat.rows(); ++v) mesh.positions.row(v) = place(flat(v, 0), flat(v, 1));
    return mesh;
}

Eigen::Vector3d paraboloid(double x, double y) {
    return {x, y, 0.8 * x * x + 0.5 * y * y};
}

/// Every face by itself moved somewhere else, and every other one seen from behind.
Positions scattered(const Mesh& mesh) {
    Positions corners = corner_positions(mesh);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> number(-1, 1);
    for (int f = 0; f < mesh.face_count(); ++f) {
        const Eigen::Quaterniond turn(number(random), number(random), number(random), number(random));
        Eigen::Matrix3d motion = turn.normalized().toRotationMatrix();
        if (f % 2 == 1) motion *= -1;
        const Eigen::RowVector3d shift(number(random), number(random), number(random));
        auto block = corners.middleRows(mesh.faces.first_corner(f), mesh.faces.degree(f));
        block = ((block * motion.transpose()).rowwise() + shift).eval();
    }
    return corners;
}

/// Two triangles along the edge 1-2, the second with its own scale.
Positions two_triangles(double scale) {
    Positions corners(6, 2);
    const double h = std::sqrt(0.75);
    corners << 0, 0, 1, 0, 0.5, h, 0, 0, 0.5, h, -0.5, h;
    corners.bottomRows(3) *= scale;
    return corners;
}

Mesh rhombus() {
    Mesh mesh;
    mesh.positions.resize(4, 2);
    mesh.positions << 0, 0, 1, 0, 1, 1, 0, 1;
    mesh.faces.add({0, 1, 2});
    mesh.faces.add({1, 3, 2});
    return mesh;
}

TEST(FlattenInMetric, IsTheFlatteningOfTheMeshThatHasTheMetric) {
    const std::array<std::function<Eigen::Vector3d(double, double)>, 5> places = {
        paraboloid,
        [](double x, double y) { return Eigen::Vector3d(x, 2 * y, 0); },
        [](double x, double y) { return Eigen::Vector3d(x, -2 * y, 0); },
        [](double x, double y) { return Eigen::Vector3d(x + 0.3 * y * y, y - 0.2 * std::sin(3 * x), 0); },
        [](double x, double y) { return Eigen::Vector3d(std::cos(2 * x), std::sin(2 * x), y + 0.3 * x * x); },
    };
    for (const Mesh& a : {test::mixed_square(12), test::jittered_square(10), disk(8)}) {
        const std::size_t n = topology(a).boundary_loops[0].size();
        for (const auto& place : places) {
            const Mesh b = deformed(a, place);
            for (const bool regular : {false, true}) {
                FlattenOptions options;
                if (regular) options.boundary_angles.assign(n, std::numbers::pi * (1 - 2 / static_cast<double>(n)));
                const Flattening expected = flatten(b, options);
                const Flattening found = flatten(a, corner_positions(b), options);
                EXPECT_LT(test::distance_up_to_similarity(found.positions, expected.positions), 1e-9);
                EXPECT_LT((found.log_scale - expected.log_scale).lpNorm<Eigen::Infinity>(), 1e-9);
                EXPECT_NEAR(std::abs(found.positions[0] - found.positions[1]),
                            std::abs(expected.positions[0] - expected.positions[1]), 1e-9);
                EXPECT_EQ(found.flipped, expected.flipped);
                EXPECT_LT(found.residual, 1e-10);
            }
        }
    }
}

TEST(FlattenInMetric, DoesNotDependOnWhereTheFacesLie) {
    for (const Mesh& a : {test::mixed_square(12), test::jittered_square(10)}) {
        const Mesh b = deformed(a, paraboloid);
        const Flattening expected = flatten(b), found = flatten(a, scattered(b));
        EXPECT_LT(test::distance_up_to_similarity(found.positions, expected.positions), 1e-9);
        EXPECT_LT((found.log_scale - expected.log_scale).lpNorm<Eigen::Infinity>(), 1e-9);
        EXPECT_TRUE(found.flipped.empty());
    }
}

TEST(FlattenInMetric, TheFacesCountAndNotThePositions) {
    const Mesh b = deformed(test::mixed_square(8), paraboloid);
    Mesh a = b;
    a.positions.setConstant(std::numeric_limits<double>::quiet_NaN());
    const Flattening found = flatten(a, corner_positions(b)), expected = flatten(b);
    EXPECT_EQ(found.positions, expected.positions);
    EXPECT_EQ(found.log_scale, expected.log_scale);
}

TEST(FlattenInMetric, BoundaryEdgesHaveTheirLengthInTheMetric) {
    const Mesh a = disk(10);
    const Mesh b = deformed(a, [](double x, double y) { return Eigen::Vector3d(x, 2 * y, 0.3 * x * y); });
    const Flattening f = flatten(a, corner_positions(b));
    const std::vector<int> loop = topology(a).boundary_loops[0];
    for (std::size_t i = 0; i < loop.size(); ++i) {
        const int v = loop[i], w = loop[(i + 1) % loop.size()];
        EXPECT_NEAR(std::abs(f.positions[w] - f.positions[v]), (b.point(w) - b.point(v)).norm(), 1e-12);
        EXPECT_EQ(f.log_scale[v], 0);
    }
}

TEST(FlattenInMetric, TwoColumnsAreAPlane) {
    const Mesh a = disk(6);
    const Positions space =
        corner_positions(deformed(a, [](double x, double y) { return Eigen::Vector3d(x, 2 * y, 0); }));
    EXPECT_EQ(flatten(a, space).positions, flatten(a, Positions(space.leftCols(2))).positions);
}

TEST(FlattenInMetric, ADisputedEdgeHasTheMeanLength) {
    // No vertex inside, so nothing is scaled: the drawing shows the lengths themselves.
    const Mesh mesh = rhombus();
    for (const double scale : {1.0, 1.1, 0.7}) {
        const Flattening f = flatten(mesh, two_triangles(scale));
        const auto length = [&](int v, int w) { return std::abs(f.positions[v] - f.positions[w]); };
        EXPECT_NEAR(length(1, 2), 0.5 * (1 + scale), 1e-14);
        EXPECT_NEAR(length(0, 1), 1, 1e-14);
        EXPECT_NEAR(length(0, 2), 1, 1e-14);
        EXPECT_NEAR(length(1, 3), scale, 1e-14);
        EXPECT_NEAR(length(2, 3), scale, 1e-14);
        EXPECT_EQ(f.flips, 0);
        EXPECT_EQ(f.lengthened, 0);
    }
    // Rounded corners, as a text file has them.
    const Mesh b = deformed(test::mixed_square(12), paraboloid);
    Positions rounded = scattered(b);
    rounded = ((rounded.array() * 1e7).round() * 1e-7).eval();
    const Flattening f = flatten(b, rounded);
    EXPECT_LT(test::distance_up_to_similarity(f.positions, flatten(b).positions), 1e-6);
    EXPECT_LT(f.residual, 1e-10);
}

TEST(FlattenInMetric, SizeDoesNotMatter) {
    const Mesh b = deformed(test::mixed_square(8), paraboloid);
    const Flattening expected = flatten(b);
    for (const double scale : {1e-120, 1e120}) {
        const Flattening f = flatten(b, Positions(scale * corner_positions(b)));
        EXPECT_LT(test::distance_up_to_similarity(f.positions / scale, expected.positions), 1e-9);
        EXPECT_LT((f.log_scale - expected.log_scale).lpNorm<Eigen::Infinity>(), 1e-9);
    }
}

TEST(FlattenInMetric, AReflexQuadStaysAsItIs) {
    // A dart: the shorter diagonal, from 1 to 3, lies outside.
    Mesh mesh = rhombus();
    mesh.faces = {};
    mesh.faces.add({0, 1, 2, 3});
    Positions corners(4, 2);
    corners << 0, 0, 1, -0.3, 0.4, 0, 1, 0.3;
    const Flattening f = flatten(mesh, corners);
    Eigen::VectorXcd exact(4);
    for (int i = 0; i < 4; ++i) exact[i] = {corners(i, 0), corners(i, 1)};
    EXPECT_LT(test::distance_up_to_similarity(f.positions, exact), 1e-14);
    EXPECT_TRUE(f.flipped.empty());
}

TEST(FlattenInMetric, RefusesMatricesOfOtherShapes) {
    const Mesh mesh = test::mixed_square(4);
    const Positions sound = corner_positions(mesh);
    const Eigen::Index n = sound.rows();
    EXPECT_EQ(test::cause_of([&] { flatten(mesh, Positions()); }), Cause::bad_mesh);
    EXPECT_EQ(test::cause_of([&] { flatten(mesh, mesh.positions); }), Cause::bad_mesh) << "per vertex";
    EXPECT_EQ(test::cause_of([&] { flatten(mesh, Positions(sound.topRows(n - 1))); }), Cause::bad_mesh);
    EXPECT_EQ(test::cause_of([&] { flatten(mesh, Positions(Positions::Random(n + 1, 2))); }), Cause::bad_mesh);
    EXPECT_EQ(test::cause_of([&] { flatten(mesh, Positions(sound.leftCols(1))); }), Cause::bad_mesh);
    EXPECT_EQ(test::cause_of([&] { flatten(mesh, Positions(Positions::Random(n, 4))); }), Cause::bad_mesh);
    EXPECT_EQ(test::cause_of([&] { flatten(mesh, Positions(Positions::Zero(n, 2))); }), Cause::bad_mesh) << "no size";
    for (const double value : {std::nan(""), std::numeric_limits<double>::infinity()}) {
        Positions wild = sound;
        wild(mesh.faces.first_corner(5) + 1, 1) = value;
        std::vector<int> named;
        EXPECT_EQ(test::cause_of([&] { flatten(mesh, wild); }, &named), Cause::bad_mesh);
        EXPECT_EQ(named, std::vector<int>{5});
    }
    FlattenOptions options;
    options.tolerance = 0;
    EXPECT_EQ(test::cause_of([&] { flatten(mesh, sound, options); }), Cause::bad_option);
    EXPECT_EQ(test::cause_of([&] { flatten(Mesh{}, Positions(0, 2)); }), Cause::bad_mesh);
}

TEST(FlattenInMetric, NamesFacesWhoseNeighboursContradictThem) {
    std::vector<int> named;
    EXPECT_EQ(test::cause_of([] { flatten(rhombus(), two_triangles(4)); }, &named), Cause::bad_mesh);
    EXPECT_EQ(named, std::vector<int>{0});
}

TEST(FlattenInMetric, FacesWithoutAreaAreTakenWithANote) {
    const Mesh mesh = test::jittered_square(6);
    Mesh b = deformed(mesh, paraboloid);
    b.positions.row(24) = 0.5 * (b.positions.row(23) + b.positions.row(25));
    b.positions.row(17) = b.positions.row(24);
    const Flattening f = flatten(mesh, corner_positions(b));
    EXPECT_GT(f.lengthened, 0);
    EXPECT_LT(f.lengthened, 1e-8);
    EXPECT_TRUE(f.positions.allFinite());
}

}  // namespace
}  // namespace beltrami
