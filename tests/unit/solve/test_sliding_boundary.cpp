#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include <beltrami/base/constants.h>
#include <beltrami/base/error.h>
#include <beltrami/generate/round_domains.h>
#include <beltrami/mesh/planar.h>
#include <beltrami/solve/sliding_boundary.h>
#include <beltrami/solve/sliding_map_step.h>

using namespace beltrami;

namespace {

/// The boundary of a disk mesh on the unit circle, every vertex at its own angle.
SlidingLoop circle_loop(const Surface& surface) {
    const Eigen::VectorXcd z = planar_coordinates(surface.mesh);
    SlidingLoop loop{0, TargetCurve::circle(0, 1), {}, {}};
    for (const int v : surface.topology.boundary_loops[0]) {
        const double s = loop.curve.wrap(std::arg(z[v]));
        loop.parameters.push_back(
            loop.parameters.empty() ? s : loop.parameters.back() + loop.curve.ahead(loop.parameters.back(), s));
    }
    loop.held.assign(loop.parameters.size(), 0);
    return loop;
}

/// A boundary with no force on it, moved by so much along the tangents.
double moved_by(const Surface& surface, SlidingBoundary& boundary, const std::vector<double>& steps) {
    Eigen::VectorXcd map = planar_coordinates(surface.mesh);
    boundary.place(map);
    const auto linearized = boundary.linearized(Eigen::VectorXcd::Zero(map.size()));
    const auto& loop = surface.topology.boundary_loops[0];
    for (std::size_t i = 0; i < loop.size(); ++i) map[loop[i]] += steps[i] * linearized.directions[loop[i]];
    return boundary.advance(map);
}

}  // namespace

TEST(GuardedIncrements, KeepTheirSumAndTheirBounds) {
    const std::vector<double> wanted{0.5, -0.2, 0.4, 0.3}, least(4, 0.05), most(4, 0.6);
    const std::vector<double> got = guarded_increments(wanted, least, most);
    EXPECT_NEAR(std::accumulate(got.begin(), got.end(), 0.0), 1.0, 1e-15);
    for (const double d : got) {
        EXPECT_GE(d, 0.05);
        EXPECT_LE(d, 0.6);
    }
    EXPECT_NEAR(got[1], 0.05, 1e-15);
}

TEST(GuardedIncrements, LeaveWhatIsWithinBounds) {
    const std::vector<double> wanted{0.2, 0.3, 0.5};
    EXPECT_EQ(guarded_increments(wanted, {0.1, 0.1, 0.1}, {1, 1, 1}), wanted);
}

TEST(GuardedIncrements, SpreadWhatIsTooLarge) {
    const std::vector<double> got = guarded_increments({3.0, 0.1, 0.1}, {0.01, 0.01, 0.01}, {2, 2, 2});
    EXPECT_NEAR(got[0], 2, 1e-15);
    EXPECT_NEAR(got[0] + got[1] + got[2], 3.2, 1e-14);
    EXPECT_NEAR(got[1], got[2], 1e-15);
}

TEST(SlidingBoundary, SmallStepsAreTakenAsTheyAre) {
    const Surface surface(disk(4));
    SlidingBoundary boundary(surface, {circle_loop(surface)});
    const std::vector<double> before = boundary.loops()[0].parameters;
    std::vector<double> steps(before.size());
    for (std::size_t i = 0; i < steps.size(); ++i) steps[i] = 0.02 * std::sin(2.0 * static_cast<double>(i));
    moved_by(surface, boundary, steps);
    for (std::size_t i = 0; i < steps.size(); ++i)
        EXPECT_NEAR(boundary.loops()[0].parameters[i], before[i] + steps[i], 1e-14);
}

TEST(SlidingBoundary, VerticesStayInOrderWhateverIsAsked) {
    const Surface surface(disk(4));
    SlidingBoundary boundary(surface, {circle_loop(surface)});
    for (int round = 0; round < 50; ++round) {
        std::vector<double> steps(boundary.loops()[0].parameters.size());
        for (std::size_t i = 0; i < steps.size(); ++i)
            steps[i] = 3.0 * std::sin(1.7 * static_cast<double>(i) + round) - 4.0 * static_cast<double>(i == 3);
        moved_by(surface, boundary, steps);
        EXPECT_GT(boundary.least_increment(), 0);
        const auto& p = boundary.loops()[0].parameters;
        EXPECT_LT(p.back() - p.front(), 2 * kPi);
    }
    // However often it is asked to, no increment vanishes.
    EXPECT_GT(boundary.least_increment(), 1e-5);
}

