#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <beltrami/generate/double_torus.h>
#include <beltrami/mesh/subdivide.h>
#include <beltrami/meshing/edge_collapse.h>
#include <beltrami/registration/register_handles.h>

#include "problems/level_surface.h"
#include "problems/square_tiled.h"
#include "support/cause_of.h"

namespace beltrami {
namespace {

using bench::TiledSurface;

/// A map between two surfaces of the same tiling, vertices near their places.
HyperbolicMap tiled_map(const bench::SquareTiling& tiling, int from, int to, Complex mu,
                        const std::vector<std::pair<std::vector<std::array<int, 3>>, int>>& twists = {}) {
    const TiledSurface a = tiled_surface(tiling, from), b = tiled_surface(tiling, to, mu, 0.4);
    const HyperbolicShape source(a.surface), target(b.surface);
    EquivariantMap start =
        marking_by_vertices(a.surface, source.metric().original, target.group(), same_places(a, b)).map;
    for (const auto& [places, turns] : twists) {
        std::vector<int> path;
        for (const auto& [square, i, j] : places) path.push_back(a.vertex(square, i, j));
        start = twisted(a.surface, source.metric().original, std::move(start), path, turns);
    }
    return hyperbolic_map(source, target, std::move(start));
}

TEST(HyperbolicMap, AffineMapsOfTheLAreExact) {
    std::array<double, 2> before{};
    for (const int k : {8, 16}) {
        const std::array<HyperbolicMap, 2> maps{tiled_map(bench::l_shaped(), k, 11 * k / 8, std::polar(0.2, 0.4)),
                                                tiled_map(bench::l_shaped(), k, 11 * k / 8, std::polar(0.5, 1.0))};
        for (std::size_t i = 0; i < 2; ++i) {
            const double exact = i == 0 ? 0.2 : 0.5, error = std::abs(maps[i].k - exact);
            RecordProperty("k" + std::to_string(i) + "_" + std::to_string(k), std::to_string(maps[i].k));
            // dz² is the square of a 1-form, so that homology asks for K itself, and the mesh's K is below.
            EXPECT_EQ(maps[i].termination,
                      maps[i].K_homology > maps[i].K * 1.001 ? Termination::below_bound : Termination::converged);
            EXPECT_TRUE(maps[i].one_to_one());
            EXPECT_LE(maps[i].history.size(), 16u);
            if (before[i] > 0) {
                EXPECT_GT(std::log2(before[i] / error), 1.5);
            }
            before[i] = error;
        }
    }
    EXPECT_LT(before[0], 1.1e-3);
    EXPECT_LT(before[1], 4.8e-3);
}

/// The Dehn twist about the lower cylinder, of two squares, and the square of that about the upper one: of the affine
/// map [[1, 2], [0, 1]], K = (1 + √2)².
TEST(HyperbolicMap, MultiTwistOfTheL) {
    double before = 0;
    for (const int k : {8, 16}) {
        std::vector<std::array<int, 3>> lower, upper;
        for (int i = 0; i < 2 * k; ++i) lower.push_back({i / k, i % k, k / 2});
        for (int i = 0; i < k; ++i) upper.push_back({2, i, k / 2});
        const HyperbolicMap plus = tiled_map(bench::l_shaped(), k, 11 * k / 8, 0, {{lower, 1}, {upper, 2}}),
                            minus = tiled_map(bench::l_shaped(), k, 11 * k / 8, 0, {{lower, -1}, {upper, -2}});
        RecordProperty("k_" + std::to_string(k), std::to_string(plus.k) + " " + std::to_string(minus.k));
        const double error = std::abs(plus.k - std::sqrt(0.5));
        EXPECT_TRUE(plus.one_to_one());
        EXPECT_TRUE(minus.one_to_one());
        EXPECT_NEAR(plus.k, minus.k, 2e-3);
        if (before > 0) {
            EXPECT_GT(before / error, 2);
        }
        before = error;
    }
    EXPECT_LT(before, 8.5e-3);
}

TEST(HyperbolicMap, HalfTranslationSurfaces) {
    struct Case {
        int squares;
        std::vector<int> angles;
        double largest_error;
    };
    for (const Case& c : {Case{5, {6, 6, 8}, 1.2e-3}, Case{7, {4, 8, 16}, 4.5e-3}}) {
        const bench::SquareTiling tiling = bench::half_translation(c.squares, c.angles);
        double before = 0;
        for (const auto& [from, to] : {std::pair{7, 11}, {15, 23}}) {
            const HyperbolicMap map = tiled_map(tiling, from, to, std::polar(0.3, 0.7));
            RecordProperty("k_" + std::to_string(c.squares) + "_" + std::to_string(from), std::to_string(map.k));
            const double error = std::abs(map.k - 0.3);
            EXPECT_TRUE(map.one_to_one());
            EXPECT_LT(map.K_homology, map.K);  // φ is no square: the homology does not tell all
            if (before > 0) {
                EXPECT_GT(std::log2(before / error), 1.5);
            }
            before = error;
        }
        EXPECT_LT(before, c.largest_error);
    }
}

TEST(HyperbolicSpace, EigenvaluesAreZeroAndOneHalf) {
    double before = 0;
    for (const double edge : {0.2, 0.1}) {
        const Surface surface(double_torus(edge));
        const HyperbolicShape shape(surface);
        const HyperbolicShape::Differentials& q = shape.differentials();
        EXPECT_EQ(q.space->size(), 3);
        EXPECT_GT(q.kernel.minCoeff(), 0);
        EXPECT_NEAR(q.next, 0.5, 0.03);
        EXPECT_LE(q.solves, 60);
        if (before > 0) {
            EXPECT_GT(std::log2(before / q.kernel.maxCoeff()), 1.6);
        }
        before = q.kernel.maxCoeff();
    }
    EXPECT_LT(before, 5e-3);
}

struct Deformed {
    Surface source, target;
    HyperbolicShape from, to;

