#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include <beltrami/plane/segment_tree.h>

namespace beltrami {
namespace {

TEST(Segments, Meet) {
    EXPECT_TRUE(segments_meet({0, {2, 2}}, {{0, 2}, {2, 0}}));
    EXPECT_TRUE(segments_meet({0, 2}, {{1, 0}, {1, 1}})) << "touching from one side";
    EXPECT_TRUE(segments_meet({0, 2}, {1, 3})) << "overlapping";
    EXPECT_TRUE(segments_meet({0, 2}, {2, {3, 1}})) << "a common end";
    EXPECT_TRUE(segments_meet({0, 2}, {1, 1})) << "a point on it";
    EXPECT_FALSE(segments_meet({0, 1}, {2, 3}));
    EXPECT_FALSE(segments_meet({0, {2, 2}}, {{1, 0}, {2, 1}}));
    EXPECT_FALSE(segments_meet({0, {2, 2}}, {{1, 0.5}, {1, 0.5}}));
}

TEST(Segments, PiecesOfOneLineDoNotMeet) {
    for (int turn = 0; turn < 24; ++turn) {
        std::vector<Complex> line;
        for (int i = 0; i <= 100; ++i)
            line.push_back(std::polar(0.01 * i, turn * std::numbers::pi / 12) + Complex(0.3, 7));
        for (int i = 0; i + 3 < 100; ++i)
            EXPECT_FALSE(segments_meet({line[i], line[i + 1]}, {line[i + 2], line[i + 3]}));
    }
}

TEST(Segments, Distance) {
    EXPECT_EQ(distance({1, 3}, {0, 2}), 3);
    EXPECT_EQ(distance({-3, 4}, {0, 2}), 5);
    EXPECT_EQ(distance({5, 4}, {0, 2}), 5);
    EXPECT_EQ(distance({3, 4}, {0, 0}), 5);
}

TEST(SegmentTree, FindsWhatComparingAllFinds) {
    std::mt19937 random(5);
    const auto uniform = [&] { return static_cast<double>(random()) / static_cast<double>(random.max()); };
    for (const int n : {0, 1, 2, 5, 400}) {
        std::vector<Segment> segments;
        for (int i = 0; i < n; ++i) {
            const Complex a(uniform(), uniform());
            segments.push_back({a, a + std::pow(10.0, -4 * uniform()) * Complex(uniform() - 0.5, uniform() - 0.5)});
        }
        const SegmentTree tree(segments);
        for (int i = 0; i < n; ++i) {
            std::vector<int> found, expected;
            tree.for_each(SegmentTree::Box::of(segments[i]), [&](int j) { found.push_back(j); });
            std::sort(found.begin(), found.end());
            for (int j = 0; j < n; ++j)
                if (SegmentTree::Box::of(segments[i]).overlaps(SegmentTree::Box::of(segments[j])))
                    expected.push_back(j);
            EXPECT_EQ(found, expected);
        }
    }
}

}  // namespace
}  // namespace beltrami
