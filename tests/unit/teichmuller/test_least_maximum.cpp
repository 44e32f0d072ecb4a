#include <gtest/gtest.h>

#include <algorithm>

#include <beltrami/base/error.h>
#include <beltrami/meshing/planar_domains.h>
#include <beltrami/teichmuller/least_maximum.h>

#include "support/cause_of.h"
#include "support/meshes.h"

namespace beltrami {
namespace {

TEST(LeastMaximum, IsBelowTheExtremalMapAndTheInterpolatedExactOne) {
    DomainOptions domain;
    domain.edge_length = 0.08;
    const Surface surface(circle_domain({}, {}, domain));
    const BoundaryCondition boundary = test::boundary_values(surface, test::exact_composition);
    const LeastMaximumMap result = least_maximum_map(surface, boundary);
    Eigen::VectorXcd exact = test::complex_positions(surface.mesh);
    for (Complex& z : exact) z = test::exact_composition(z);
    const double interpolated = distortion(surface.operators, exact).max;
    ASSERT_TRUE(result.extremal);
    EXPECT_TRUE(result.fold_free);
    EXPECT_EQ(result.start_max, result.extremal->distortion.max);
    EXPECT_LT(result.distortion.max, 0.518);
    EXPECT_GT(result.distortion.max, 0.495);
    EXPECT_LT(result.distortion.max, interpolated - 0.02);
    EXPECT_LT(result.distortion.max, result.start_max - 0.01);
    EXPECT_EQ(result.history.back().power, 128);
    for (std::size_t i = 0; i < boundary.vertices.size(); ++i)
        EXPECT_EQ(result.map[boundary.vertices[i]], boundary.images[i]);
}

TEST(LeastMaximum, ALargerPowerHasASmallerMaximum) {
    const Surface surface(test::bump(800));
    const BoundaryCondition boundary = test::boundary_values(
        surface, [](Complex z) { return std::polar(1.0, std::arg(z) + 0.6 * std::sin(std::arg(z))); });
    double last = 1;
    for (const double power : {1.0, 16.0, 256.0}) {
        LeastMaximumOptions options;
        options.power = power;
        const double max = least_maximum_map(surface, boundary, options).distortion.max;
        EXPECT_LE(max, last) << power;
        last = max;
    }
    EXPECT_LT(last, extremal_map(surface, boundary).distortion.max);
}

TEST(LeastMaximum, AffineMapsAreFound) {
    // With the boundary values of an affine map nothing is better than that map itself.
    const Surface surface(test::jittered_square(8));
    const auto affine = [](Complex z) { return z + 0.3 * std::conj(z); };
    const LeastMaximumMap result = least_maximum_map(surface, test::boundary_values(surface, affine));
    const Eigen::VectorXcd z = test::complex_positions(surface.mesh);
    for (int v = 0; v < z.size(); ++v) EXPECT_NEAR(std::abs(result.map[v] - affine(z[v])), 0, 1e-7);
    EXPECT_NEAR(result.distortion.max, 0.3, 1e-7);
}

TEST(LeastMaximum, FreePartsOfTheBoundaryTakeTheirNaturalPlace) {
    // Two opposite sides of a square are moved apart by half their distance; the others are free.
    const Surface surface(test::jittered_square(10));
    BoundaryCondition boundary;
    for (const int v : surface.topology.boundary_loops[0]) {
        const double x = surface.mesh.positions(v, 0), y = surface.mesh.positions(v, 1);
        if (x == 0 || x == 1) boundary.pin(v, {1.5 * x, y});
    }
    const LeastMaximumMap result = least_maximum_map(surface, boundary);
    EXPECT_FALSE(result.extremal);
    EXPECT_TRUE(result.fold_free);
    // The affine map of the whole square, (1.5 x, y), has |μ| = 0.2 and obeys the same boundary values.
    EXPECT_LE(result.distortion.max, 0.2 + 1e-6);
    EXPECT_LT(result.distortion.max, result.start_max);
    for (std::size_t i = 0; i < boundary.vertices.size(); ++i)
        EXPECT_EQ(result.map[boundary.vertices[i]], boundary.images[i]);
}

TEST(LeastMaximum, WithAFreeArcNoMapHasTheLeastDilatation) {
    // Half of the circle moves unevenly along itself. Whatever the other half does is allowed, so the extremal map of
    // the whole circle's values is no better; and the finer the mesh, the less is needed. The least-squares conformal
    // map is folded or winds twice around a vertex.
    double last = 1;
    for (const int triangles : {600, 2400}) {
        const Surface surface(disk(disk_rings_for_triangles(triangles)));
        BoundaryCondition half, whole;
        for (const int v : surface.topology.boundary_loops[0]) {
            const double t = std::atan2(surface.mesh.positions(v, 1), surface.mesh.positions(v, 0));
            whole.pin(v, std::polar(1.0, t + 0.45 * std::sin(2 * t)));
            if (t > -1e-9) half.pin(v, whole.images.back());
        }
        const LeastMaximumMap result = least_maximum_map(surface, half);
        EXPECT_TRUE(result.fold_free);
        EXPECT_TRUE(result.branch_points.empty());
        EXPECT_TRUE(result.warnings.empty());
        EXPECT_LT(result.distortion.max, extremal_map(surface, whole).k - 0.03);
        EXPECT_LT(result.distortion.max, last - 0.02);
        last = result.distortion.max;
    }
}

TEST(LeastMaximum, WithoutPinsAFlatDiskKeepsItsShape) {
    const Surface surface(disk(6));
    BoundaryCondition one;
    one.pin(0, {3, 4});
    for (const BoundaryCondition& boundary : {BoundaryCondition(), one}) {
        const LeastMaximumMap result = least_maximum_map(surface, boundary);
        EXPECT_LT(result.distortion.max, 1e-6);
        if (!boundary.empty()) {
            EXPECT_NEAR(std::abs(result.map[0] - Complex(3, 4)), 0, 1e-12);
        }
    }
}

TEST(LeastMaximum, OpensTheFoldsOfItsStart) {
    // Half of the boundary bent around: the least-squares conformal map folds there.
    const Surface surface(disk(10));
    BoundaryCondition boundary;
    for (const int v : surface.topology.boundary_loops[0]) {
        const Complex z(surface.mesh.positions(v, 0), surface.mesh.positions(v, 1));
        if (z.real() > -0.9) boundary.pin(v, test::three_lobes(z));
    }
    const LeastMaximumMap result = least_maximum_map(surface, boundary);
    EXPECT_GT(result.start_max, 1);
    EXPECT_TRUE(result.fold_free);
    EXPECT_LT(result.distortion.max, 1);
    EXPECT_TRUE(result.distortion.flipped.empty());
}

TEST(LeastMaximum, HolesAndTurns) {
    DomainOptions options;
    options.edge_length = 0.07;
    const Surface surface(circle_domain({}, {{{0, 0}, 0.2}}, options));
    const BoundaryCondition boundary = test::boundary_values(surface, [](Complex z) { return z; });
    Constraints constraints(boundary);
    constraints.correspondence.turns = {0, 1};
    const LeastMaximumMap result = least_maximum_map(surface, constraints);
    ASSERT_TRUE(result.extremal);
    EXPECT_TRUE(result.fold_free);
    EXPECT_LT(result.distortion.max, result.start_max);
    const auto turns = homotopy_class(surface, test::complex_positions(surface.mesh), result.map);
    EXPECT_EQ(turns.holes[0].turns, 1);
    EXPECT_TRUE(turns.holes[0].meaningful);
}

TEST(LeastMaximum, ImpossibleInputIsRefused) {
    const Surface surface(disk(5));
    LeastMaximumOptions options;
    options.power = 0.5;
    EXPECT_EQ(test::cause_of([&] { least_maximum_map(surface, {}, options); }), Cause::bad_option);
    BoundaryCondition twice;
    twice.pin(0, 0.0);
    twice.pin(1, 0.0);
    EXPECT_EQ(test::cause_of([&] { least_maximum_map(surface, twice); }), Cause::bad_boundary);
    Mesh tetrahedron;
    tetrahedron.positions.resize(4, 3);
    tetrahedron.positions << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1;
    tetrahedron.faces.add({0, 2, 1});
    tetrahedron.faces.add({0, 1, 3});
    tetrahedron.faces.add({1, 2, 3});
    tetrahedron.faces.add({0, 3, 2});
    EXPECT_EQ(test::cause_of([&] { least_maximum_map(Surface(tetrahedron), {}); }), Cause::bad_mesh);
}

}  // namespace
}  // namespace beltrami