TEST(SlidingBoundary, HeldVerticesStayAndArcsBetweenThemKeepTheirOrder) {
    const Surface surface(disk(4));
    SlidingLoop loop = circle_loop(surface);
    loop.held[2] = loop.held[9] = 1;
    SlidingBoundary boundary(surface, {loop});
    std::vector<double> steps(loop.parameters.size(), 1.5);
    moved_by(surface, boundary, steps);
    const auto& p = boundary.loops()[0].parameters;
    EXPECT_EQ(p[2], loop.parameters[2]);
    EXPECT_EQ(p[9], loop.parameters[9]);
    for (std::size_t i = 0; i + 1 < p.size(); ++i) EXPECT_LT(p[i], p[i + 1]);
    EXPECT_LT(p.back(), p.front() + 2 * kPi);
    EXPECT_GT(p[5], loop.parameters[5]);
}

TEST(SlidingBoundary, KeepsTheMeanMovementWhereTheSafeguardActs) {
    const Surface surface(disk(5));
    SlidingBoundary boundary(surface, {circle_loop(surface)});
    const std::vector<double> before = boundary.loops()[0].parameters;
    std::vector<double> steps(before.size());
    double mean = 0;
    for (std::size_t i = 0; i < steps.size(); ++i) {
        steps[i] = 0.4 * std::sin(3.0 * static_cast<double>(i)) + 0.05;
        mean += steps[i] / static_cast<double>(steps.size());
    }
    moved_by(surface, boundary, steps);
    double moved = 0;
    for (std::size_t i = 0; i < steps.size(); ++i)
        moved += (boundary.loops()[0].parameters[i] - before[i]) / static_cast<double>(steps.size());
    EXPECT_NEAR(moved, mean, 1e-12);
}

TEST(SlidingBoundary, StopsAtSharpCornersAndLeavesThemAlongTheSideOfLessEnergy) {
    const Surface surface(disk(3));
    const std::size_t n = surface.topology.boundary_loops[0].size();
    SlidingLoop loop{0, TargetCurve::polygon({{0, 0}, {1, 0}, {1, 1}, {0, 1}}), {}, std::vector<char>(n, 0)};
    for (std::size_t i = 0; i < n; ++i)
        loop.parameters.push_back(0.1 + 4.0 * static_cast<double>(i) / static_cast<double>(n));
    SlidingBoundary boundary(surface, {loop});
    std::vector<double> steps(n, 0.13);
    moved_by(surface, boundary, steps);
    // The last vertex before the corner at s = 1 has stopped there.
    std::size_t before = 0;
    while (loop.parameters[before + 1] < 1) ++before;
    ASSERT_GT(loop.parameters[before] + 0.13, 1);
    EXPECT_NEAR(boundary.loops()[0].parameters[before], 1, 1e-12);
    Eigen::VectorXcd map = Eigen::VectorXcd::Zero(surface.mesh.vertex_count()), force = map;
    boundary.place(map);
    const int v = surface.topology.boundary_loops[0][before];
    const auto direction = [&](Complex of_force) {
        force[v] = of_force;
        return boundary.linearized(force);
    };
    EXPECT_NEAR(std::abs(direction({0, -1}).directions[v] - Complex(0, 1)), 0, 1e-12);  // the energy falls upwards
    EXPECT_NEAR(std::abs(direction({1, 0}).directions[v] - Complex(1, 0)), 0, 1e-12);   // … or back to the left
    EXPECT_GT(direction({-1, 1}).extra_diagonal[v], 1e3);  // it grows along both sides: the vertex stays
}

TEST(SlidingBoundary, CurvatureOfTheCircleEntersTheDiagonal) {
    const Surface surface(disk(3));
    SlidingBoundary boundary(surface, {circle_loop(surface)});
    Eigen::VectorXcd map = planar_coordinates(surface.mesh);
    boundary.place(map);
    const Eigen::VectorXcd force = 0.7 * map;  // outwards; γ'' points inwards, with length 1
    const auto linearized = boundary.linearized(force);
    for (const int v : surface.topology.boundary_loops[0]) EXPECT_NEAR(linearized.extra_diagonal[v], -0.7, 1e-12);
}

TEST(SlidingBoundary, AdoptsTheParametersOfAMap) {
    const Surface surface(disk(4));
    SlidingBoundary boundary(surface, {circle_loop(surface)});
    Eigen::VectorXcd map = planar_coordinates(surface.mesh);
    for (const int v : surface.topology.boundary_loops[0]) map[v] *= std::polar(1.0, 0.1);
    const std::vector<double> before = boundary.loops()[0].parameters;
    boundary.adopt(map);
    for (std::size_t i = 0; i < before.size(); ++i)
        EXPECT_NEAR(boundary.loops()[0].parameters[i], before[i] + 0.1, 1e-12);
}

