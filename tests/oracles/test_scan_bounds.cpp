// What is said about K of real scans does not contradict itself: without certificate and with, with slack and without.
// Skipped where the scans are absent.
#include <gtest/gtest.h>

#include <limits>
#include <string>

#include <beltrami/charts/boundary_values.h>
#include <beltrami/forms/cut_open.h>
#include <beltrami/io/read_mesh.h>
#include <beltrami/teichmuller/certify.h>
#include <beltrami/teichmuller/extremal_map.h>

#include "support/real_mesh.h"

namespace beltrami {
namespace {

constexpr double kRounding = 1 + 1e-9;
/// An iteration that ends farther below what is proved has not found the extremal map.
constexpr double kErrorOfEstimate = 0.99;

/// K_upper is infinite where nothing is verified.
void expect_no_contradiction(const ExtremalMap& map, double K_upper) {
    EXPECT_TRUE(map.distortion.flipped.empty());
    EXPECT_LE(map.K_lower_proved, map.K_lower);
    EXPECT_LE(map.K_lower, map.K * kRounding);
    EXPECT_LE(map.K, map.K_max * kRounding);
    EXPECT_LE(map.K, K_upper * kRounding);
    EXPECT_LE(map.K_lower_proved, K_upper * kRounding);
    EXPECT_DOUBLE_EQ(map.K, (1 + map.k) / (1 - map.k));
    for (const Bound& bound : map.bounds) {
        SCOPED_TRACE(to_string(bound.kind));
        // Also what single vertices of the polygons force is attained by every map of them.
        const bool upper = bound.kind == Bound::Kind::attained || bound.kind == Bound::Kind::verified;
        if (upper) {
            EXPECT_GE(bound.K * kRounding, map.K_lower_proved);
        } else if (bound.rigorous) {
            EXPECT_LE(bound.K, map.K_max * kRounding);
        }
        if (bound.proves_from_below()) {
            EXPECT_LE(bound.K, map.K_lower_proved);
        }
        if (bound.kind == Bound::Kind::reich_strebel_estimate && bound.K < kErrorOfEstimate * map.K_lower_proved &&
            map.K_max > map.K_lower_proved / kErrorOfEstimate) {
            EXPECT_NE(map.termination, Termination::converged);
        }
    }
    if (map.termination == Termination::converged) {
        EXPECT_LE(map.K, 1.1 * map.K_lower);
    }
}

struct Scan {
    const char* name;
    bool closed = false;  ///< to be cut open along edges
};

class ScanBounds : public testing::TestWithParam<Scan> {};

TEST_P(ScanBounds, DoNotContradictEachOther) {
    const auto file = test::real_mesh(GetParam().name);
    if (file.empty()) GTEST_SKIP() << "no scans in BELTRAMI_TEST_MESHES";
    const Surface given(read_mesh(file).mesh);
    const Surface source = GetParam().closed ? Surface(cut_open(given).disk) : given;
    ASSERT_EQ(source.topology.boundary_loops.size(), 1u);
    const Constraints constraints{boundary_to_disk(source, 0.5)};
    for (const double slack : {0.0, 0.5}) {
        SCOPED_TRACE("slack " + std::to_string(slack));
        ExtremalOptions options;
        options.slack = slack;
        const ExtremalMap plain = extremal_map(source, constraints, options);
        expect_no_contradiction(plain, std::numeric_limits<double>::infinity());
        CertifyOptions limits;
        limits.most_refinements = 0;
        limits.most_proof_triangles = 1;  // what is proved from below is enough here, and quick
        const Certification certified = certify(source, constraints, 0.05, options, limits);
        expect_no_contradiction(certified.result, certified.K_upper);
        // The same problem, whatever is known of it.
        EXPECT_LE(plain.K_lower_proved, certified.K_upper * kRounding);
    }
}

INSTANTIATE_TEST_SUITE_P(Disks, ScanBounds,
                         testing::Values(Scan{"hand_disk.obj"}, Scan{"camel_b.obj"}, Scan{"human_face.obj"},
                                         Scan{"chinese_lion.obj"}, Scan{"hippocampus.obj", true}),
                         [](const auto& scan) {
                             const std::string name = scan.param.name;
                             return name.substr(0, name.find('.'));
                         });

/// Along the legs of the camel boundary values crowd: K is that of quadratic elements there.
TEST(CrowdedScan, HasABracketOfOnePerCent) {
    const auto file = test::real_mesh("camel_b.obj");
    if (file.empty()) GTEST_SKIP() << "no scans in BELTRAMI_TEST_MESHES";
    const Surface source(read_mesh(file).mesh);
    for (const double slack : {0.0, 0.5, 1.0}) {
        SCOPED_TRACE("slack " + std::to_string(slack));
        ExtremalOptions options;
        options.slack = slack;
        const ExtremalMap map = extremal_map(source, boundary_to_disk(source, 0.5), options);
        expect_no_contradiction(map, std::numeric_limits<double>::infinity());
        EXPECT_EQ(map.termination, Termination::converged);
        EXPECT_LT(map.K, 1.01 * map.K_lower);
        EXPECT_GT(map.K_lower, 6.3);
        EXPECT_EQ(map.phi.size(), (map.split ? map.split->mesh : source.mesh).face_count());
    }
}

}  // namespace
}  // namespace beltrami
