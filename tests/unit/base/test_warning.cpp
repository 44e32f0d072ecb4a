#include <gtest/gtest.h>

#include <set>

#include <beltrami/base/effort.h>
#include <beltrami/base/warning.h>

namespace beltrami {
namespace {

TEST(Warning, KindsHaveNamesOfTheirOwn) {
    std::set<std::string> names;
    for (int kind = 0; kind <= static_cast<int>(WarningKind::hint); ++kind)
        names.insert(to_string(static_cast<WarningKind>(kind)));
    EXPECT_EQ(names.size(), static_cast<std::size_t>(WarningKind::hint) + 1);
    EXPECT_FALSE(names.contains("unknown"));
}

TEST(Warning, TakesANameBeforeItsSentence) {
    const Warning warning{WarningKind::flipped_faces, "2 faces are flipped", {Things::faces, {3, 5}}};
    const Warning named = prefixed("mips", warning);
    EXPECT_EQ(named.sentence, "mips: 2 faces are flipped");
    EXPECT_EQ(named.kind, warning.kind);
    EXPECT_EQ(named.where, warning.where);
    Warnings all{warning};
    append(all, {named});
    EXPECT_EQ(sentences(all), (std::vector<std::string>{warning.sentence, named.sentence}));
}

TEST(Where, OfAPartIsGivenInNumbersOfTheWhole) {
    const std::vector<int> vertices{2, 4, 9}, faces{1, 7};
    EXPECT_EQ(in_whole({Things::vertices, {0, 2}}, vertices, faces), (Where{Things::vertices, {2, 9}}));
    EXPECT_EQ(in_whole({Things::edges, {0, 1}}, vertices, faces), (Where{Things::edges, {2, 4}}));
    EXPECT_EQ(in_whole({Things::faces, {1}}, vertices, faces), (Where{Things::faces, {7}}));
    EXPECT_EQ(in_whole({Things::faces, {2}}, vertices, faces), Where());
    EXPECT_EQ(in_whole({Things::loops, {0}}, vertices, faces), Where());
}

TEST(Effort, IsCounted) {
    const std::int64_t before = effort(Work::factorization), others = effort(Work::circle_chart);
    count(Work::factorization);
    count(Work::factorization);
    EXPECT_EQ(effort(Work::factorization) - before, 2);
    EXPECT_EQ(effort(Work::circle_chart), others);
}

}  // namespace
}  // namespace beltrami