TEST(SlidingBoundary, RefusesLoopsThatAreMissingOrOutOfOrder) {
    const Surface surface(annulus(0.5, 1, 24));
    SlidingLoop loop{0, TargetCurve::circle(0, 1), {}, {}};
    const std::size_t n = surface.topology.boundary_loops[0].size();
    for (std::size_t i = 0; i < n; ++i) loop.parameters.push_back(0.2 * static_cast<double>(i));
    loop.held.assign(n, 0);
    EXPECT_THROW(SlidingBoundary(surface, {loop}), Error);  // loop 1 has no curve
    SlidingLoop other = loop;
    other.loop = 1;
    other.parameters.resize(surface.topology.boundary_loops[1].size());
    other.held.resize(other.parameters.size(), 0);
    std::swap(other.parameters[2], other.parameters[3]);
    EXPECT_THROW(SlidingBoundary(surface, {loop, other}), Error);
}

namespace {

/// A ring: loop 0 the unit circle, loop 1 that of radius .4, both at their own angles.
Surface ring() {
    return Surface(annulus(0.4, 1, 24));
}

SlidingLoop inner_loop(const Surface& surface, double radius) {
    const Eigen::VectorXcd z = planar_coordinates(surface.mesh);
    SlidingLoop loop{1, TargetCurve::circle(0, radius).reversed(), {}, {}};
    for (const int v : surface.topology.boundary_loops[1]) {
        const double s = loop.curve.wrap(-radius * std::arg(z[v]));
        loop.parameters.push_back(
            loop.parameters.empty() ? s : loop.parameters.back() + loop.curve.ahead(loop.parameters.back(), s));
    }
    loop.held.assign(loop.parameters.size(), 0);
    return loop;
}

BoundaryCondition outer_loop_stays(const Surface& surface) {
    const Eigen::VectorXcd z = planar_coordinates(surface.mesh);
    BoundaryCondition result;
    for (const int v : surface.topology.boundary_loops[0]) result.pin(v, z[v]);
    return result;
}

int inner_vertex(const Surface& surface, int count) {
    for (int v = 0;; ++v)
        if (!surface.topology.on_boundary[v] && count-- == 0) return v;
}

}  // namespace

TEST(SlidingBoundary, OtherLoopsAndInnerVerticesMayBePrescribed) {
    const Surface surface = ring();
    BoundaryCondition prescribed = outer_loop_stays(surface);
    const int pin = inner_vertex(surface, 0), line = inner_vertex(surface, 30);
    prescribed.pin(pin, Complex(0.5, 0.1));
    prescribed.pin_to_line(line, Complex(0, 0.5), Complex(2, 0));
    SlidingBoundary boundary(surface, {inner_loop(surface, 0.3)}, prescribed);
    const std::vector<Freedom> freedoms = boundary.freedoms();
    for (const int v : surface.topology.boundary_loops[0]) EXPECT_EQ(freedoms[v], Freedom::fixed);
    for (const int v : surface.topology.boundary_loops[1]) EXPECT_EQ(freedoms[v], Freedom::sliding);
    EXPECT_EQ(freedoms[pin], Freedom::fixed);
    EXPECT_EQ(freedoms[line], Freedom::sliding);
    Eigen::VectorXcd map = planar_coordinates(surface.mesh);
    const Complex before = map[line];
    boundary.place(map);
    EXPECT_EQ(map[pin], Complex(0.5, 0.1));
    EXPECT_NEAR(std::abs(map[line] - Complex(before.real(), 0.5)), 0, 1e-15);
    for (const int v : surface.topology.boundary_loops[1]) EXPECT_NEAR(std::abs(map[v]), 0.3, 1e-15);
    EXPECT_EQ(boundary.linearized(Eigen::VectorXcd::Zero(map.size())).directions[line], Complex(1, 0));
}

TEST(SlidingBoundary, HeldVerticesMayLieOffTheCurve) {
    const Surface surface(disk(4));
    SlidingLoop loop = circle_loop(surface);
    for (int i = 3; i <= 6; ++i) loop.held[i] = 1;
    const int v = surface.topology.boundary_loops[0][4];
    BoundaryCondition prescribed;
    prescribed.pin(v, Complex(1.5, 1));
    SlidingBoundary boundary(surface, {loop}, prescribed);
    Eigen::VectorXcd map = planar_coordinates(surface.mesh);
    boundary.place(map);
    EXPECT_EQ(map[v], Complex(1.5, 1));
    EXPECT_EQ(map[surface.topology.boundary_loops[0][5]], loop.curve.point(loop.parameters[5]));
    moved_by(surface, boundary, std::vector<double>(loop.parameters.size(), 0.05));
    EXPECT_EQ(boundary.loops()[0].parameters[4], loop.parameters[4]);
    EXPECT_GT(boundary.loops()[0].parameters[8], loop.parameters[8]);
}

