#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <beltrami/generate/double_torus.h>
#include <beltrami/generate/grids.h>
#include <beltrami/registration/register_handles.h>

#include "support/cause_of.h"
#include "support/tori.h"

namespace beltrami {
namespace {

Mesh turned(Mesh mesh, double scale) {
    const Eigen::Matrix3d rotation =
        Eigen::AngleAxisd(2.0, Eigen::Vector3d(1, 2, -0.5).normalized()).toRotationMatrix();
    mesh.positions = scale * mesh.positions * rotation.transpose();
    mesh.positions.rowwise() += Eigen::RowVector3d(3, -1, 2);
    return mesh;
}

/// Without the mirror images that the double torus is of itself.
Mesh lopsided(Mesh mesh) {
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        const double x = mesh.positions(v, 0), y = mesh.positions(v, 1);
        mesh.positions(v, 1) = y * (1.2 + 0.2 * x);
        mesh.positions(v, 2) += 0.15 * x + 0.1 * y * y;
    }
    return mesh;
}

TEST(Alignment, FindsARotationAndTheScale) {
    const Mesh target = lopsided(double_torus(0.2)), source = turned(lopsided(double_torus(0.17)), 2.5);
    const Positions found = aligned(source, target, Alignment::similarity);
    const Positions exact = lopsided(double_torus(0.17)).positions;
    EXPECT_LT((found - exact).rowwise().norm().maxCoeff(), 0.05);
    EXPECT_EQ(aligned(source, target, Alignment::none), source.positions);
}

TEST(RegisterHandles, AlignedCopiesAreConformal) {
    const Surface target(lopsided(double_torus(0.15))), source(turned(lopsided(double_torus(0.17)), 2.5));
    const HyperbolicShape from(source), to(target);
    HandleMarking marking;
    marking.alignment = Alignment::similarity;
    const HandleRegistration found = register_handles(from, to, marking);
    EXPECT_LT(found.map.k, 0.01);
    EXPECT_TRUE(found.map.one_to_one());
    ASSERT_TRUE(found.inverse_k.has_value());
    EXPECT_LT(*found.inverse_k, 0.01);
}

TEST(RegisterHandles, DistancesLeadOverAThirdShape) {
    const auto stretched = [](double edge, double factor) {
        Mesh mesh = double_torus(edge);
        mesh.positions.col(1) *= factor;
        return mesh;
    };
    std::vector<Surface> surfaces;
    for (const auto& [edge, factor] : {std::pair{0.18, 1.0}, {0.16, 1.3}, {0.17, 0.75}})
        surfaces.emplace_back(stretched(edge, factor));
    const DistanceMatrix matrix = handle_distances(surfaces);
    EXPECT_TRUE(matrix.unsettled.empty());
    EXPECT_GT(matrix.distance(0, 1), 0.05);
    EXPECT_GT(matrix.distance(1, 2), matrix.distance(0, 1));
    EXPECT_LT(matrix.distance(1, 2), matrix.distance(0, 1) + matrix.distance(0, 2) + 2e-3);
    EXPECT_EQ(matrix.distance, matrix.distance.transpose());
}

TEST(RegisterTori, ClassesByLoopsPointsAndTwists) {
    const Surface source(torus(2, 1, 32, 16)), target(torus(std::sqrt(2.0), 1, 30, 24));
    const auto of_source = test::parallel_and_meridian(32, 16), of_target = test::parallel_and_meridian(30, 24);
    HandleMarking loops;
    loops.paths = {of_source[0], of_source[1]};
    loops.images = {of_target[0], of_target[1]};
    const TorusMap natural = register_tori(source, target, loops);
    EXPECT_NEAR(natural.K, std::sqrt(3.0), 0.02);
    EXPECT_NEAR(register_tori(source, target, HandleMarking{}).K, natural.K, 1e-9);
    EXPECT_NEAR(register_tori(source, target).K, natural.K, 1e-9);
    HandleMarking twisted;
    twisted.twists = {{of_source[0], 1}};
    EXPECT_NEAR(register_tori(source, target, twisted).K, 3.776668, 0.05);
    twisted.twists.push_back({of_source[0], -1});
    EXPECT_NEAR(register_tori(source, target, twisted).K, natural.K, 1e-9);
    loops.start = source.mesh.positions;
    EXPECT_EQ(test::cause_of([&] { register_tori(source, target, loops); }), Cause::bad_option);
}

TEST(RegisterHandles, MuIsKOnTheHandleThatTwistsLeaveAlone) {
    // There |φ| is a hundredth of its mean and less.
    const Surface source(double_torus(0.13)), target(double_torus(0.12));
    const HyperbolicShape from(source), to(target);
    const std::vector<int> loop = homology_basis(source).loops[0];
    HandleMarking marking;
    marking.twists = {{loop, 2}};
    const HandleRegistration found = register_handles(from, to, marking);
    ASSERT_TRUE(found.map.one_to_one());
    double x = 0;
    for (const int v : loop) x += source.mesh.positions(v, 0) / static_cast<double>(loop.size());
    double sum = 0, area = 0;
    for (int f = 0; f < source.mesh.face_count(); ++f) {
        const double at = source.mesh.point(source.mesh.faces[f][0]).x();
        if (at * x > 0 || std::abs(at) < 1.2) continue;
        sum += source.operators.weights[f] * found.map.distortion.face_abs_mu[f];
        area += source.operators.weights[f];
    }
    ASSERT_GT(area, 0.1 * source.operators.area());
    EXPECT_GT(found.map.k, 0.2);
    EXPECT_NEAR(sum / area, found.map.k, 0.05 * found.map.k);
    RecordProperty("far_from_the_loop", std::to_string(sum / area) + " of " + std::to_string(found.map.k));
}

}  // namespace
}  // namespace beltrami
