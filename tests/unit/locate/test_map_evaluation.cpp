#include <gtest/gtest.h>

#include <random>

#include <beltrami/base/error.h>
#include <beltrami/base/parallel.h>
#include <beltrami/locate/map_evaluation.h>
#include <beltrami/operators/operators.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

/// A one-to-one map of the unit square that is far from linear.
Complex bent(Complex z) {
    return std::exp(Complex(0.4, 0.7) * z) + 0.1 * std::conj(z);
}

TEST(MapEvaluation, GoesThereAndBack) {
    for (const Mesh& mesh : {test::jittered_square(9), test::mixed_square(8), test::quad_square(7, 0.2)}) {
        const Eigen::VectorXcd map = test::complex_positions(mesh).unaryExpr([](Complex z) { return bent(z); });
        const MapEvaluation f(mesh, map);
        std::mt19937 random(7);
        std::uniform_real_distribution<double> inside(0.05, 0.95);
        for (int i = 0; i < 500; ++i) {
            const Complex w = bent({inside(random), inside(random)});
            const auto place = f.preimage(w);
            ASSERT_TRUE(place);
            EXPECT_NEAR(std::abs(f.image(*place) - w), 0, 1e-14);
            // And from the point of the source again.
            const Complex z = place->interpolate(test::complex_positions(mesh));
            const MapEvaluation::Nearest again = f.nearest({z.real(), z.imag(), 0});
            EXPECT_LT(again.distance, 1e-14);
            EXPECT_NEAR(std::abs(f.image(again.place) - w), 0, 1e-12);
        }
    }
}

TEST(MapEvaluation, IsTheMapAtVertices) {
    const Mesh mesh = test::mixed_square(5);
    const Eigen::VectorXcd map = test::complex_positions(mesh).unaryExpr([](Complex z) { return bent(z); });
    const MapEvaluation f(mesh, map);
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        EXPECT_NEAR(std::abs(f.image(f.nearest(mesh.point(v)).place) - map[v]), 0, 1e-15);
        const auto place = f.preimage(map[v]);
        ASSERT_TRUE(place);
        EXPECT_NEAR(std::abs(place->interpolate(test::complex_positions(mesh)) - test::complex_positions(mesh)[v]), 0,
                    1e-13);
    }
}

TEST(MapEvaluation, ConvergesInSecondOrderInBothDirections) {
    const Complex z0(0.37, 0.61);
    std::vector<double> there, back;
    for (const int n : {10, 20, 40, 80}) {
        const Mesh mesh = test::square(n, 0, [](int, int) { return false; });
        const Eigen::VectorXcd z = test::complex_positions(mesh);
        const MapEvaluation f(mesh, z.unaryExpr([](Complex p) { return bent(p); }));
        double worst_there = 0, worst_back = 0;
        for (int i = 0; i < 50; ++i) {
            const Complex p = z0 + std::polar(0.3, 0.1234 * i);
            worst_there = std::max(worst_there, std::abs(f.image(f.nearest({p.real(), p.imag(), 0}).place) - bent(p)));
            worst_back = std::max(worst_back, std::abs(f.preimage(bent(p))->interpolate(z) - p));
        }
        there.push_back(worst_there);
        back.push_back(worst_back);
    }
    EXPECT_GT(std::log2(there[0] / there[3]) / 3, 1.8);
    EXPECT_GT(std::log2(back[0] / back[3]) / 3, 1.8);
}

TEST(MapEvaluation, NamesPointsOutside) {
    const Mesh mesh = test::jittered_square(4);
    const MapEvaluation f(mesh, test::complex_positions(mesh));
    EXPECT_FALSE(f.preimage({1.1, 0.5}));
    EXPECT_FALSE(f.preimage({std::numeric_limits<double>::quiet_NaN(), 0.5}));
    EXPECT_TRUE(f.preimage({1 + 1e-11, 0.5}));
    EXPECT_TRUE(f.preimage({1.1, 0.5}, 0.1));
    const std::vector<Complex> points{{0.5, 0.5}, {3, 3}, {0.1, 0.2}, {0, -0.1}};
    try {
        f.preimages(points);
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.cause(), Cause::bad_boundary);
        EXPECT_EQ(error.indices(), (std::vector<int>{1, 3}));
    }
    EXPECT_THROW(MapEvaluation(mesh, Eigen::VectorXcd::Zero(3)), Error);
}

TEST(MapEvaluation, PassesCollapsedTrianglesBy) {
    Mesh mesh;
    mesh.positions.resize(4, 2);
    mesh.positions << 0, 0, 1, 0, 1, 1, 2, 0;
    mesh.faces.add({0, 1, 2});
    mesh.faces.add({1, 3, 2});
    Eigen::VectorXcd map(4);
    map << 0, 1, Complex(1, 1), Complex(1, 0.5);  // the second triangle collapses to an edge
    const MapEvaluation f(mesh, map);
    for (const Complex w : {Complex(0.9, 0.3), Complex(1, 0.5), Complex(1, 0.25)}) {
        const auto place = f.preimage(w);
        ASSERT_TRUE(place);
        EXPECT_NEAR(std::abs(f.image(*place) - w), 0, 1e-15);
    }
}

TEST(MapEvaluation, TakesSeams) {
    // Two triangles of a square, laid out apart from each other.
    Mesh mesh;
    mesh.positions.resize(4, 3);
    mesh.positions << 0, 0, 1, 1, 0, 1, 1, 1, 1, 0, 1, 1;
    mesh.faces.add({0, 1, 2});
    mesh.faces.add({0, 2, 3});
    Positions corners(6, 2);
    corners << 0, 0, 1, 0, 1, 1, 5, 5, 6, 6, 5, 6;
    const MapEvaluation f = MapEvaluation::of_corners(mesh, corners);
    const auto place = f.preimage({5.25, 5.5});
    ASSERT_TRUE(place);
    EXPECT_EQ(place->face, 1);
    EXPECT_NEAR(std::abs(f.image(*place) - Complex(5.25, 5.5)), 0, 1e-15);
    EXPECT_FALSE(f.preimage({3, 3}));
    EXPECT_NEAR(std::abs(f.image(f.nearest({0.25, 0.5, 1}).place) - Complex(5.25, 5.5)), 0, 1e-15);
    EXPECT_NEAR(std::abs(f.image(f.nearest({0.5, 0.25, 1}).place) - Complex(0.5, 0.25)), 0, 1e-15);
}

TEST(MapEvaluation, DoesNotDependOnThreads) {
    const Mesh mesh = test::jittered_square(12);
    const MapEvaluation f(mesh, test::complex_positions(mesh).unaryExpr([](Complex z) { return bent(z); }));
    std::vector<Complex> points;
    for (int i = 0; i < 3000; ++i) points.push_back(bent({0.5 + 0.4 * std::sin(i), 0.5 + 0.4 * std::cos(1.7 * i)}));
    const int before = thread_count();
    set_thread_count(1);
    const std::vector<MeshPoint> one = f.preimages(points);
    set_thread_count(4);
    const std::vector<MeshPoint> four = f.preimages(points);
    set_thread_count(before);
    for (std::size_t i = 0; i < points.size(); ++i) {
        EXPECT_EQ(one[i].face, four[i].face);
        EXPECT_EQ(one[i].barycentric, four[i].barycentric);
    }
}

}  // namespace
}  // namespace beltrami