TEST(SlidingBoundary, RefusesPrescribedVerticesThatSlide) {
    const Surface surface = ring();
    const int v = surface.topology.boundary_loops[1][0];
    BoundaryCondition prescribed = outer_loop_stays(surface);
    prescribed.pin(v, 0.3);
    EXPECT_THROW(SlidingBoundary(surface, {inner_loop(surface, 0.3)}, prescribed), Error);
    BoundaryCondition less = outer_loop_stays(surface);
    less.vertices.pop_back();
    less.images.pop_back();
    EXPECT_THROW(SlidingBoundary(surface, {inner_loop(surface, 0.3)}, less), Error);
}

TEST(SlidingMapStep, SlidesToTheConformalMapBesideAPrescribedLoop) {
    // The identity of the outer circle; the inner one starts turned and stretched unevenly.
    const Surface surface = ring();
    const Eigen::VectorXcd z = planar_coordinates(surface.mesh);
    SlidingLoop loop = inner_loop(surface, 0.4);
    for (double& s : loop.parameters) s += 0.05 * std::sin(s / 0.4) + 0.1;
    BoundaryCondition prescribed = outer_loop_stays(surface);
    const int line = inner_vertex(surface, 17);
    prescribed.pin_to_line(line, z[line], Complex(1, 1));
    SlidingBoundary boundary(surface, {loop}, prescribed);
    Eigen::VectorXcd start = z;
    boundary.place(start);
    SlidingMapStep step(surface, boundary, start, 8);
    const Eigen::VectorXcd nu = Eigen::VectorXcd::Zero(surface.operators.sample_count());
    for (int i = 0; i < 12; ++i) step.solve(nu, 1e-11);
    const Eigen::VectorXcd& map = step.map();
    EXPECT_LT(step.movement(), 1e-9);
    EXPECT_LT((map - z).cwiseAbs().maxCoeff(), 1e-8);
    for (const int v : surface.topology.boundary_loops[0]) EXPECT_EQ(map[v], z[v]);
}

TEST(SlidingBoundary, PrescribedVerticesMoveAndOthersKeepTheirPartOfTheWay) {
    const Surface surface(disk(4));
    SlidingLoop loop = circle_loop(surface);
    const int n = static_cast<int>(loop.held.size());
    const auto& vertices = surface.topology.boundary_loops[0];
    loop.held[3] = loop.held[10] = 1;
    BoundaryCondition prescribed;
    for (const int i : {3, 10}) prescribed.pin(vertices[i], loop.curve.point(loop.parameters[i]));
    SlidingBoundary boundary(surface, {loop}, prescribed);
    SlidingLoop places = loop;
    places.parameters[3] += 0.2;
    places.parameters[10] -= 0.1;
    for (std::size_t i : {0, 1}) prescribed.images[i] = loop.curve.point(places.parameters[i == 0 ? 3 : 10]);
    boundary.move(prescribed, {places});
    const SlidingLoop& moved = boundary.loops()[0];
    EXPECT_NEAR(moved.parameters[3], places.parameters[3], 1e-14);
    EXPECT_NEAR(moved.parameters[10], places.parameters[10], 1e-14);
    const double between =
        (loop.parameters[10] - loop.parameters[3] - 0.3) / (loop.parameters[10] - loop.parameters[3]);
    for (int i = 3; i < 10; ++i) EXPECT_NEAR(moved.increment(i), between * loop.increment(i), 1e-12);
    double sum = 0;
    for (int i = 0; i < n; ++i) {
        EXPECT_GT(moved.increment(i), 0);
        sum += moved.increment(i);
    }
    EXPECT_NEAR(sum, loop.curve.length(), 1e-12);
    Eigen::VectorXcd map = planar_coordinates(surface.mesh);
    boundary.place(map);
    EXPECT_EQ(map[vertices[3]], prescribed.images[0]);
    // In place they are all prescribed where they stand.
    const BoundaryCondition all = boundary.in_place();
    EXPECT_EQ(all.vertices.size(), vertices.size());
    for (std::size_t i = 0; i < all.vertices.size(); ++i) EXPECT_EQ(all.images[i], map[all.vertices[i]]);
}
