// Extremal maps that slide along the boundary, as halves of maps between doubles.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>

#include <gtest/gtest.h>

#include <beltrami/charts/circle_domain_chart.h>
#include <beltrami/generate/double_torus.h>
#include <beltrami/generate/grids.h>
#include <beltrami/hyperbolic/equivariant_map_step.h>
#include <beltrami/hyperbolic/fold_opening.h>
#include <beltrami/mesh/submesh.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/registration/register_handles.h>
#include <beltrami/teichmuller/hyperbolic_sliding_start.h>

#include "problems/slit_torus.h"
#include "support/cause_of.h"
#include "support/onto.h"

namespace beltrami {
namespace {

using bench::SlitTorus;

HyperbolicMap between(const SlitTorus& from, const SlitTorus& to) {
    const HyperbolicShape source(from.surface), target(to.surface);
    const Marking marking =
        marking_by_vertices(from.surface, source.metric().original, target.group(), same_places(from, to));
    return hyperbolic_map(source, target, marking.map);
}

/// The part of its boundary that a map leaves.
double off_boundary(const HyperbolicMap& map, const Surface& source, const Surface& target) {
    double largest = 0;
    for (const std::vector<int>& loop : source.topology.boundary_loops)
        for (const int v : loop)
            for (int k = 0; k < 3; ++k)
                if (!target.topology.on_boundary[map.places[v].vertices[k]])
                    largest = std::max(largest, map.places[v].barycentric[k]);
    return largest;
}

TEST(HyperbolicBoundary, TheDoubleIsSymmetric) {
    const SlitTorus torus = bench::slit_torus(16, 1.3, 1);
    const HyperbolicSurface metric = hyperbolic_surface(torus.surface);
    EXPECT_EQ(metric.genus, 2);
    EXPECT_NEAR(metric.area(), 4 * M_PI, 1e-9);
    EXPECT_LT(metric.flatness, 1e-9);
    const int own = metric.original.halfedge_count() / 2;
    EXPECT_EQ(own, 3 * metric.own_triangles());
    double asymmetry = 0, off_axis = 0;
    int boundary_edges = 0;
    for (int h = 0; h < own; ++h) {
        const int image = IntrinsicTriangulation::mirrored(h, own);
        EXPECT_EQ(IntrinsicTriangulation::mirrored(image, own), h);
        EXPECT_EQ(metric.original.tail(image), metric.mirror[metric.original.head(h)]);
        asymmetry = std::max(asymmetry, (metric.step(h).mirrored() * metric.step(image)).from_identity());
        if (metric.original.twin(h) != image) continue;
        ++boundary_edges;
        off_axis = std::max(off_axis, std::abs(metric.step(h).place().imag()));
        EXPECT_GT(metric.step(h).place().real(), 0);
    }
    EXPECT_LT(asymmetry, 1e-9);
    EXPECT_EQ(off_axis, 0);
    EXPECT_EQ(boundary_edges, static_cast<int>(torus.surface.topology.boundary_loops[0].size()));
}

TEST(HyperbolicBoundary, DifferentialsAreRealAlongTheBoundary) {
    // Of genus 1 with one loop the double has genus 2: three of them; of three holes, six.
    const SlitTorus torus = bench::slit_torus(24, 1, 1);
    const Surface domain(test::disk_with_holes({{0, 0.5, 0.1}, {-0.4, -0.3, 0.1}, {0.4, -0.3, 0.1}}, 0.08));
    for (const auto& [surface, dimension] : {std::pair{&torus.surface, 3}, std::pair{&domain, 6}}) {
        const HyperbolicShape shape(*surface);
        const HyperbolicShape::Differentials& found = shape.differentials();
        EXPECT_EQ(found.space->size(), dimension);
        EXPECT_FALSE(found.space->complex_coefficients());
        EXPECT_LT(found.kernel.maxCoeff(), 0.05);
        EXPECT_NEAR(found.next, 0.5, 0.1);
    }
}

TEST(HyperbolicBoundary, StretchedTorusLessARectangle) {
    // Faces cut into four: errors of one family of meshes fall evenly, those of random ones on the mean only.
    for (const double stretch : {1.5, 4.0}) {
        const double exact = (stretch - 1) / (stretch + 1);
        double before = 0;
        for (int refinements = 0; refinements < 3; ++refinements) {
            const SlitTorus a = bench::slit_torus(16, 1, 1, refinements),
                            b = bench::slit_torus(24, stretch, 2, refinements);
            const HyperbolicMap map = between(a, b);
            const double error = std::abs(map.k - exact);
            RecordProperty("k_" + std::to_string(stretch) + "_" + std::to_string(refinements), std::to_string(map.k));
            EXPECT_EQ(map.termination, Termination::converged);
            EXPECT_TRUE(map.one_to_one());
            EXPECT_LT(off_boundary(map, a.surface, b.surface), 1e-9);
            EXPECT_LT(map.K_homology, map.K * 1.01);
            if (before > 0) {
                EXPECT_GT(std::log2(before / error), 1.8);
            }
            before = error;
        }
        EXPECT_LT(before, stretch < 2 ? 1e-4 : 3e-4);
    }
}

/// A torus less what is near a point: an outline like a saw.
Mesh torus_with_ragged_hole(double minor, int around, int along) {
    const Mesh whole = torus(1, minor, around, along);
    std::vector<int> kept;
    for (int f = 0; f < whole.face_count(); ++f) {
        const auto v = whole.faces[f];
        const Eigen::Vector3d centre = (whole.point(v[0]) + whole.point(v[1]) + whole.point(v[2])) / 3;
        if ((centre - Eigen::Vector3d(1 + minor, 0, 0)).norm() > 0.42) kept.push_back(f);
    }
    return keep_faces(whole, kept).mesh;
}

TEST(HyperbolicBoundary, RaggedOutlinesFlipNothing) {
    for (const auto& [around, along] : {std::pair{40, 14}, {51, 18}, {61, 23}}) {
        const Surface source(torus_with_ragged_hole(0.3, around, along)),
            target(torus_with_ragged_hole(0.36, along * 3, around / 3));
        const HyperbolicShape from(source), to(target);
        const HandleRegistration found = register_handles(from, to);
        EXPECT_TRUE(found.map.one_to_one()) << around;
        EXPECT_NE(found.map.termination, Termination::unconfirmed) << around;
        EXPECT_GT(found.map.K_lower, 1.01) << around;
    }
}

TEST(HyperbolicBoundary, FoldsAreOpened) {
    const SlitTorus a = bench::slit_torus(24, 1, 1), b = bench::slit_torus(16, 1.5, 2);
    const HyperbolicMap map = between(a, b);
    ASSERT_TRUE(map.one_to_one());
    const auto flipped = [&](const EquivariantMap& image) {
        return distortion(a.surface.operators, EquivariantMapStep(a.surface, image).derivatives()).flipped.size();
    };
    // Nothing is done where nothing is flipped.
    EquivariantMap image = map.equivariant;
    EXPECT_EQ(open_folds(a.surface, image), 0);
    // An inner vertex and one of the boundary, each moved beyond its neighbours.
    const int inner = 0, outer = a.surface.topology.boundary_loops[0][3];
    ASSERT_FALSE(a.surface.topology.on_boundary[inner]);
    for (const int v : {inner, outer}) {
        image = map.equivariant;
        double reach = 0;
        for (std::size_t e = 0; e < image.steps.size(); ++e)
            for (const int end : a.surface.topology.edges[e])
                if (end == v) reach = std::max(reach, image.steps[e].distance());
        const DiskIsometry by = DiskIsometry::translation(1.5 * reach);
        for (std::size_t e = 0; e < image.steps.size(); ++e) {
            if (a.surface.topology.edges[e][0] == v) image.steps[e] = by.inverse() * image.steps[e];
            if (a.surface.topology.edges[e][1] == v) image.steps[e] = image.steps[e] * by;
        }
        image.frames[static_cast<std::size_t>(v)] = image.frames[static_cast<std::size_t>(v)] * by;
        ASSERT_GT(flipped(image), 0);
        EXPECT_GT(open_folds(a.surface, image), 0);
        EXPECT_EQ(flipped(image), 0) << v;
        EXPECT_LT(flatness(a.surface, image).maxCoeff(), 1e-9);
        // The boundary stays where it is: its steps are along it.
        for (std::size_t e = 0; e < image.steps.size(); ++e) {
            if (a.surface.topology.edge_faces[e][1] >= 0 && a.surface.topology.edge_faces[e][0] >= 0) continue;
            EXPECT_NEAR(image.steps[e].place().imag(), 0, 1e-9);
        }
    }
}

/// Where the harmonic map goes whose loops go evenly to the target's.
Positions even_positions(const Surface& source, const std::vector<test::Hole>& holes) {
    const std::unique_ptr<TargetModel> model = target_model(test::circles_target(holes), 0.06);
    Correspondence wanted;
    for (int l = 0; l <= static_cast<int>(holes.size()); ++l) wanted.loops.push_back({l, l});
    const Eigen::VectorXcd map = even_start(source, circle_domain_chart(source, 0), *model, wanted).map;
    Positions result = Positions::Zero(map.size(), 3);
    result.col(0) = map.real();
    result.col(1) = map.imag();
    return result;
}

TEST(HyperbolicBoundary, PlanarDomainsHaveTheirKnownK) {
    // Two holes: .16556 between circles, of which the meshes are polygons.
    const std::vector<test::Hole> holes{{-0.5, -0.2, 0.15}, {0.3, 0.3, 0.3}};
    const Surface source(test::disk_with_holes({{-0.4, 0.1, 0.2}, {0.35, 0, 0.25}}, 0.056)),
        target(test::disk_with_holes(holes, 0.05));
    const HyperbolicShape from(source), to(target);
    HandleMarking marking;
    marking.start = even_positions(source, holes);
    const HandleRegistration found = register_handles(from, to, marking);
    EXPECT_TRUE(found.map.one_to_one());
    EXPECT_NEAR(found.map.k, 0.16556, 6e-4);
    ASSERT_TRUE(found.inverse_k);
    EXPECT_NEAR(*found.inverse_k, found.map.k, 1e-3);
    EXPECT_LT(off_boundary(found.map, source, target), 1e-9);
    RecordProperty("k", std::to_string(found.map.k) + " " + std::to_string(*found.inverse_k));
    // Nearest points take a hole to one side of its partner: no map does.
    EXPECT_EQ(test::cause_of([&] { register_handles(from, to); }), Cause::bad_option);
}

TEST(HyperbolicBoundary, StartsTurnedAlongTheBoundaryEndInTheSameMap) {
    const SlitTorus a = bench::slit_torus(16, 1, 1), b = bench::slit_torus(24, 1.5, 2);
    const HyperbolicShape source(a.surface), target(b.surface);
    const EquivariantMap start =
        marking_by_vertices(a.surface, source.metric().original, target.group(), same_places(a, b)).map;
    const HyperbolicMap near = hyperbolic_map(source, target, start);
    EquivariantMap moved = start;
    std::vector<DiskIsometry> by(moved.bases.size());
    for (std::size_t v = 0; v < by.size(); ++v)
        by[v] = DiskIsometry::translation(a.surface.topology.on_boundary[v] ? Complex(0.7)
                                                                            : std::polar(0.5, 3.7 * double(v)));
    for (std::size_t e = 0; e < moved.steps.size(); ++e) {
        const auto [i, j] = a.surface.topology.edges[e];
        moved.steps[e] = by[i].inverse() * moved.steps[e] * by[j];
    }
    for (std::size_t v = 0; v < by.size(); ++v) moved.frames[v] = moved.frames[v] * by[v];
    const HyperbolicMap far = hyperbolic_map(source, target, moved);
    EXPECT_NEAR(far.k, near.k, 1e-9);
    // Positions in space are anywhere: what counts are places.
    EXPECT_LT((far.positions - near.positions).cwiseAbs().maxCoeff(), 1e-5);
}

/// Harmonic maps onto the circles of the target, evenly along the boundary, have folds; those between the doubles none.
TEST(HyperbolicSlidingStart, HasNoFolds) {
    struct Case {
        std::vector<test::Hole> from, to;
    };
    for (const Case& c : {Case{{{-0.4, 0.1, 0.2}, {0.35, 0, 0.25}}, {{-0.5, -0.2, 0.15}, {0.3, 0.3, 0.3}}},
                          Case{{{0, 0.5, 0.1}, {-0.4, -0.3, 0.1}, {0.4, -0.3, 0.1}},
                               {{0, 0.5, 0.2}, {-0.4, -0.3, 0.2}, {0.4, -0.3, 0.2}}},
                          Case{{{0, 0.33, 0.1}, {0.33, -0.33, 0.067}, {-0.33, -0.33, 0.133}},
                               {{0, 0.6, 0.1}, {0.7, -0.3, 0.1}, {-0.7, -0.3, 0.1}}}}) {
        const Surface source(test::disk_with_holes(c.from, 0.06));
        const CircleDomainChart chart = circle_domain_chart(source, 0);
        const std::unique_ptr<TargetModel> model = target_model(test::circles_target(c.to), 0.06);
        Correspondence wanted;
        for (int l = 0; l <= static_cast<int>(c.from.size()); ++l) wanted.loops.push_back({l, l});
        const SlidingStart even = even_start(source, chart, *model, wanted);
        const std::optional<SlidingStart> found = hyperbolic_sliding_start(source, *model, even, 0.06);
        ASSERT_TRUE(found);
        EXPECT_TRUE(distortion(source.operators, found->map).flipped.empty());
        EXPECT_EQ(found->curves, even.curves);
        RecordProperty("even_flips_" + std::to_string(c.from.size()), even.flips);
        // Its boundary lies on the curves.
        for (const SlidingLoop& loop : found->loops)
            for (std::size_t i = 0; i < loop.parameters.size(); ++i)
                EXPECT_LT(std::abs(found->map[source.topology.boundary_loops[loop.loop][i]] -
                                   loop.curve.point(loop.parameters[i])),
                          1e-9);
    }
}

/// A path along the grid of slit_torus(n), modulo n, from corner to corner; an edge joins the last one to the first.
std::vector<int> grid_path(const SlitTorus& torus, int n, const std::vector<std::array<int, 2>>& corners) {
    const auto at = [&](int i, int j) {
        const auto wrapped = [&](int x) { return static_cast<double>((x % n + n) % n) / n; };
        const Eigen::RowVector2d place(wrapped(i), wrapped(j));
        Eigen::Index nearest = 0;
        (torus.places.rowwise() - place).rowwise().squaredNorm().minCoeff(&nearest);
        return static_cast<int>(nearest);
    };
    std::vector<int> path{at(corners[0][0], corners[0][1])};
    for (std::size_t c = 0; c + 1 < corners.size(); ++c) {
        auto [i, j] = corners[c];
        const auto [to_i, to_j] = corners[c + 1];
        while (i != to_i || j != to_j) {
            i += (to_i > i) - (to_i < i);
            j += (to_j > j) - (to_j < j);
            path.push_back(at(i, j));
        }
    }
    return path;
}

TEST(HyperbolicBoundary, TwistsAboutPathsThatMeetTheBoundary) {
    // The hole is [4, 12] × [6, 10]. Each path beside one of the same class that is far from it.
    constexpr int n = 16;
    using Corners = std::vector<std::array<int, 2>>;
    struct Case {
        Corners far;
        std::vector<Corners> near;
    };
    const std::vector<Case> cases{
        {{{0, 0}, {n - 1, 0}}, {{{0, 6}, {n - 1, 6}}, {{0, 10}, {n - 1, 10}}}},
        {{{0, 0}, {0, n - 1}}, {{{4, 0}, {4, n - 1}}, {{12, 0}, {12, n - 1}}}},
        // The hole on its left, and later on its right.
        {{{3, 5}, {9, 5}, {9, -5}, {18, -5}, {18, -11}}, {{{4, 6}, {8, 6}, {8, -6}, {19, -6}, {19, -10}}}}};
    const SlitTorus a = bench::slit_torus(n, 1, 1), b = bench::slit_torus(24, 1.5, 2);
    const HyperbolicShape source(a.surface), target(b.surface);
    const EquivariantMap start =
        marking_by_vertices(a.surface, source.metric().original, target.group(), same_places(a, b)).map;
    const auto map_of = [&](const std::vector<int>& path, int turns) {
        const EquivariantMap after = twisted(a.surface, source.metric().original, start, path, turns);
        EXPECT_LT(flatness(a.surface, after).maxCoeff(), 1e-6);
        return hyperbolic_map(source, target, after);
    };
    for (const Case& c : cases)
        for (const int turns : {1, -1}) {
            const HyperbolicMap far = map_of(grid_path(a, n, c.far), turns);
            EXPECT_GT(far.k, 0.3);
            for (const Corners& corners : c.near) {
                std::vector<int> path = grid_path(a, n, corners);
                const HyperbolicMap there = map_of(path, turns);
                std::ranges::reverse(path);
                const HyperbolicMap back = map_of(path, turns);
                // The same class: the boundary slides.
                for (const HyperbolicMap* map : {&there, &back}) {
                    EXPECT_EQ(map->homology, far.homology);
                    EXPECT_NEAR(map->k, far.k, 1e-8);
                }
            }
        }
    // About a path all along the boundary a twist changes nothing, as the boundary slides.
    EXPECT_NEAR(map_of(a.surface.topology.boundary_loops[0], 1).k, hyperbolic_map(source, target, start).k, 1e-8);
}

TEST(HyperbolicBoundary, EarsAreSplit) {
    // A face with two boundary edges has its corners on one geodesic, and no area there.
    Mesh mesh = test::disk_with_holes({{-0.4, 0.1, 0.2}, {0.35, 0, 0.25}}, 0.1);
    const Topology shape = topology(mesh);
    const std::vector<int>& outer = shape.boundary_loops[0];
    const auto count = mesh.vertex_count();
    mesh.positions.conservativeResize(count + 1, Eigen::NoChange);
    mesh.positions.row(count) = 0.5 * (mesh.positions.row(outer[0]) + mesh.positions.row(outer[1])) * 1.03;
    mesh.faces.add({outer[1], outer[0], count});
    Mesh wide = test::disk_with_holes({{-0.4, 0.1, 0.2}, {0.35, 0, 0.25}}, 0.09);
    wide.positions.col(0) *= 1.2;
    const Surface source(mesh), target(wide);
    const HyperbolicShape from(source), to(target);
    ASSERT_TRUE(from.split());
    EXPECT_EQ(from.split()->split_edges, 1);
    EXPECT_FALSE(to.split());
    const HandleRegistration found = register_handles(from, to);
    EXPECT_TRUE(found.map.one_to_one());
    EXPECT_EQ(found.map.positions.rows(), count + 2);
    EXPECT_GT(found.map.k, 0.01);
    // And as a target: places are on its faces as given.
    const HandleRegistration back = register_handles(to, from);
    EXPECT_TRUE(back.map.one_to_one());
    for (std::size_t v = 0; v < back.map.places.size(); ++v) {
        const MeshPoint& place = back.map.places[v];
        Eigen::Vector3d at = Eigen::Vector3d::Zero();
        for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_EQ(source.mesh.faces[place.face][k], place.vertices[k]);
            at += place.barycentric[k] * source.mesh.point(place.vertices[k]);
        }
        EXPECT_LT((at - back.map.positions.row(static_cast<Eigen::Index>(v)).transpose()).norm(), 1e-12);
    }
    ASSERT_TRUE(back.inverse_k);
    EXPECT_NEAR(*back.inverse_k, back.map.k, 6e-3);
}

TEST(HyperbolicBoundary, WhatIsNoMapIsRefused) {
    const SlitTorus a = bench::slit_torus(16, 1, 1), b = bench::slit_torus(24, 1.5, 2);
    const HyperbolicShape source(a.surface), target(b.surface);
    // Turned round: boundary loops run the other way.
    SlitTorus mirrored = a;
    mirrored.places.col(0) = -mirrored.places.col(0);
    EXPECT_EQ(
        test::cause_of([&] {
            hyperbolic_map(
                source, target,
                marking_by_vertices(a.surface, source.metric().original, target.group(), same_places(mirrored, b)).map);
        }),
        Cause::bad_option);
    // Of another topology.
    const Surface closed(double_torus(0.25));
    const HyperbolicShape double_torus_shape(closed);
    EXPECT_EQ(test::cause_of([&] { hyperbolic_map(source, double_torus_shape, {}); }), Cause::bad_mesh);
    // A disk, a ring.
    EXPECT_EQ(test::cause_of([] { hyperbolic_surface(Surface(rectangle(1, 1, 3, 3))); }), Cause::bad_mesh);
    // A twist about a path that meets itself.
    EXPECT_EQ(test::cause_of([&] {
                  const std::vector<int>& loop = a.surface.topology.boundary_loops[0];
                  twisted(a.surface, source.metric().original, {}, {loop[0], loop[1], loop[0], loop[1]}, 1);
              }),
              Cause::bad_option);
}

}  // namespace
}  // namespace beltrami
