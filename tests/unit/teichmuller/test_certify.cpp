#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <beltrami/base/error.h>
#include <beltrami/meshing/planar_domains.h>
#include <beltrami/teichmuller/certify.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

void expect_consistent(const Certification& c, double gap) {
    EXPECT_LE(c.result.K_lower_proved, c.result.K_lower);
    EXPECT_LE(c.result.K_lower, c.result.K);
    EXPECT_LE(c.result.K, c.result.K_max);
    EXPECT_LE(c.result.K_lower_proved, c.K_upper);
    EXPECT_LE(c.result.K, c.K_upper);
    EXPECT_EQ(c.reached, c.gap <= gap);
    EXPECT_EQ(c.reason.starts_with(c.reached ? "proved: K* in [" : "not proved: "), true) << c.reason;
    EXPECT_EQ(c.gap, c.K_upper / c.result.K_lower_proved - 1);
    double best = 1;
    for (const Bound& bound : c.result.bounds)
        if (bound.kind == Bound::Kind::reich_strebel ||
            (bound.rigorous && bound.of == Bound::Of::extremal && bound.kind != Bound::Kind::attained &&
             bound.kind != Bound::Kind::verified))
            best = std::max(best, bound.K);
    EXPECT_EQ(best, c.result.K_lower);
}

TEST(Certify, AnExactMapAtOnce) {
    const Surface surface(disk(14));
    const Certification c = certify(surface, test::boundary_values(surface, test::exact_composition), 1.2e-2);
    expect_consistent(c, 1.2e-2);
    EXPECT_TRUE(c.reached) << c.reason;
    EXPECT_EQ(c.refinements, 0);
    EXPECT_NEAR(c.result.K_lower_proved, 3, 2e-3);  // K* of the polygon is a little larger than 3
    EXPECT_GT(c.K_upper, 3.0006);                   // which the quadratic bound shows
}

TEST(Certify, EstimatesAreImprovedWhereNothingIsProved) {
    const Surface surface(disk(14));
    CertifyOptions limits;
    limits.most_proof_triangles = 500;
    const Certification c = certify(surface, test::boundary_values(surface, test::three_lobes), 1.2e-3, {}, limits);
    expect_consistent(c, 1.2e-3);
    EXPECT_FALSE(c.reached);
    EXPECT_TRUE(std::isinf(c.K_upper));
    EXPECT_LE(c.estimated_gap, 1.2e-3) << c.reason;
    EXPECT_GE(c.refinements, 1);
    EXPECT_EQ(c.result.map.size(), surface.mesh.vertex_count());
    // The finer mesh's chart is not exact; what the given mesh proves is still told.
    int proofs = 0, estimates = 0;
    for (const Bound& bound : c.result.bounds)
        if (bound.kind == Bound::Kind::reich_strebel) ++(bound.rigorous ? proofs : estimates);
    EXPECT_EQ(proofs, 1);
    EXPECT_EQ(estimates, 1);
}

TEST(Certify, ThreeHoles) {
    DomainOptions domain;
    domain.edge_length = 0.08;
    const Surface surface(circle_domain({}, {{{0.45, 0}, 0.15}, {{-0.3, 0.4}, 0.18}, {{-0.3, -0.4}, 0.12}}, domain));
    const BoundaryCondition boundary =
        test::boundary_values(surface, [](Complex z) { return z + 0.25 * std::conj(z) + 0.1 * z * z; });
    const Certification c = certify(surface, boundary, 1e-2);
    expect_consistent(c, 1e-2);
    EXPECT_LE(c.estimated_gap, 1e-2);
    EXPECT_TRUE(std::isfinite(c.K_upper));
    EXPECT_LT(c.K_upper, 1.03 * c.result.K) << c.reason;
}

TEST(Certify, SaysWhyNot) {
    const Surface surface(disk(10));
    const BoundaryCondition lobes = test::boundary_values(surface, test::three_lobes);
    CertifyOptions limits;
    limits.most_triangles = 1000;
    limits.most_proof_triangles = 700;
    const Certification large = certify(surface, lobes, 1e-7, {}, limits);
    expect_consistent(large, 1e-7);
    EXPECT_FALSE(large.reached);
    EXPECT_NE(large.reason.find("2400 faces"), std::string::npos) << large.reason;
    limits = {};
    limits.most_refinements = 0;
    const Certification none = certify(surface, lobes, 1e-7, {}, limits);
    EXPECT_FALSE(none.reached);
    EXPECT_NE(none.reason.find("limit"), std::string::npos) << none.reason;

    // A circle sent to a square at even speed: K* ≥ 2 at the corners, whatever happens inside.
    const Surface round(disk(14));
    const Certification corner =
        certify(round,
                test::boundary_values(round,
                                      [](Complex z) {
                                          double t = std::arg(z) / (0.5 * std::numbers::pi);
                                          const double side = std::floor(t);
                                          t -= side;
                                          return std::polar(1.0, 0.5 * std::numbers::pi * side) * Complex(1 - t, t);
                                      }),
                1e-2, {}, limits);
    expect_consistent(corner, 1e-2);
    EXPECT_GE(corner.result.K_lower_proved, 1.9);  // proved by single vertices: 2 but for the round outline's corner
    EXPECT_FALSE(corner.reached);

    EXPECT_THROW(certify(surface, lobes, 0), Error);
    EXPECT_THROW(certify(surface, lobes, std::nan("")), Error);
    limits.least_progress = 1;
    EXPECT_THROW(certify(surface, lobes, 0.1, {}, limits), Error);
    ExtremalOptions cancelled;
    cancelled.progress = [](int, double) { return false; };
    EXPECT_THROW(certify(surface, lobes, 0.1, cancelled), Error);
}

}  // namespace
}  // namespace beltrami
