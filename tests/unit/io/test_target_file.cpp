#include <gtest/gtest.h>

#include <beltrami/base/error.h>
#include <beltrami/io/target_file.h>

#include "unit/io/support.h"

namespace beltrami {
namespace {

using io_tests::expect_error;

TEST(TargetFile, ReadsEveryLoop) {
    const TargetDomain domain = parse_target_domain(
        R"({"outer": {"polygon": [[0, 0], [0, 4], [4, 4], [4, 0]]},
            "holes": [{"circle": [1, 1, 0.5]}, {"spline": [[2, 2], [3, 2], [3, 3], [2, 3]]}]})",
        "t.json");
    EXPECT_EQ(domain.curve_count(), 3);
    EXPECT_EQ(domain.outer.length(), 16);
    EXPECT_TRUE(domain.outer.counter_clockwise());
    EXPECT_EQ(domain.holes[0].radius(), 0.5);
    EXPECT_EQ(domain.holes[1].kind(), TargetCurve::Kind::spline);
    EXPECT_FALSE(domain.holes[1].counter_clockwise());
    EXPECT_EQ(parse_target_domain(R"({"outer": {"circle": [0, 0, 1]}})", "t").curve_count(), 1);
}

TEST(TargetFile, ComesBackToTheLastBit) {
    const io_tests::TemporaryFolder folder;
    const TargetDomain domain = target_domain(
        TargetCurve::spline({{0.1, 1.0 / 3}, {10, 0}, {11.7, 9}, {0, 10}}),
        {TargetCurve::circle({5, 5}, std::sqrt(2.0)), TargetCurve::polygon({{1, 1}, {2.0 / 3, 2}, {2, 2.1}})});
    write_target_domain(folder / "domain.json", domain);
    const TargetDomain back = read_target_domain(folder / "domain.json");
    ASSERT_EQ(back.curve_count(), domain.curve_count());
    for (int c = 0; c < domain.curve_count(); ++c) {
        EXPECT_EQ(back.curve(c).kind(), domain.curve(c).kind());
        EXPECT_EQ(back.curve(c).points(), domain.curve(c).points());
        EXPECT_EQ(back.curve(c).centre(), domain.curve(c).centre());
        EXPECT_EQ(back.curve(c).radius(), domain.curve(c).radius());
        EXPECT_EQ(back.curve(c).length(), domain.curve(c).length());
    }
    EXPECT_EQ(format_target_domain(back), format_target_domain(domain));
    expect_error(Cause::unwritable, "cannot write", [&] { write_target_domain(folder / "no/domain.json", domain); });
}

TEST(TargetFile, RefusesWhatIsNoDomain) {
    const auto expect = [](Cause cause, const std::string& text, const std::string& part) {
        expect_error(cause, part, [&] { parse_target_domain(text, "t.json"); });
        expect_error(cause, "t.json", [&] { parse_target_domain(text, "t.json"); });
    };
    const auto outer = [&](const std::string& loop, const std::string& part) {
        expect(Cause::bad_option, R"({"outer": )" + loop + "}", part);
    };
    const auto holes = [&](const std::string& list, const std::string& part) {
        expect(Cause::bad_option, R"({"outer": {"circle": [0, 0, 2]}, "holes": )" + list + "}", part);
    };
    expect(Cause::unreadable, "", "parse error");
    expect(Cause::unreadable, "{\"outer\":\n {\"circle\": [0, 0,", "line 2");
    expect(Cause::unreadable, R"({"outer": {"circle": [0, 0, 1e999]}})", "1e999");
    expect(Cause::unreadable, R"({"outer": {"circle": [0, 0, NaN]}})", "parse error");
    expect(Cause::unreadable, "{\"outer\": \"\xff\"}", "UTF-8");
    expect(Cause::bad_option, "[]", "no outer loop");
    expect(Cause::bad_option, "null", "no outer loop");
    expect(Cause::bad_option, R"({"holes": []})", "no outer loop");
    expect(Cause::bad_option, R"({"outer": {"circle": [0, 0, 1]}, "hole": []})", "\"hole\" is not known");
    outer("7", "the outer curve is not one");
    outer("{}", "the outer curve is not one");
    outer(R"({"circle": [0, 0, 1], "polygon": []})", "not one circle, polygon or spline");
    outer(R"({"disk": [0, 0, 1]})", "\"disk\", which is not known");
    outer(R"({"circle": [0, 0]})", "not three numbers");
    outer(R"({"circle": [0, 0, "1"]})", "not three numbers");
    outer(R"({"circle": [0, 0, 1, 2]})", "not three numbers");
    outer(R"({"circle": {"x": 0, "y": 0, "r": 1}})", "not three numbers");
    outer(R"({"circle": [0, 0, -1]})", "the outer curve: the circle has no positive");
    outer(R"({"polygon": 3})", "no list of points");
    outer(R"({"polygon": []})", "only 0 corners");
    outer(R"({"polygon": [[0, 0], [1, 0], [1]]})", "point 2 of the outer curve");
    outer(R"({"polygon": [[0, 0], [1, null], [1, 1]]})", "point 1 of the outer curve");
    outer(R"({"polygon": [[0, 0], [2, 2], [2, 0], [0, 2]]})", "sides 0 and 2");
    outer(R"({"spline": [[0, 0], [2, 2], [2, 0], [0, 2]]})", "meets itself");
    holes("{}", "not a list");
    holes("[3]", "hole 0 is not one");
    holes(R"([{"circle": [0, 0, 1]}, {"circle": [0, 0, 0]}])", "hole 1: the circle has no positive");
    holes(R"([{"circle": [0, 0, 2]}])", "the outer curve and hole 0 meet");
    holes(R"([{"circle": [0, 0, 0.5]}, {"circle": [0.5, 0, 0.5]}])", "hole 0 and hole 1 meet");
    holes(R"([{"circle": [9, 0, 0.5]}])", "hole 0 lies outside");
    // Deep nesting ends in a sentence, not in a crash.
    std::string deep = R"({"outer": {"polygon": )" + std::string(200000, '[') + std::string(200000, ']') + "}}";
    expect(Cause::bad_option, deep, "point 0 of the outer curve");
    expect(Cause::unreadable, std::string(200000, '['), "parse error");
    expect_error(Cause::unreadable, "no such file", [] { read_target_domain("/nowhere/domain.json"); });
}

}  // namespace
}  // namespace beltrami
