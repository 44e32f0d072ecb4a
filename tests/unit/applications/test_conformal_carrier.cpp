#include <gtest/gtest.h>

#include <beltrami/applications/conformal_carrier.h>
#include <beltrami/meshing/planar_domains.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

Surface off_centre_ring(double edge_length) {
    DomainOptions options;
    options.edge_length = edge_length;
    return Surface(circle_domain({}, std::vector<Circle>{{{0.3, 0.1}, 0.3}}, options));
}

TEST(ConformalCarrier, OfARingLiesBetweenCirclesOfOneCentre) {
    const Surface ring = off_centre_ring(0.08);
    const ConformalCarrier carrier = conformal_carrier(ring);
    ASSERT_EQ(carrier.domain.curve_count(), 2);
    EXPECT_EQ(carrier.domain.holes[0].centre(), Complex(0));
    double least = 1;
    for (const int v : ring.topology.boundary_loops[1]) least = std::min(least, std::abs(carrier.map[v]));
    for (const int v : ring.topology.boundary_loops[1]) EXPECT_NEAR(std::abs(carrier.map[v]), least, 1e-12);
    for (const int v : ring.topology.boundary_loops[0]) EXPECT_NEAR(std::abs(carrier.map[v]), 1, 1e-12);
    // The error of linear elements is of first order in μ.
    EXPECT_LT(conformal_carrier(off_centre_ring(0.04)).distortion.mean, 0.6 * carrier.distortion.mean);
    EXPECT_LT(carrier.distortion.mean, 0.25 * 0.08);
    EXPECT_TRUE(carrier.one_to_one());
    EXPECT_EQ(carrier.termination, Termination::converged);
    EXPECT_TRUE(carrier.warnings.empty());
    EXPECT_FALSE(carrier.split);
}

TEST(ConformalCarrier, SplitsBridges) {
    const Surface square(test::jittered_square(6));  // its corners have ears
    const ConformalCarrier carrier = conformal_carrier(square);
    ASSERT_TRUE(carrier.split);
    EXPECT_EQ(carrier.map.size(), carrier.split->mesh.vertex_count());
    EXPECT_GT(carrier.map.size(), square.mesh.vertex_count());
}

}  // namespace
}  // namespace beltrami