    static Mesh stretched(Mesh mesh) {
        for (int v = 0; v < mesh.vertex_count(); ++v) {
            mesh.positions(v, 1) *= 1.3 + 0.1 * mesh.positions(v, 0);
            mesh.positions(v, 2) += 0.1 * mesh.positions(v, 0);
        }
        return mesh;
    }
    Deformed() : source(double_torus(0.14)), target(stretched(double_torus(0.11))), from(source), to(target) {}

    EquivariantMap start() const {
        return marking_by_vertices(
                   source, from.metric().original, to.group(),
                   nearest_vertices(target.mesh, to.metric().metric.triangles, stretched(source.mesh).positions))
            .map;
    }
};

TEST(HyperbolicMap, OntoADeformedSurfaceAndBack) {
    const Deformed pair;
    const HyperbolicMap there = hyperbolic_map(pair.from, pair.to, pair.start());
    EXPECT_EQ(there.termination, Termination::converged);
    EXPECT_TRUE(there.one_to_one());
    EXPECT_TRUE(there.in_space.flipped.empty());
    EXPECT_GT(there.k, 0.05);
    EXPECT_NEAR(there.k_in_space, there.k, 0.02 * there.k + 2e-3);
    EXPECT_LT(there.weighted_deviation, 0.03);
    EXPECT_LT(there.K_homology, 1.01 * there.K);
    const Marking back = inverse_marking(pair.from, pair.to, there);
    const HyperbolicMap inverse = hyperbolic_map(pair.to, pair.from, back.map);
    EXPECT_NEAR(inverse.k, there.k, 2e-3);
    EXPECT_EQ(inverse.homology * there.homology, Eigen::MatrixXi::Identity(4, 4));
    const Distance distance = hyperbolic_distance_of(there, inverse);
    EXPECT_NEAR(std::tanh(distance.distance), there.k, 2e-3);
    RecordProperty("k", std::to_string(there.k) + " " + std::to_string(inverse.k));
}

TEST(HyperbolicMap, BadStartsGiveTheSameMap) {
    const Deformed pair;
    const EquivariantMap start = pair.start();
    const HyperbolicMap near = hyperbolic_map(pair.from, pair.to, start);
    EquivariantMap moved = start;
    std::vector<DiskIsometry> by(moved.bases.size());
    for (std::size_t v = 0; v < by.size(); ++v)
        by[v] = DiskIsometry::translation(std::polar(1.5, 3.7 * static_cast<double>(v)));
    for (std::size_t e = 0; e < moved.steps.size(); ++e) {
        const auto [a, b] = pair.source.topology.edges[e];
        moved.steps[e] = by[a].inverse() * moved.steps[e] * by[b];
    }
    for (std::size_t v = 0; v < by.size(); ++v) moved.frames[v] = moved.frames[v] * by[v];
    const HyperbolicMap far = hyperbolic_map(pair.from, pair.to, moved);
    EXPECT_NEAR(far.k, near.k, 1e-10);
    EXPECT_LT((far.positions - near.positions).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(HyperbolicMap, ThreeRings) {
    // Genus 3: in a row, where products of 1-forms do not span the differentials, k is .11495; in a triangle .0855.
    const auto stretch = [](double x) { return 1.3 + 0.2 * (x - 1.1); };
    for (const auto& [in_a_row, k] : {std::pair{true, 0.11495}, {false, 0.0855}}) {
        const Surface source(bench::three_rings(
            in_a_row, 0.125, [](double) { return 1.0; }, false)),
            target(bench::three_rings(in_a_row, 0.125, stretch, true));
        const HyperbolicShape from(source), to(target);
        HandleMarking marking;
        marking.start = source.mesh.positions;
        for (int v = 0; v < source.mesh.vertex_count(); ++v)
            (*marking.start)(v, 1) *= stretch(source.mesh.positions(v, 0));
        const HandleRegistration found = register_handles(from, to, marking);
        EXPECT_NEAR(found.map.k, k, 1e-3);
        ASSERT_TRUE(found.inverse_k);
        EXPECT_NEAR(*found.inverse_k, found.map.k, 6e-4);
        EXPECT_EQ(found.map.termination, Termination::converged);
        EXPECT_TRUE(found.map.one_to_one());
        EXPECT_TRUE(found.map.in_space.flipped.empty());
        EXPECT_EQ(from.differentials().space->size(), 6);
        RecordProperty("k", std::to_string(found.map.k) + " " + std::to_string(*found.inverse_k));
    }
}

TEST(HyperbolicMap, WhatIsBelowTheHomologyBoundHasNotConverged) {
    // A surface and a coarse mesh of it: they differ by less than the mesh resolves.
    const Surface source(bench::level_double_torus(
        0.1, [](double) { return 1.0; }, false)),
        target(collapse_edges(source.mesh, 600).mesh);
    const HyperbolicShape from(source), to(target);
    const HyperbolicMap map = register_handles(from, to).map;
    ASSERT_GT(map.K_homology, map.K * 1.001);
    EXPECT_NE(map.termination, Termination::converged);
    EXPECT_TRUE(std::ranges::any_of(map.warnings,
                                    [](const Warning& warning) { return warning.kind == WarningKind::below_bound; }));
    EXPECT_FALSE(hyperbolic_distance_of(map, map).settled);
}

TEST(HyperbolicMap, ContradictionsAreRefused) {
    const Deformed pair;
    // All the images of the mirrored surface: the orientation is turned round.
    Positions mirrored = Deformed::stretched(pair.source.mesh).positions;
    mirrored.col(2) *= -1;
    EXPECT_EQ(test::cause_of([&] {
                  const Marking marking = marking_by_vertices(
                      pair.source, pair.from.metric().original, pair.to.group(),
                      nearest_vertices(pair.target.mesh, pair.to.metric().metric.triangles, mirrored));
                  hyperbolic_map(pair.from, pair.to, marking.map);
              }),
              Cause::bad_option);
}

}  // namespace
}  // namespace beltrami
