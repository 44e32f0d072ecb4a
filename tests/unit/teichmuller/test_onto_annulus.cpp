#include <beltrami/teichmuller/onto_annulus.h>

#include <gtest/gtest.h>

#include <cmath>

#include <beltrami/charts/annulus_map.h>
#include <beltrami/mesh/submesh.h>

#include "support/meshes.h"

namespace beltrami {
namespace {

/// The ring .5 < |z| < 1 with a finger that reaches into its hole: at the tip no harmonic function sees anything.
Mesh ring_with_finger() {
    const Mesh whole = annulus(0.1, 1, 128);
    std::vector<int> kept;
    for (int f = 0; f < whole.face_count(); ++f) {
        Complex middle = 0;
        for (const int v : whole.faces[f]) middle += Complex(whole.positions(v, 0), whole.positions(v, 1)) / 3.0;
        if (std::abs(middle) > 0.5 || std::abs(std::arg(middle)) < 0.11) kept.push_back(f);
    }
    return keep_faces(whole, kept).mesh;
}

TargetDomain round_ring(double radius) {
    return target_domain(TargetCurve::circle({0.5, -0.25}, 2), {TargetCurve::circle({0.5, -0.25}, 2 * radius)});
}

TEST(OntoAnnulus, APlainRingIsNotCrowded) {
    const Surface source(annulus(0.2, 1, 64));
    EXPECT_FALSE(crowded_annulus_onto_ring(source, *target_model(round_ring(0.3), 0.1), {}));
}

TEST(OntoAnnulus, CirclesNeedNotBeConcentric) {
    const Surface source(annulus(0.2, 1, 64));
    const Complex centre(0.5, -0.25), hole(0.9, 0.35);
    const TargetDomain target = target_domain(TargetCurve::circle(centre, 2), {TargetCurve::circle(hole, 0.8)});
    const auto direct = annulus_onto_ring(source, *target_model(target, 0.1), {});
    ASSERT_TRUE(direct);
    EXPECT_TRUE(direct->distortion.flipped.empty());
    for (int v = 0; v < source.mesh.vertex_count(); ++v) {
        if (!source.topology.on_boundary[v]) continue;
        const double radius = std::hypot(source.mesh.positions(v, 0), source.mesh.positions(v, 1));
        EXPECT_NEAR(std::abs(direct->map[v] - (radius > 0.5 ? centre : hole)), radius > 0.5 ? 2 : 0.8, 1e-9);
    }
    for (const LoopOnto& loop : direct->loops) {
        EXPECT_NEAR(loop.area_ratio, 1, 0.02);
        EXPECT_TRUE(std::is_sorted(loop.parameters.begin(), loop.parameters.end()));
    }
    // The iteration ends there too.
    const ExtremalMap whole = extremal_map(source, target);
    EXPECT_GT(whole.iterations, 0);
    EXPECT_NEAR(whole.K, direct->K, 5e-3 * direct->K);
    EXPECT_LE(direct->K_lower, whole.K);
    EXPECT_LE(whole.K, direct->K_upper);
    EXPECT_NEAR(direct->distortion.mean, direct->k, 0.02);
}

TEST(LargeOntoAnnulus, AFingerIsMappedWithoutFoldsInARigorousBracket) {
    const Surface source(ring_with_finger());
    ASSERT_EQ(source.topology.boundary_loops.size(), 2u);
    const AnnulusPotentials potentials = annulus_potentials(source, 0);
    EXPECT_GE(potentials.u_energy * potentials.v_energy, 1);
    EXPECT_LE(potentials.u_energy * potentials.v_energy, 1.01);
    for (const auto& loop : potentials.increments) {
        double sum = 0;
        for (const double step : loop) sum += step;
        EXPECT_NEAR(std::abs(sum), 1, 1e-9);
    }
    for (const double radius : {0.2, 0.4, 0.8}) {
        const auto model = target_model(round_ring(radius), 0.1);
        const auto direct = crowded_annulus_onto_ring(source, *model, {});
        ASSERT_TRUE(direct);
        // At the end of the finger faces are smaller than 1e-14 of the image, but none is turned over.
        EXPECT_TRUE(direct->distortion.flipped.empty());
        EXPECT_LE(direct->K_lower, direct->K);
        EXPECT_LE(direct->K, direct->K_upper);
        EXPECT_LE(direct->K_upper, 1.01 * direct->K_lower);
        EXPECT_LE(direct->K, direct->K_max);
        EXPECT_NEAR(direct->distortion.mean, direct->k, 0.05);
        for (const LoopOnto& loop : direct->loops) {
            EXPECT_NEAR(loop.area_ratio, 1, 0.01);
            EXPECT_TRUE(std::is_sorted(loop.parameters.begin(), loop.parameters.end()));
        }
        for (const int l : {0, 1})
            for (const int v : source.topology.boundary_loops[l])
                EXPECT_NEAR(std::abs(direct->map[v] - Complex(0.5, -0.25)), l == 0 ? 2 : 2 * radius, 1e-12);
        // The way through the whole solver is the same.
        const ExtremalMap whole = extremal_map(source, round_ring(radius));
        EXPECT_EQ(whole.iterations, 0);
        EXPECT_EQ(whole.K, direct->K);
    }
}

}  // namespace
}  // namespace beltrami
