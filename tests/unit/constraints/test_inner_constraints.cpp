#include <beltrami/base/error.h>
#include <beltrami/constraints/inner_constraints.h>
#include <beltrami/generate/grids.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace beltrami {
namespace {

/// The square [0,8]² of unit cells, and its vertices by coordinates.
struct Grid {
    Surface surface{rectangle(8, 8, 8, 8)};
    BoundaryCondition boundary;
    Grid() {
        for (const int v : surface.topology.boundary_loops[0]) boundary.pin(v, at(v));
    }
    Complex at(int v) const { return {surface.mesh.positions(v, 0), surface.mesh.positions(v, 1)}; }
    int vertex(int x, int y) const {
        for (int v = 0; v < surface.mesh.vertex_count(); ++v)
            if (std::abs(at(v) - Complex(x, y)) < 1e-9) return v;
        return -1;
    }
    void pin(int x, int y) { boundary.pin(vertex(x, y), Complex(x, y)); }
    void hold(int x, int y, Complex direction) { boundary.pin_to_line(vertex(x, y), Complex(x, y), direction); }
    std::vector<ConstraintCurve> curves() const { return constraint_curves(boundary, surface); }
};

TEST(InnerConstraints, ThereAreNone) {
    Grid grid;
    EXPECT_TRUE(grid.curves().empty());
    grid.pin(4, 4);
    grid.hold(2, 5, 1.0);
    EXPECT_TRUE(grid.curves().empty());
}

TEST(InnerConstraints, AChainOfPinsInside) {
    Grid grid;
    for (const int y : {5, 3, 4}) grid.pin(4, y);
    const auto curves = grid.curves();
    ASSERT_EQ(curves.size(), 1u);
    EXPECT_EQ(curves[0].kind, EdgeConstraint::pinned);
    EXPECT_EQ(curves[0].vertices, (std::vector{grid.vertex(4, 3), grid.vertex(4, 4), grid.vertex(4, 5)}));
}

TEST(InnerConstraints, AnEdgeBetweenBoundaryVerticesIsNone) {
    const Surface strip(rectangle(8, 1, 8, 1));
    BoundaryCondition boundary;
    for (int v = 0; v < strip.mesh.vertex_count(); ++v)
        boundary.pin(v, {strip.mesh.positions(v, 0), strip.mesh.positions(v, 1)});
    EXPECT_TRUE(constraint_curves(boundary, strip).empty());
}

TEST(InnerConstraints, ALineFromSideToSide) {
    Grid grid;
    for (int y = 1; y < 8; ++y) grid.hold(4, y, Complex(0, -2));
    const auto curves = grid.curves();
    ASSERT_EQ(curves.size(), 1u);
    EXPECT_EQ(curves[0].kind, EdgeConstraint::on_line);
    EXPECT_EQ(curves[0].vertices.size(), 9u);
    EXPECT_FALSE(curves[0].closed());
}

TEST(InnerConstraints, LinesSideBySideAreNotJoined) {
    Grid grid;
    for (int y = 3; y < 6; ++y) {
        grid.hold(3, y, Complex(0, 1));
        grid.hold(4, y, Complex(0, 1));
    }
    const auto curves = grid.curves();
    ASSERT_EQ(curves.size(), 2u);
    for (const auto& curve : curves) EXPECT_EQ(curve.vertices.size(), 3u);
}

TEST(InnerConstraints, CurvesEndAtPinsOnTheirLineAndWhereTheyMeet) {
    Grid grid;
    for (int y = 2; y < 7; ++y)
        if (y != 4) grid.hold(4, y, Complex(0, 1));
    grid.pin(4, 4);
    for (const int x : {5, 6}) grid.hold(x, 4, 1.0);
    const auto curves = grid.curves();
    ASSERT_EQ(curves.size(), 3u);
    const int meeting = grid.vertex(4, 4);
    for (const auto& curve : curves) {
        EXPECT_EQ(curve.vertices.size(), 3u);
        EXPECT_TRUE(curve.vertices.front() == meeting || curve.vertices.back() == meeting);
        EXPECT_EQ(curve.kind, EdgeConstraint::on_line);
    }
}

TEST(InnerConstraints, AClosedCurve) {
    Grid grid;
    for (const auto& [x, y] : {std::pair(3, 3), {4, 3}, {5, 3}, {5, 4}, {5, 5}, {4, 5}, {3, 5}, {3, 4}}) grid.pin(x, y);
    std::vector<ConstraintCurve> curves = grid.curves();
    // Edges that cut the corners of the ring are constrained, too, where the mesh has them.
    const auto closed = std::count_if(curves.begin(), curves.end(), [](const auto& curve) { return curve.closed(); });
    std::size_t edges = 0;
    for (const auto& curve : curves) edges += curve.vertices.size() - 1;
    EXPECT_TRUE(closed == 1 || curves.size() > 1);
    EXPECT_GE(edges, 8u);
    std::size_t constrained = 0;
    for (const EdgeConstraint c : edge_constraints(grid.boundary, grid.surface))
        constrained += c == EdgeConstraint::pinned;
    EXPECT_EQ(edges, constrained);
}

TEST(InnerConstraints, ContradictionsAreRefused) {
    const auto refused = [](const Grid& grid, int vertex, const std::string& words) {
        try {
            validate(grid.boundary, grid.surface);
        } catch (const Error& error) {
            EXPECT_EQ(error.cause(), Cause::bad_boundary);
            EXPECT_EQ(error.indices(), std::vector{vertex});
            EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
            return true;
        }
        return false;
    };
    Grid fine;
    fine.hold(4, 4, 1.0);
    fine.pin(3, 4);
    EXPECT_NO_THROW(validate(fine.boundary, fine.surface));
    Grid on_the_rim;
    const int corner = on_the_rim.vertex(0, 5);
    BoundaryCondition without;
    for (const int v : on_the_rim.boundary.vertices)
        if (v != corner) without.pin(v, on_the_rim.at(v));
    on_the_rim.boundary = without;
    on_the_rim.hold(0, 5, Complex(0, 1));
    EXPECT_TRUE(refused(on_the_rim, corner, "may not slide"));
    Grid both = fine;
    both.pin(4, 4);
    EXPECT_TRUE(refused(both, both.vertex(4, 4), "twice"));
    Grid two_lines = fine;
    two_lines.hold(4, 4, Complex(0, 1));
    EXPECT_TRUE(refused(two_lines, two_lines.vertex(4, 4), "twice"));
    Grid no_direction;
    no_direction.hold(4, 4, 0.0);
    EXPECT_TRUE(refused(no_direction, no_direction.vertex(4, 4), "not a line"));
    Grid nowhere;
    nowhere.boundary.pin_to_line(nowhere.vertex(4, 4), {std::nan(""), 0}, 1.0);
    EXPECT_TRUE(refused(nowhere, nowhere.vertex(4, 4), "not a line"));
}

}  // namespace
}  // namespace beltrami
