#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include <beltrami/generate/round_domains.h>
#include <beltrami/generate/sphere.h>
#include <beltrami/solve/target_step.h>
#include <beltrami/targets/simple_targets.h>

namespace beltrami {
namespace {

ImageFrame frame_of(Complex p, Complex q) {
    ImageFrame frame;
    frame.p = p;
    frame.q = q;
    frame.upright = std::norm(q) < std::norm(p);
    return frame;
}

/// The gradient of a sample's term is that of half of its value; for the perturbation, which has no energy, v is what
/// is to vanish.
TEST(TargetEnergy, ItsTermsAreItsDerivatives) {
    const Complex p(1.1, 0.3), q(0.2, -0.3), dp(0.3, -0.7), dq(-0.4, 0.5);
    const Eigen::VectorXcd sigma = Eigen::VectorXcd::Constant(1, Complex(0.1, 0.2));
    const std::unique_ptr<TargetEnergy> energies[] = {
        std::make_unique<ResidualEnergy>(sigma, std::vector<double>{0.7}),
        std::make_unique<BarrierEnergy>(sigma, std::vector<double>{0.7}),
        std::make_unique<BarrierEnergy>(sigma, std::vector<double>{0.7}, 4)};
    for (const auto& energy : energies) {
        const double h = 1e-6;
        const double slope =
            (energy->value(frame_of(p + h * dp, q + h * dq), 0) - energy->value(frame_of(p - h * dp, q - h * dq), 0)) /
            (2 * h);
        const SampleTerm term = energy->term(frame_of(p, q), 0);
        const Complex v = term.of_dzbar * dq + term.of_dz * dp;
        EXPECT_NEAR(2 * std::real(std::conj(term.gradient) * v), slope, 1e-7 * std::abs(slope));
        EXPECT_GT(std::abs(slope), 1e-3);
    }
}

/// The barrier's quadratic term is its second derivative where the wanted coefficient is reached.
TEST(TargetEnergy, TheBarrierIsQuadraticAtItsMinimum) {
    const Complex sigma(0.1, 0.2), p(1.1, 0.3);
    const BarrierEnergy energy(Eigen::VectorXcd::Constant(1, sigma), {0.7});
    const SampleTerm term = energy.term(frame_of(p, sigma * p), 0);
    for (const Complex dq : {Complex(1, 0), Complex(0, 1), Complex(0.6, -0.8)}) {
        const double h = 1e-4;
        const Complex v = term.of_dzbar * dq;
        const double quadratic = term.along * v.real() * v.real() + term.across * v.imag() * v.imag();
        EXPECT_NEAR(energy.value(frame_of(p, sigma * p + h * dq), 0) / (h * h), quadratic, 1e-3 * quadratic);
    }
}

TEST(TargetEnergy, TheBarrierIsInfiniteAtAFold) {
    const BarrierEnergy energy(Eigen::VectorXcd::Zero(1), {1.0});
    EXPECT_TRUE(std::isinf(energy.value(frame_of(1, 1), 0)));
    EXPECT_TRUE(std::isinf(energy.value(frame_of(0.5, 1), 0)));
    EXPECT_NEAR(energy.value(frame_of(2, 1), 0), 0.25 / 0.75, 1e-15);
}

TEST(ImageFrame, TurnsFlippedSamplesOver) {
    const Surface source(octahedral_sphere(1));
    Positions points = source.mesh.positions;
    for (int s = 0; s < source.operators.sample_count(); ++s)
        EXPECT_TRUE(image_frame(source.operators, s, points, points).upright);
    points.row(6) = -points.row(6);
    int flipped = 0;
    for (int s = 0; s < source.operators.sample_count(); ++s) {
        const ImageFrame frame = image_frame(source.operators, s, points, points);
        EXPECT_EQ(frame.upright, std::norm(frame.q) < std::norm(frame.p));
        flipped += !frame.upright;
    }
    EXPECT_GT(flipped, 0);
}

/// Vertices that slide stay on their circle, and those inside come along by what it bends.
TEST(TargetMotion, KeepsTheRimOnItsCircle) {
    const Surface source(disk(6));
    const PlaneTarget plane;
    TargetConstraints constraints;
    constraints.fixed = {0};
    constraints.slide(source.topology.boundary_loops[0], std::make_shared<PlanarSlideCurve>(TargetCurve::circle(0, 1)));
    const TargetMotion motion(source, plane, constraints);
    const TargetMap map = target_map(source, plane, constraints, source.mesh.positions);
    Positions turn = Positions::Zero(source.mesh.vertex_count(), 3);
    for (const int v : source.topology.boundary_loops[0]) {
        const Eigen::Vector3d way = motion.directions(v, map, map.points[v].normal)[0];
        EXPECT_LT(std::abs(way.dot(map.points[v].position)), 1e-12);
        turn.row(v) = 0.3 * way.transpose();
    }
    const TargetMap moved = motion.moved(map, turn, 1);
    for (const int v : source.topology.boundary_loops[0]) {
        EXPECT_NEAR(moved.points[v].position.norm(), 1, 1e-12);
        EXPECT_NEAR(std::acos(moved.points[v].position.dot(map.points[v].position)), 0.3, 1e-9);
    }
    EXPECT_EQ(moved.points[0].position, map.points[0].position);
    double inward = 0;
    for (int v = 1; v < 7; ++v) inward = std::max(inward, (moved.points[v].position - map.points[v].position).norm());
    EXPECT_GT(inward, 1e-4);
    EXPECT_LT(inward, 0.05);
}

}  // namespace
}  // namespace beltrami
