#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include <beltrami/charts/boundary_values.h>
#include <beltrami/io/read_mesh.h>
#include <beltrami/teichmuller/extremal_map.h>

#include "support/meshes.h"
#include "support/real_mesh.h"

namespace beltrami {
namespace {

/// Composition f = exp(0.6(g + ½ḡ)) on a disk: k = ½, K = 3, known at every point.
struct Composition {
    ExtremalMap result;
    double vertex_error = 0, interpolated_deviation = 0;

    explicit Composition(int triangles) {
        const Mesh mesh = disk(disk_rings_for_triangles(triangles));
        const Surface surface(mesh);
        result = extremal_map(surface, test::boundary_values(surface, test::exact_composition));
        const Eigen::VectorXcd exact =
            test::complex_positions(mesh).unaryExpr([](Complex z) { return test::exact_composition(z); });
        vertex_error = (result.map - exact).cwiseAbs().maxCoeff();
        interpolated_deviation = distortion(surface.operators, exact).standard_deviation;
    }
};

TEST(ExactComposition, At4500And70000Triangles) {
    const Composition coarse(4500), fine(70000);
    EXPECT_NEAR(coarse.result.k, 0.5, 5e-4);
    EXPECT_NEAR(fine.result.k, 0.5, 1e-4);
    for (const Composition* c : {&coarse, &fine}) {
        EXPECT_EQ(c->result.termination, Termination::converged);
        EXPECT_TRUE(c->result.distortion.flipped.empty());
        EXPECT_LE(c->result.distortion.standard_deviation, 1.15 * c->interpolated_deviation);
        EXPECT_LE(c->result.K_lower, 3.0);
        EXPECT_GE(c->result.K_lower, 3.0 * (1 - 0.002));
        EXPECT_LE(c->result.K_lower, c->result.K);
        EXPECT_LE(c->result.K, c->result.K_max);
        EXPECT_TRUE(c->result.bounds[0].rigorous);
    }
}

TEST(ExactComposition, VertexErrorIsOfSecondOrder) {
    double last = 0;
    for (const int triangles : {1500, 6000, 24000}) {
        const double error = Composition(triangles).vertex_error;
        if (last > 0) {
            EXPECT_GE(std::log2(last / error), 1.8);
        }
        last = error;
    }
}

TEST(ThreeLobes, UnfoldsAHarmonicStartWithMoreThanAHundredFlips) {
    const Surface surface(disk(disk_rings_for_triangles(4500)));
    const ExtremalMap result = extremal_map(surface, test::boundary_values(surface, test::three_lobes));
    EXPECT_GT(distortion(surface.operators, result.harmonic).flipped.size(), 100u);
    EXPECT_TRUE(result.distortion.flipped.empty());
    EXPECT_NEAR(result.k, 0.2908, 3e-4);
    EXPECT_LE(result.K_lower, 1.8200);
    EXPECT_GE(result.K_lower, 1.81);
}

TEST(RealScan, HumanFaceToTheDisk) {
    const std::filesystem::path path = test::real_mesh("human_face.obj");
    if (path.empty()) GTEST_SKIP() << "no human_face.obj in BELTRAMI_TEST_MESHES";
    const Surface surface(read_mesh(path).mesh);
    const ExtremalMap result = extremal_map(surface, boundary_to_disk(surface, 0.5));
    EXPECT_TRUE(result.distortion.flipped.empty());
    EXPECT_NEAR(result.k, 0.184, 0.002);
    EXPECT_LE(result.distortion.standard_deviation, 0.025);
    EXPECT_LE((result.K - result.K_lower) / result.K, 0.01);
    EXPECT_LE(result.K_lower, result.K);
    EXPECT_LE(result.iterations, 12);
}

}  // namespace
}  // namespace beltrami
