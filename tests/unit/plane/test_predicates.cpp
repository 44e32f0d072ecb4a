#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include <beltrami/base/random.h>
#include <beltrami/plane/predicates.h>

namespace beltrami {
namespace {

__extension__ using Wide = __int128;

int sign(double x) {
    return (x > 0.0) - (x < 0.0);
}
int sign(Wide x) {
    return (x > 0) - (x < 0);
}

struct Lattice {
    std::int64_t x, y;
    Eigen::Vector2d at(double unit) const { return {unit * static_cast<double>(x), unit * static_cast<double>(y)}; }
};

Wide exact_orient(Lattice a, Lattice b, Lattice c) {
    return Wide(a.x - c.x) * (b.y - c.y) - Wide(a.y - c.y) * (b.x - c.x);
}

Wide exact_incircle(Lattice a, Lattice b, Lattice c, Lattice d) {
    const Wide ax = a.x - d.x, ay = a.y - d.y, bx = b.x - d.x, by = b.y - d.y, cx = c.x - d.x, cy = c.y - d.y;
    return (ax * ax + ay * ay) * (bx * cy - by * cx) + (bx * bx + by * by) * (cx * ay - cy * ax) +
           (cx * cx + cy * cy) * (ax * by - ay * bx);
}

TEST(Predicates, OrientAgreesWithIntegersNearAndOnLines) {
    Random random(1);
    const auto coordinate = [&] { return static_cast<std::int64_t>(random.next() >> 12) - (std::int64_t{1} << 51); };
    int zeros = 0;
    for (int trial = 0; trial < 20000; ++trial) {
        const Lattice a{coordinate() / 8, coordinate() / 8}, b{coordinate() / 8, coordinate() / 8};
        // Almost on the line: a + k (b − a) / 4, off by a lattice step or two.
        const std::int64_t k = static_cast<std::int64_t>(random.next() % 9) - 2;
        const Lattice c{a.x + (b.x - a.x) / 4 * k + static_cast<std::int64_t>(random.next() % 3) - 1,
                        a.y + (b.y - a.y) / 4 * k};
        const Wide exact = exact_orient(a, b, c);
        zeros += exact == 0;
        ASSERT_EQ(sign(orient2d(a.at(0x1p-40), b.at(0x1p-40), c.at(0x1p-40))), sign(exact));
    }
    for (int i = 0; i < 100; ++i) {
        const Lattice a{i, 2 * i}, b{1000 + i, 2 * (1000 + i)}, c{77, 154};
        EXPECT_EQ(orient2d(a.at(0.125), b.at(0.125), c.at(0.125)), 0.0);
    }
    EXPECT_GT(zeros, 100);
}

TEST(Predicates, OrientIsAntisymmetricWhereDoublesRound) {
    // Points next to (12, 12) and (24, 24) on a grid of single bits: naive evaluation gives a wrong sign for many.
    const double bit = 0x1p-53;
    int naive_errors = 0;
    for (int i = 0; i < 64; ++i) {
        for (int j = 0; j < 64; ++j) {
            const Eigen::Vector2d p(0.5 + i * bit, 0.5 + j * bit), q(12, 12), r(24, 24);
            const int expected = sign(static_cast<double>(j - i));
            ASSERT_EQ(sign(orient2d(p, q, r)), expected);
            ASSERT_EQ(sign(orient2d(q, r, p)), expected);
            ASSERT_EQ(sign(orient2d(q, p, r)), -expected);
            const double naive = (q.x() - p.x()) * (r.y() - p.y()) - (q.y() - p.y()) * (r.x() - p.x());
            naive_errors += sign(naive) != expected;
        }
    }
    EXPECT_GT(naive_errors, 0);
}

TEST(Predicates, IncircleAgreesWithIntegersNearAndOnCircles) {
    // Lattice points of x² + y² = 5²·13²·17²·29², scaled and shifted, moved by a lattice step or not.
    const std::int64_t r = 5 * 13 * 17 * 29;
    std::vector<Lattice> circle;
    for (std::int64_t x = -r; x <= r; ++x) {
        const std::int64_t y = std::llround(std::sqrt(static_cast<double>(r * r - x * x)));
        if (x * x + y * y != r * r) continue;
        circle.push_back({x, y});
        if (y > 0) circle.push_back({x, -y});
    }
    ASSERT_GT(circle.size(), 50u);
    Random random(3);
    int zeros = 0;
    for (int trial = 0; trial < 20000; ++trial) {
        const auto pick = [&] {
            Lattice p = circle[random.next() % circle.size()];
            return Lattice{512 * p.x + 123457, 512 * p.y - 7654321};
        };
        Lattice a = pick(), b = pick(), c = pick(), d = pick();
        d.x += static_cast<std::int64_t>(random.next() % 3) - 1;
        if (exact_orient(a, b, c) == 0) continue;
        if (exact_orient(a, b, c) < 0) std::swap(a, b);
        const Wide exact = exact_incircle(a, b, c, d);
        zeros += exact == 0;
        ASSERT_EQ(sign(incircle(a.at(0x1p-20), b.at(0x1p-20), c.at(0x1p-20), d.at(0x1p-20))), sign(exact));
    }
    EXPECT_GT(zeros, 1000);
}

TEST(Predicates, IncircleOfAnySquareIsZero) {
    Random random(5);
    for (int trial = 0; trial < 1000; ++trial) {
        const double x = random.uniform(-1, 1), y = random.uniform(-1, 1);
        // Exact in any rounding: the corners are reflections of one point.
        EXPECT_EQ(incircle({x, y}, {-x, y}, {-x, -y}, {x, -y}), 0.0);
    }
}

}  // namespace
}  // namespace beltrami
