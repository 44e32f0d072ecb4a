// Corners of the source, of the image and of the speed of the boundary values.
#include <gtest/gtest.h>

#include "support/extremal.h"

namespace beltrami {
namespace {

using test::expect_sound;
using test::solve;
using test::Solved;

TEST(Corners, SectorConverges) {
    // k errors measured: 2.7e-4, 4.5e-4, 1.4e-4 at 1 250, 5 000, 20 000 triangles; vertices within 4e-3, 2e-3, 2e-3.
    for (const auto& [edge_length, k_tolerance, vertex_tolerance] :
         {std::tuple(0.04, 1e-3, 8e-3), std::tuple(0.02, 1e-3, 4e-3)}) {
        const Solved solved = solve(bench::sector(edge_length));
        expect_sound(solved.result);
        EXPECT_EQ(solved.result.termination, Termination::converged);
        EXPECT_NEAR(solved.result.k, 1.0 / 3, k_tolerance);
        EXPECT_LE(solved.result.K_lower, 2.0);
        EXPECT_GE(solved.result.K_lower, 1.98);
        EXPECT_LT(solved.vertex_error, vertex_tolerance);
    }
}

TEST(Corners, FourPointsOfTheCircle) {
    double last = 1;
    for (const auto& [edge_length, K_tolerance] : {std::pair(0.08, 0.01), std::pair(0.04, 0.004)}) {
        const Solved solved = solve(bench::four_points(edge_length));
        expect_sound(solved.result);
        EXPECT_EQ(solved.result.termination, Termination::converged);
        EXPECT_NEAR(solved.result.K / solved.exact_K, 1, K_tolerance);
        EXPECT_LE(solved.result.K_lower, solved.exact_K);
        EXPECT_LT(solved.vertex_error, 0.02);
        EXPECT_LT(solved.vertex_error, 0.5 * last);
        last = solved.vertex_error;
    }
}

TEST(Corners, TheHalfPlaneMapIsNotOfTeichmuellerType) {
    double last = 0;
    for (const double edge_length : {0.08, 0.04}) {
        const Solved solved = solve(bench::half_plane_square(edge_length));
        expect_sound(solved.result);
        EXPECT_EQ(solved.result.termination, Termination::not_teichmuller);
        ASSERT_TRUE(solved.result.sharpest);
        // |z|z has its two singular points at ±1 on the circle.
        const Complex at = bench::place(solved.problem.mesh, solved.result.sharpest->vertex);
        EXPECT_LT(std::abs(std::abs(at.real()) - 1), 1e-9) << at;
        EXPECT_LT(std::abs(at.imag()), 1e-9) << at;
        EXPECT_GT(solved.result.sharpest->safe_bound, solved.result.K);
        EXPECT_LE(solved.result.sharpest->safe_bound, 2.0);
        EXPECT_LE(solved.result.K_lower, 2.0);
        EXPECT_NE(solved.result.warnings[0].sentence.find("vertex " + std::to_string(solved.result.sharpest->vertex)),
                  std::string::npos);
        EXPECT_GT(solved.result.sharpest->safe_bound, last);
        last = solved.result.sharpest->safe_bound;
    }
}

// The source's chart is far from conformal at 48 corners, but with conformal angles the problem is one of the round
// disk and φ smooth: K is that of the disk's boundary values e^{i(t + 0.6 sin t)}.
TEST(Corners, TheGearIsMappedLikeTheDisk) {
    const Mesh round = disk(40);
    BoundaryCondition boundary;
    const Topology shape = topology(round);
    for (const int v : shape.boundary_loops[0]) {
        const double t = std::arg(bench::place(round, v));
        boundary.pin(v, std::polar(1.0, t + 0.6 * std::sin(t)));
    }
    const double K = extremal_map(round, boundary).K;
    for (const auto& [edge_length, gap] : {std::pair(0.05, 0.012), std::pair(0.03, 0.006)}) {
        const Solved solved = solve(bench::gear_to_disk(edge_length));
        expect_sound(solved.result);
        EXPECT_EQ(solved.result.termination, Termination::converged);
        EXPECT_LE(solved.result.iterations, 10);
        EXPECT_NEAR(solved.result.K, K, 1.5e-3);
        EXPECT_LE(solved.result.K_lower, K);
        EXPECT_LT(solved.result.K / solved.result.K_lower, 1 + gap);
    }
}

struct Outline {
    const char* name;
    bench::Problem (*make)(double);
    double coarse, fine, gap;
};

std::ostream& operator<<(std::ostream& out, const Outline& shape) {
    return out << shape.name;
}

class Shapes : public testing::TestWithParam<Outline> {};

// No closed forms: the bracket of the fine mesh lies in that of the coarse one, up to what the coarse polygon is off.
TEST_P(Shapes, AreOneToOneWithABracketThatShrinks) {
    const auto& [name, make, coarse_length, fine_length, gap] = GetParam();
    // The bound of piecewise linear maps on both: by itself the sharpened one is taken where that is poor.
    ExtremalOptions options;
    options.sharpen = -1;
    const Solved coarse = solve(make(coarse_length), options), fine = solve(make(fine_length), options);
    for (const Solved* solved : {&coarse, &fine}) {
        expect_sound(solved->result);
        EXPECT_EQ(solved->result.termination, Termination::converged);
    }
    const auto width = [](const ExtremalMap& map) { return map.K / map.K_lower - 1; };
    EXPECT_LT(width(fine.result), width(coarse.result));
    EXPECT_LT(width(fine.result), gap);
    EXPECT_GE(fine.result.K_lower, coarse.result.K_lower * (1 - 1e-3));
    EXPECT_LE(fine.result.K_lower, coarse.result.K_max);
}
INSTANTIATE_TEST_SUITE_P(Corners, Shapes,
                         testing::Values(Outline{"arrow_head_45", bench::arrow_head_45, 0.033, 0.0167, 0.006},
                                         Outline{"arrow_head_65", bench::arrow_head_65, 0.033, 0.0167, 0.015},
                                         Outline{"l_to_square", bench::l_to_square, 0.025, 0.0167, 0.006},
                                         Outline{"wedge", bench::wedge, 0.033, 0.0167, 0.006}),
                         [](const auto& parameter) { return parameter.param.name; });

// Boundary values whose speed jumps at corners, notches, teeth: one-to-one, a bracket, and a cause where it is wide.
class JaggedShapes : public testing::TestWithParam<Outline> {};

TEST_P(JaggedShapes, AreOneToOneOrSayWhyNotExtremal) {
    const Solved solved = solve(GetParam().make(GetParam().coarse));
    expect_sound(solved.result);
    EXPECT_TRUE(solved.result.K / solved.result.K_lower < 1 + GetParam().gap || !solved.result.warnings.empty());
    if (solved.result.termination == Termination::not_teichmuller) {
        EXPECT_GT(solved.result.sharpest->safe_bound, solved.result.K);
    }
}
INSTANTIATE_TEST_SUITE_P(Corners, JaggedShapes,
                         testing::Values(Outline{"notched_disk", bench::notched_disk, 0.05, 0, 0.02},
                                         Outline{"disk_to_gear", bench::disk_to_gear, 0.05, 0, 0.02}),
                         [](const auto& parameter) { return parameter.param.name; });

}  // namespace
}  // namespace beltrami
