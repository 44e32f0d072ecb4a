#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>

#include <beltrami/report/record_json.h>

namespace beltrami {
namespace {

using OrderedJson = nlohmann::ordered_json;

Record record_of_map() {
    Record record;
    record.command = "map";
    record.source = {4, 2, {}};
    record.map.emplace();
    return record;
}

TEST(RecordJson, KeysThatDoNotApplyAreAbsent) {
    const OrderedJson json = OrderedJson::parse(to_json(record_of_map()));
    EXPECT_EQ(json["schema"], 1);
    EXPECT_EQ(json["source"], OrderedJson({{"vertices", 4}, {"faces", 2}}));
    EXPECT_FALSE(json["map"].contains("k"));
    EXPECT_FALSE(json.contains("solve"));
    EXPECT_TRUE(json["warnings"].empty());
    EXPECT_FALSE(json.contains("warning_details"));
}

TEST(RecordJson, NumbersComeBackAndWhatIsNotFiniteIsNull) {
    Record record = record_of_map();
    record.map->k = 0.1 + 0.2;
    record.map->K_max = std::numeric_limits<double>::infinity();
    record.map->mean = std::numeric_limits<double>::quiet_NaN();
    const OrderedJson json = OrderedJson::parse(to_json(record));
    EXPECT_EQ(json["map"]["k"].get<double>(), 0.1 + 0.2);
    EXPECT_TRUE(json["map"]["K_max"].is_null());
    EXPECT_TRUE(json["map"]["mu"]["mean"].is_null());
}

TEST(RecordJson, ListsAHundredPlacesAndCountsAll) {
    Record record = record_of_map();
    std::vector<int> faces(250);
    std::iota(faces.begin(), faces.end(), 0);
    record.warnings.push_back({WarningKind::flipped_faces, "\xff is no UTF-8", {Things::faces, faces}});
    const OrderedJson details = OrderedJson::parse(to_json(record))["warning_details"][0];
    EXPECT_EQ(details["kind"], "flipped_faces");
    EXPECT_EQ(details["of"], "faces");
    EXPECT_EQ(details["count"], 250);
    EXPECT_EQ(details["indices"].size(), 100U);
}

}  // namespace
}  // namespace beltrami
