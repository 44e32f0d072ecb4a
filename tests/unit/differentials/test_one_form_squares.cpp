#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <beltrami/base/error.h>
#include <beltrami/charts/domain_chart.h>
#include <beltrami/differentials/laurent_space.h>
#include <beltrami/differentials/one_form_squares.h>
#include <beltrami/generate/grids.h>
#include <beltrami/mesh/planar.h>
#include <beltrami/meshing/planar_domains.h>

#include "support/function_spaces.h"
#include "support/meshes.h"

namespace beltrami {
namespace {

TEST(QuadrilateralSpace, OfARectangleIsConstant) {
    for (const Cells cells : {Cells::triangles, Cells::quads}) {
        const int nx = 9, ny = 6;
        const Surface surface(rectangle(3, 1.5, nx, ny, cells));
        const QuadrilateralSpace space = quadrilateral_space(surface, {0, nx, (nx + 1) * (ny + 1) - 1, (nx + 1) * ny});
        EXPECT_NEAR(space.modulus, 0.5, 1e-12);
        EXPECT_NEAR(space.modulus_lower, 0.5, 1e-12);
        EXPECT_NEAR(space.modulus_upper, 0.5, 1e-12);
        EXPECT_EQ(space.space.size(), 1);
        EXPECT_FALSE(space.space.complex_coefficients());
        const Eigen::MatrixXcd& phi = *space.space.tabulated();
        EXPECT_LT((phi.array() - 1.0 / 9).abs().maxCoeff(), 1e-12);
        EXPECT_LT((space.map - planar_coordinates(surface.mesh) / 3).cwiseAbs().maxCoeff(), 1e-12);
    }
}

/// The same rectangle bent around a cylinder: every face in a frame of its own, turned against the axis.
TEST(QuadrilateralSpace, KnowsNothingOfThePlane) {
    const int n = 12;
    Mesh mesh = rectangle(1, 1, n, n);
    const Positions flat = mesh.positions;
    mesh.positions.resize(flat.rows(), 3);
    for (int v = 0; v < mesh.vertex_count(); ++v)
        mesh.positions.row(v) << std::cos(0.1 * flat(v, 0)), std::sin(0.1 * flat(v, 0)), 0.1 * flat(v, 1);
    const Surface surface(mesh);
    const QuadrilateralSpace space = quadrilateral_space(surface, {0, n, (n + 1) * (n + 1) - 1, (n + 1) * n});
    EXPECT_NEAR(space.modulus, 1, 1e-5);
    for (int s = 0; s < surface.operators.sample_count(); ++s) {
        // |φ| = 1/0.1², and φ of the frame of the first edge.
        const auto v = surface.operators.stencil(s);
        const Complex edge(flat(v[1], 0) - flat(v[0], 0), flat(v[1], 1) - flat(v[0], 1));
        const Complex expected = 100.0 * edge * edge / std::norm(edge);
        EXPECT_LT(std::abs((*space.space.tabulated())(s, 0) - expected), 1e-2);
    }
}

TEST(QuadrilateralSpace, OfADiskIsThatOfItsFourMarks) {
    double last = 0;
    for (const double edge_length : {0.08, 0.04, 0.02}) {
        const Surface surface(circle_domain({}, {}, {.edge_length = edge_length}));
        const Chart chart = plane_chart(surface);
        std::array<int, 4> corners{};
        const double angles[] = {0.1, 1, 2, 4};
        for (int i = 0; i < 4; ++i)
            for (const int v : surface.topology.boundary_loops[0])
                if (std::abs(chart.vertices[v] - std::polar(1.0, angles[i])) <
                    std::abs(chart.vertices[corners[i]] - std::polar(1.0, angles[i])))
                    corners[i] = v;
        const QuadrilateralSpace space = quadrilateral_space(surface, corners);
        std::vector<Complex> marks;
        for (const int v : corners) marks.push_back(chart.vertices[v]);
        const LaurentSpace exact(*round_domain(surface, chart, {corners.begin(), corners.end()}));
        const double error =
            test::angle_between(exact.evaluate({chart.positions, chart.derivatives}), *space.space.tabulated(),
                                test::weights_of(surface.operators.weights, chart.positions, marks));
        EXPECT_LT(space.modulus_lower, space.modulus_upper);
        if (last > 0) {
            EXPECT_GT(std::log2(last / error), 0.3);  // the poles
        }
        last = error;
    }
    EXPECT_LT(last, 0.03);
}

/// The L with marks at two ends and the reentrant corner has modulus 1 by symmetry.
TEST(QuadrilateralSpace, ReentrantCornersMayBeMarked) {
    double last_width = 0;
    for (const double edge_length : {0.1, 0.05, 0.025}) {
        const Surface surface(polygon_domain({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}, {},
                                             {.edge_length = edge_length, .corner_edge_length = edge_length}));
        const QuadrilateralSpace space = quadrilateral_space(surface, {0, 1, 3, 5});
        EXPECT_LT(space.modulus_lower, 1);
        EXPECT_GT(space.modulus_upper, 1);
        EXPECT_NEAR(space.modulus, 1, 6e-4);
        const double width = space.modulus_upper - space.modulus_lower;
        if (last_width > 0) {
            EXPECT_GT(std::log2(last_width / width), 0.55);  // h^(2/3)
        }
        last_width = width;
        // Only the real part of φ τ² is left on the boundary; and the sum of ∫|φ| is the rectangle's area.
        double total = 0;
        for (int s = 0; s < surface.operators.sample_count(); ++s)
            total += surface.operators.weights[s] * std::abs((*space.space.tabulated())(s, 0));
        EXPECT_NEAR(total, 1, 0.06);
    }
}

TEST(QuadrilateralSpace, SidesAreCountedFromTheFirstCorner) {
    const int n = 8;
    const Surface surface(rectangle(2, 1, n, n));
    const std::array<int, 4> corners{0, n, (n + 1) * (n + 1) - 1, (n + 1) * n};
    const QuadrilateralSpace one = quadrilateral_space(surface, corners),
                             other = quadrilateral_space(surface, {corners[1], corners[2], corners[3], corners[0]});
    EXPECT_NEAR(one.modulus * other.modulus, 1, 1e-12);
    // Sides and ends exchanged: φ changes its sign.
    const Complex ratio = (*other.space.tabulated())(0, 0) / (*one.space.tabulated())(0, 0);
    EXPECT_NEAR(std::arg(-ratio), 0, 1e-12);
}

TEST(QuadrilateralSpace, RefusesOtherCorners) {
    const int n = 6;
    const Surface surface(rectangle(1, 1, n, n));
    const int last = (n + 1) * (n + 1) - 1;
    const auto refused = [&](const std::array<int, 4>& corners, Cause cause) {
        try {
            quadrilateral_space(surface, corners);
            ADD_FAILURE() << "accepted";
        } catch (const Error& error) {
            EXPECT_EQ(error.cause(), cause) << error.what();
        }
    };
    refused({0, n, last, n + 2}, Cause::bad_boundary);     // an inner vertex
    refused({0, last - n, last, n}, Cause::bad_boundary);  // clockwise
    refused({0, last, n, last - n}, Cause::bad_boundary);  // crossing
    refused({0, 0, n, last}, Cause::bad_boundary);         // twice the same
    refused({0, n, last, last + 5}, Cause::bad_boundary);  // no vertex
    EXPECT_THROW(quadrilateral_space(Surface(annulus(0.5, 1, 12)), {0, 1, 2, 3}), Error);
}

TEST(OneFormProducts, SpanTheSpaceOfGenericHoles) {
    double last = 0;
    for (const double edge_length : {0.04, 0.02}) {
        const Surface surface(circle_domain({}, {{{-0.4, 0.1}, 0.2}, {{0.35, 0}, 0.25}}, {.edge_length = edge_length}));
        const Chart chart = plane_chart(surface);
        const TabulatedSpace space = one_form_products(surface);
        EXPECT_EQ(space.size(), 3);
        const LaurentSpace exact(*round_domain(surface, chart));
        const double error =
            test::angle_between(exact.evaluate({chart.positions, chart.derivatives}), *space.tabulated(),
                                test::weights_of(surface.operators.weights, {}, {}));
        if (last > 0) {
            EXPECT_GT(std::log2(last / error), 0.8);
        }
        last = error;
    }
    EXPECT_LT(last, 0.06);
}

TEST(OneFormProducts, SayThatHolesInOneLineAreTooFew) {
    const Surface surface(
        circle_domain({}, {{{-0.5, 0}, 0.15}, {{0, 0}, 0.15}, {{0.5, 0}, 0.15}}, {.edge_length = 0.04}));
    try {
        one_form_products(surface);
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.cause(), Cause::not_solved);
        EXPECT_NE(std::string(error.what()).find("do not span the 6"), std::string::npos) << error.what();
    }
    EXPECT_THROW(one_form_products(Surface(annulus(0.5, 1, 12))), Error);
}

}  // namespace
}  // namespace beltrami
