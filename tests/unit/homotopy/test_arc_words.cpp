#include <beltrami/homotopy/arc_words.h>

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <beltrami/generate/round_domains.h>

namespace beltrami {
namespace {

/// Everything within radius r turned by an angle that falls to 0 at the rim: points there go around each other.
Eigen::VectorXcd turned(const Surface& source, double angle, double r) {
    Eigen::VectorXcd map(source.mesh.vertex_count());
    for (int v = 0; v < map.size(); ++v) {
        const Complex z(source.mesh.point(v).x(), source.mesh.point(v).y());
        const double part = std::clamp((1 - std::abs(z)) / (1 - r), 0.0, 1.0);
        map[v] = z * std::polar(1.0, angle * part);
    }
    return map;
}

int vertex_near(const Surface& source, double x, double y) {
    int best = 0;
    for (int v = 0; v < source.mesh.vertex_count(); ++v)
        if ((source.mesh.point(v) - Eigen::Vector3d(x, y, 0)).norm() <
            (source.mesh.point(best) - Eigen::Vector3d(x, y, 0)).norm())
            best = v;
    return best;
}

TEST(ArcWords, TellHowPointsHaveGoneAroundEachOther) {
    const Surface source(disk(24));
    const std::vector<int> pins{vertex_near(source, -0.3, 0), vertex_near(source, 0.3, 0.02),
                                vertex_near(source, 0.05, -0.4)};
    const ArcWords arcs(source, pins, {}, 0);
    const Eigen::VectorXcd still = turned(source, 0, 0.5);
    const ArcWords::Words words = arcs.of(still, {});
    // A whole turn of all of them together is undone by the rim, which slides.
    const double turn = 2 * std::numbers::pi;
    EXPECT_EQ(arcs.of(turned(source, turn, 0.5), {}), words);
    // With a vertex of the rim held it is another class.
    const ArcWords held(source, pins, {source.topology.boundary_loops[0][0]}, 0);
    EXPECT_NE(held.of(turned(source, turn, 0.5), {}), held.of(still, {}));
    // Two of them around each other, the third apart: another class, and the other way around yet another.
    const std::vector<int> far{vertex_near(source, -0.2, 0), vertex_near(source, 0.2, 0.02),
                               vertex_near(source, 0.05, -0.9)};
    const ArcWords apart(source, far, {}, 0);
    const auto about = [&](double angle) {
        Eigen::VectorXcd map = still;
        for (Complex& z : map) z *= std::polar(1.0, angle * std::clamp((0.8 - std::abs(z)) / 0.5, 0.0, 1.0));
        return map;
    };
    EXPECT_NE(apart.of(about(turn), {}), apart.of(still, {}));
    EXPECT_NE(apart.of(about(-turn), {}), apart.of(still, {}));
    EXPECT_NE(apart.of(about(-turn), {}), apart.of(about(turn), {}));
    EXPECT_EQ(apart.of(about(1e-3), {}), apart.of(still, {}));
    // Two points alone cannot be told apart from themselves after a turn.
    const ArcWords two(source, {far[0], far[1]}, {}, 0);
    EXPECT_EQ(two.of(about(turn), {}), two.of(still, {}));
}

TEST(ArcWords, SeeHolesAsPoints) {
    const Surface ring(annulus(0.2, 1, 48));
    const std::vector<int> pins{vertex_near(ring, 0.5, 0), vertex_near(ring, -0.5, 0)};
    const ArcWords arcs(
        ring, pins, {},
        ring.topology.boundary_loops.size() == 2 && ring.mesh.point(ring.topology.boundary_loops[0][0]).norm() > 0.9
            ? 0
            : 1);
    const Eigen::VectorXcd still = turned(ring, 0, 0.5);
    const auto words = arcs.of(still, {0.0});
    EXPECT_EQ(arcs.of(turned(ring, 2 * std::numbers::pi, 0.6), {0.0}), words);  // hole and pins turn together
    Eigen::VectorXcd outside = still;                                           // one point around hole and other point
    for (Complex& z : outside) {
        const Complex from = z;
        const double part = std::clamp((0.45 - std::abs(from)) / 0.2, 0.0, 1.0);
        z = from * std::polar(1.0, 2 * std::numbers::pi * part);  // the hole turns alone: it slides back
    }
    EXPECT_EQ(arcs.of(outside, {0.0}), words);
}

}  // namespace
}  // namespace beltrami
