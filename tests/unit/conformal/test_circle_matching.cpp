#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include <beltrami/conformal/circle_matching.h>
#include <beltrami/mesh/error.h>

namespace beltrami {
namespace {

constexpr double kPi = std::numbers::pi;

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
            EXPECT_NEAR(std::remainder(match.rotation - angle, 2 * kPi), 0, n == 1 ? 0.1 : 0.03);
            EXPECT_LT(match.distance, 0.0101);
            const CircleMatching exact = match_circle_domains(source, image(source, order, angle, 0));
            EXPECT_NEAR(std::remainder(exact.rotation - angle, 2 * kPi), 0, 1e-12);
            EXPECT_LT(exact.distance, 1e-12);
        }
}

TEST(CircleMatching, IsTheBestOfAllPairings) {
    // Against a search over rotations with every permutation, for centres without any relation.
    std::vector<RoundHole> source, target;
    for (int i = 0; i < 5; ++i) {
        source.push_back({i, 0.6 * std::polar(1.0, 1.1 * i * i + 0.3), 0.1});
        target.push_back({i, 0.5 * std::polar(1.0 - 0.1 * i, 2.3 * i), 0.1});
    }
    const CircleMatching match = match_circle_domains(source, target);
    double best = 1e9;
    std::vector<int> order{0, 1, 2, 3, 4};
    do
        for (int k = 0; k < 720; ++k) {
            double sum = 0;
            for (int i = 0; i < 5; ++i)
                sum += std::norm(source[i].centre * std::polar(1.0, k * kPi / 360) - target[order[i]].centre);
            best = std::min(best, std::sqrt(sum / 5));
        }
    while (std::next_permutation(order.begin(), order.end()));
    EXPECT_LE(match.distance, best + 1e-12);
    EXPECT_GT(match.distance, best - 1e-3);
}

TEST(CircleMatching, WithoutRotationPlacesDecide) {
    const std::vector<RoundHole> source = spiral(6);
    std::vector<int> same(6);
    std::iota(same.begin(), same.end(), 0);
    CircleMatchingOptions options;
    options.rotate = false;
    const CircleMatching match = match_circle_domains(source, image(source, same, 0.1, 0), options);
    EXPECT_EQ(match.partner, same);
    EXPECT_EQ(match.rotation, 0);
    EXPECT_GT(match.distance, 0.01);
}

TEST(CircleMatching, OfSymmetricDomainsRadiiDecideThenTheSmallestRotation) {
    std::vector<RoundHole> source, target;
    for (int i = 0; i < 4; ++i) {
        source.push_back({i, std::polar(0.5, i * kPi / 2), i == 1 ? 0.2 : 0.1});
        target.push_back({i, std::polar(0.5, i * kPi / 2 + 0.3), i == 3 ? 0.2 : 0.1});
    }
    EXPECT_EQ(match_circle_domains(source, target).partner, (std::vector<int>{2, 3, 0, 1}));
    for (RoundHole& hole : source) hole.radius = 0.1;
    for (RoundHole& hole : target) hole.radius = 0.1;
    const CircleMatching match = match_circle_domains(source, target);
    EXPECT_EQ(match.partner, (std::vector<int>{0, 1, 2, 3}));
    EXPECT_NEAR(match.rotation, 0.3, 1e-12);
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
