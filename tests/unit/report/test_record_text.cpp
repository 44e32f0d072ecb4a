#include <gtest/gtest.h>

#include <limits>

#include <beltrami/report/record_text.h>

namespace beltrami {
namespace {

TEST(RecordText, WithoutAMapThereIsNoTable) {
    EXPECT_EQ(to_table(Record(), "extremal"), "");
    EXPECT_EQ(to_sentence(Record()), "");
}

TEST(RecordText, TheTableHasALineForEveryMethod) {
    Record record;
    record.map.emplace();
    record.map->k = 0.25;
    record.map->K_max = std::numeric_limits<double>::infinity();
    record.comparison.push_back({"lscm", {}, {}});
    const std::string table = to_table(record, "extremal");
    EXPECT_NE(table.find("0.2500"), std::string::npos);
    EXPECT_NE(table.find("inf"), std::string::npos);
    EXPECT_LT(table.find("extremal"), table.find("lscm"));
}

/// What is said stays true: a bound is rounded down, what the map attains up; and a proof is one of this very bound.
TEST(RecordText, SentencesAreRoundedToTheTrueSide) {
    Record record;
    record.map.emplace();
    record.map->K_lower = 1.99999;
    record.map->p99 = 0.5;  // K = 3
    record.map->bounds = {{Bound::Kind::pair, 1.99999, Bound::Of::extremal, true}};
    EXPECT_NE(to_sentence(record).find("less than K = 1.999 (proved up to rounding)"), std::string::npos);
    EXPECT_NE(to_sentence(record).find("at most 3.0"), std::string::npos);
    record.map->bounds = {{Bound::Kind::pair, 1.5, Bound::Of::extremal, true},
                          {Bound::Kind::reich_strebel, 1.99999, Bound::Of::extremal, false}};
    record.map->K_lower_proved = 1.5;
    EXPECT_NE(to_sentence(record).find("(estimate; proved: K = 1.500)"), std::string::npos);
}

TEST(RecordText, RemarksSayWhichHolesAreTurned) {
    Record record;
    record.homotopy = HomotopyClass{0, {{1, 2, 0, 0, 0, true}, {2, 0, 0, 0, 0, true}, {3, 1, 0, 0, 0, false}}};
    const std::string text = to_remarks(record);
    EXPECT_NE(text.find("turned is loop 1 by +2 against loop 0"), std::string::npos);
    EXPECT_NE(text.find("cannot be told of loop 3"), std::string::npos);
}

}  // namespace
}  // namespace beltrami
