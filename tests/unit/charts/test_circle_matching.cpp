#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include <beltrami/base/constants.h>
#include <beltrami/base/error.h>
#include <beltrami/charts/circle_matching.h>

namespace beltrami {
namespace {

std::vector<RoundHole> spiral(int n) {
    std::vector<RoundHole> holes;
    for (int i = 0; i < n; ++i)
        holes.push_back({i + 1, std::polar(0.85 * std::sqrt((i + 0.5) / n), 2.399963 * i), 0.02 + 0.001 * i});
    return holes;
}

/// Turned, moved a little, in another order.
std::vector<RoundHole> image(const std::vector<RoundHole>& holes, const std::vector<int>& order, double angle,
                             double noise) {
    std::vector<RoundHole> result(holes.size());
    for (std::size_t i = 0; i < holes.size(); ++i) {
        result[order[i]] = holes[i];
        result[order[i]].centre =
            holes[i].centre * std::polar(1.0, angle) + noise * std::polar(1.0, 1.7 * static_cast<double>(i * i));
    }
    return result;
}

TEST(CircleMatching, FindsOrderAndRotation) {
    for (const int n : {1, 2, 3, 5, 8, 9, 14, 30})
        for (const double angle : {0.0, 0.4, -2.9, 3.1}) {
            const std::vector<RoundHole> source = spiral(n);
            std::vector<int> order(n);
            for (int i = 0; i < n; ++i) order[i] = (7 * i + 3) % n;  // 7 divides only 14
            if (n == 14)
                for (int i = 0; i < n; ++i) order[i] = (5 * i + 3) % n;
            const CircleMatching match = match_circle_domains(source, image(source, order, angle, 0.01));
            EXPECT_EQ(match.partner, order);
            EXPECT_NEAR(std::remainder(match.move.rotation - angle, 2 * kPi), 0, 0.1);
            EXPECT_LT(match.distance, 0.05);
            const CircleMatching exact = match_circle_domains(source, image(source, order, angle, 0));
            EXPECT_NEAR(std::remainder(exact.move.rotation - angle, 2 * kPi), 0, n == 1 ? 1e-5 : 1e-7);
            EXPECT_LT(std::abs(exact.move.centre), n == 1 ? 1e-5 : 1e-7);
            EXPECT_LT(exact.distance, 1e-7);
        }
}

TEST(CircleMatching, MoebiusMapsOfADomainChangeNothing) {
    for (const int n : {3, 5, 8, 9, 20}) {
        const std::vector<RoundHole> source = spiral(n);
        std::vector<int> order(n);
        for (int i = 0; i < n; ++i) order[i] = (7 * i + 3) % n;
        const std::vector<RoundHole> near = image(source, order, 0.4, 0.005);
        for (const DiskMoebius& move : {DiskMoebius{2.1, {0.5, 0.3}}, DiskMoebius{-1, {-0.2, 0.75}}}) {
            std::vector<RoundHole> copy(n), moved;
            for (int i = 0; i < n; ++i) copy[order[i]] = move(source[i]);
            const CircleMatching exact = match_circle_domains(source, copy);
            EXPECT_EQ(exact.partner, order);
            EXPECT_LT(exact.distance, 1e-8);
            EXPECT_NEAR(std::abs(exact.move.centre - move.centre), 0, 1e-8);
            EXPECT_NEAR(std::remainder(exact.move.rotation - move.rotation, 2 * kPi), 0, 1e-8);
            for (const RoundHole& hole : near) moved.push_back(move(hole));
            const CircleMatching plain = match_circle_domains(source, near), far = match_circle_domains(source, moved);
            EXPECT_EQ(far.partner, plain.partner);
            EXPECT_EQ(plain.partner, order);
            EXPECT_NEAR(far.distance, plain.distance, 1e-9);
        }
    }
}

/// The sum that the matching minimises.
double sum_of_gaps(const DiskMoebius& move, const std::vector<RoundHole>& source, const std::vector<RoundHole>& target,
                   const std::vector<int>& partner) {
    double sum = 0;
    for (std::size_t i = 0; i < source.size(); ++i)
        sum += hyperbolic_gap(move(hyperbolic_circle(source[i]).centre), hyperbolic_circle(target[partner[i]]).centre);
    return sum;
}

TEST(CircleMatching, IsTheBestOfAllPairings) {
    // Against a search over Möbius maps with every permutation, for centres without any relation.
    std::vector<RoundHole> source, target;
    for (int i = 0; i < 4; ++i) {
        source.push_back({i, 0.6 * std::polar(1.0, 1.1 * i * i + 0.3), 0.1});
        target.push_back({i, 0.5 * std::polar(1.0 - 0.1 * i, 2.3 * i), 0.1});
    }
    const CircleMatching match = match_circle_domains(source, target);
    const double found = sum_of_gaps(match.move, source, target, match.partner);
    double best = 1e9;
    std::vector<int> order{0, 1, 2, 3};
    do
        for (int k = 0; k < 72; ++k)
            for (int x = -8; x <= 8; ++x)
                for (int y = -8; y <= 8; ++y)
                    if (x * x + y * y < 80)
                        best = std::min(best, sum_of_gaps({k * kPi / 36, {0.1 * x, 0.1 * y}}, source, target, order));
    while (std::next_permutation(order.begin(), order.end()));
    EXPECT_LE(found, best * (1 + 1e-12));
    EXPECT_GT(found, 0.8 * best);
    // A minimum: maps near by are worse.
    for (int k = 0; k < 6; ++k) {
        DiskMoebius other = match.move;
        if (k < 2) other.rotation += k % 2 ? 1e-3 : -1e-3;
        if (k >= 2) other.centre += 1e-3 * std::polar(1.0, k * kPi / 2);
        EXPECT_GT(sum_of_gaps(other, source, target, match.partner), found);
    }
}

TEST(CircleMatching, MarkedPlacesCount) {
    // One hole leaves a turn open, which a place on the unit circle settles.
    const std::vector<RoundHole> source{{1, {0.3, 0.2}, 0.2}};
    const DiskMoebius move{0.8, {-0.4, 0.1}};
    CircleMatchingOptions options;
    const Complex place = std::polar(1.0, 1.2);
    options.places = {{place, move(place)}};
    const std::vector<RoundHole> target{move(source[0])};
    const CircleMatching match = match_circle_domains(source, target, options);
    EXPECT_NEAR(std::abs(match.move.centre - move.centre), 0, 1e-8);
    EXPECT_NEAR(match.move.rotation, move.rotation, 1e-8);
    // Three places of the circle settle the whole map; two holes of it go where they must.
    std::vector<PlacePair> three;
    for (const double t : {0.1, 2.0, 4.5}) three.push_back({std::polar(1.0, t), move(std::polar(1.0, t))});
    EXPECT_NEAR(std::abs(best_move(three).centre - move.centre), 0, 1e-8);
    EXPECT_EQ(std::abs(best_move({}).centre), 0);
    // One place is reached by turning alone.
    const std::vector<PlacePair> one{{Complex(0.5, 0), Complex(0, 0.5)}};
    EXPECT_NEAR(std::abs(best_move(one).centre), 0, 1e-5);
    EXPECT_NEAR(best_move(one).rotation, kPi / 2, 1e-5);
    EXPECT_NEAR(best_rotation(one).rotation, kPi / 2, 1e-12);
}

/// Pairs that are known stand; the best of the other correspondences is found beside them, for few holes and for many.
TEST(CircleMatching, KnownPairsStand) {
    for (const int n : {4, 12}) {
        std::vector<RoundHole> holes;
        for (int i = 0; i < n; ++i) holes.push_back({i + 1, std::polar(0.6, 2 * kPi * i / n), 0.05});
        CircleMatchingOptions options;
        options.pairs = {{0, 1}};
        for (const MatchBy by : {MatchBy::position, MatchBy::size}) {
            options.by = by;
            const CircleMatching match = match_circle_domains(holes, holes, options);
            EXPECT_EQ(match.partner[0], 1);
            std::vector<int> sorted = match.partner;
            std::sort(sorted.begin(), sorted.end());
            for (int i = 0; i < n; ++i) EXPECT_EQ(sorted[i], i);
            if (by == MatchBy::size) continue;
            for (int i = 0; i < n; ++i) EXPECT_EQ(match.partner[i], (i + 1) % n);  // all turn with it
            EXPECT_NEAR(match.move.rotation, 2 * kPi / n, 1e-6);
        }
    }
}

TEST(CircleMatching, TwoHolesArePairedByTheirSizes) {
    // Any two places can be exchanged by a Möbius map.
    const std::vector<RoundHole> source{{1, {0.5, 0}, 0.1}, {2, {-0.3, 0.2}, 0.3}};
    const std::vector<RoundHole> target{{1, {0.5, 0}, 0.3}, {2, {-0.3, 0.2}, 0.1}};
    EXPECT_EQ(match_circle_domains(source, target).partner, (std::vector<int>{1, 0}));
    EXPECT_EQ(match_circle_domains(source, source).partner, (std::vector<int>{0, 1}));
    EXPECT_LT(std::abs(match_circle_domains(source, source).move.centre), 1e-8);
}

TEST(CircleMatching, CollinearHolesAreNoSpecialCase) {
    const std::vector<RoundHole> source{{1, -0.6, 0.1}, {2, 0.05, 0.1}, {3, 0.5, 0.1}};
    const DiskMoebius move{2.5, {0.3, 0.4}};
    std::vector<RoundHole> target;
    for (const int i : {2, 0, 1}) target.push_back(move(source[i]));
    const CircleMatching match = match_circle_domains(source, target);
    EXPECT_EQ(match.partner, (std::vector<int>{1, 2, 0}));
    EXPECT_NEAR(std::abs(match.move.centre - move.centre), 0, 1e-8);
}

TEST(CircleMatching, OfSymmetricDomainsRadiiDecideThenTheSmallestRotation) {
    std::vector<RoundHole> source, target;
    for (int i = 0; i < 4; ++i) {
        source.push_back({i, std::polar(0.5, i * kPi / 2), 0.1});
        target.push_back({i, std::polar(0.5, i * kPi / 2 + 0.3), 0.1});
    }
    const CircleMatching match = match_circle_domains(source, target);
    EXPECT_EQ(match.partner, (std::vector<int>{0, 1, 2, 3}));
    EXPECT_NEAR(match.move.rotation, 0.3, 1e-9);
    // Holes of other radii about the same hyperbolic centres.
    const auto grow = [](RoundHole& hole) {
        const HyperbolicCircle circle = hyperbolic_circle(hole);
        const DiskMoebius away{0, -circle.centre};
        hole = away(RoundHole{hole.loop, 0, 0.2});
    };
    grow(source[1]);
    grow(target[3]);
    EXPECT_EQ(match_circle_domains(source, target).partner, (std::vector<int>{2, 3, 0, 1}));
}

TEST(CircleMatching, BySizeAndBadInput) {
    std::vector<RoundHole> source{{1, {0.5, 0}, 0.1}, {2, {-0.5, 0}, 0.3}},
        target{{1, {0.4, 0}, 0.2}, {2, {0, 0.4}, 0.1}};
    CircleMatchingOptions options;
    options.by = MatchBy::size;
    EXPECT_EQ(match_circle_domains(source, target, options).partner, (std::vector<int>{1, 0}));
    EXPECT_TRUE(match_circle_domains({}, {}).partner.empty());
    source.pop_back();
    EXPECT_THROW(match_circle_domains(source, target), Error);
}

}  // namespace
}  // namespace beltrami
