/// Tables and reports of marks: every number is under its own name. All numbers here are different.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "plugin/report/mark_results.h"
#include "plugin/report/marks_text.h"
#include "plugin/testing/csv_rows.h"

namespace palpate::plugin {
namespace {

using ::testing::ElementsAre;
using testing::Row;
using testing::rows_of;

Marks marks() {
  Marks all;
  all.points = {
      {.name = "A, left",
       .tick = 7,
       .time_s = 1.25,
       .position_mm = {1, -2, 3},
       .boundary = "skin",
       .value = 41.5,
       .force_n = 0.5},
      {.name = "B", .time_s = 2.5, .position_mm = {4, 5, -6}, .boundary = "bone", .value = 300, .force_n = 0.75},
      {.name = "C", .time_s = 3.5, .position_mm = {7, 8, 9}, .value = std::nan(""), .force_n = 0}};
  all.paths = {{.name = "P",
                .begin_s = 4.5,
                .end_s = 5.5,
                .points_mm = {{11, 12, 13}, {14, 16, 13}},
                .length_mm = 5,
                .touched_mm = 2}};
  all.distances = {{.from = 1, .to = 2, .mm = 15.5}};
  all.angles = {{.from = 2, .at = 0, .to = 1, .degrees = 77.5}};
  return all;
}

TEST(MarksTables, ColumnsAreWhatTheyAreCalled) {
  Marks all = marks();
  all.distances.push_back({.from = 0, .to = 1, .mm = 11.75});
  all.distances.push_back({.from = 2, .to = 0, .mm = 4});
  EXPECT_THAT(rows_of(marks_as_csv(all)),
              ElementsAre(Row{{"kind", "mark"},
                              {"name", "A, left"},
                              {"time_s", "1.250"},
                              {"x_mm", "1.0000"},
                              {"y_mm", "-2.0000"},
                              {"z_mm", "3.0000"},
                              {"boundary", "skin"},
                              {"value", "41.5"},
                              {"force_n", "0.5000"}},
                          Row{{"kind", "mark"},
                              {"name", "B"},
                              {"time_s", "2.500"},
                              {"x_mm", "4.0000"},
                              {"y_mm", "5.0000"},
                              {"z_mm", "-6.0000"},
                              {"boundary", "bone"},
                              {"value", "300"},
                              {"force_n", "0.7500"}},
                          Row{{"kind", "mark"},
                              {"name", "C"},
                              {"time_s", "3.500"},
                              {"x_mm", "7.0000"},
                              {"y_mm", "8.0000"},
                              {"z_mm", "9.0000"},
                              {"force_n", "0.0000"}},
                          Row{{"kind", "path"},
                              {"name", "P"},
                              {"time_s", "4.500"},
                              {"x_mm", "11.0000"},
                              {"y_mm", "12.0000"},
                              {"z_mm", "13.0000"},
                              {"length_mm", "5.0000"}},
                          Row{{"kind", "distance"}, {"name", "B to C"}, {"length_mm", "15.5000"}},
                          Row{{"kind", "distance"}, {"name", "A, left to B"}, {"length_mm", "11.7500"}},
                          Row{{"kind", "distance"}, {"name", "C to A, left"}, {"length_mm", "4.0000"}},
                          Row{{"kind", "angle"}, {"name", "A, left"}, {"angle_deg", "77.500"}}));
}

/// RFC 4180: a cell is quoted where it has to be, and a quote in it is doubled.
TEST(MarksTables, TheMarksCellsAreQuotedWhereTheyHaveToBe) {
  Marks all;
  for (const char* const name : {"plain", "a, b", "say \"ah\"", "two\nlines"}) all.points.push_back({.name = name});
  const std::string csv = marks_as_csv(all);
  for (const char* const line :
       {"\nmark,plain,", "\nmark,\"a, b\",", "\nmark,\"say \"\"ah\"\"\",", "\nmark,\"two\nlines\","}) {
    EXPECT_THAT(csv, ::testing::HasSubstr(line));
  }
}

TEST(MarksTables, TheMarksJsonIsWhatItIsCalled) {
  using Json = nlohmann::json;
  const Json json = Json::parse(marks_as_json(marks(), "HU"));
  EXPECT_EQ(json["unit"], "HU");
  EXPECT_EQ(json["marks"][0], Json::parse(R"({"name": "A, left", "tick": 7, "time_s": 1.25, "position_mm": [1, -2, 3],
      "boundary": "skin", "value": 41.5, "force_n": 0.5})"));
  EXPECT_TRUE(json["marks"][2]["value"].is_null());
  EXPECT_EQ(json["paths"], Json::parse(R"([{"name": "P", "begin_s": 4.5, "end_s": 5.5, "length_mm": 5, "touched_mm": 2,
      "points_mm": [[11, 12, 13], [14, 16, 13]]}])"));
  EXPECT_EQ(json["distances"], Json::parse(R"([{"from": "B", "to": "C", "length_mm": 15.5}])"));
  EXPECT_EQ(json["angles"], Json::parse(R"([{"at": "A, left", "degrees": 77.5}])"));
}

/// 3D Slicer measures anew from the places: these are all that counts, in the order that makes the measure.
TEST(MarksTables, SlicersMarkupsAreAtTheMarks) {
  const nlohmann::json markups = nlohmann::json::parse(marks_as_markups(marks()))["markups"];
  const auto places = [](const nlohmann::json& markup) {
    std::vector<std::vector<double>> all;
    for (const auto& point : markup["controlPoints"]) all.push_back(point["position"].get<std::vector<double>>());
    return all;
  };
  using Places = std::vector<std::vector<double>>;
  const std::vector<double> a{1, -2, 3}, b{4, 5, -6}, c{7, 8, 9};
  ASSERT_EQ(markups.size(), 4U);
  const std::map<std::string, Places> expected{
      {"Fiducial", {a, b, c}}, {"Line", {b, c}}, {"Angle", {c, a, b}}, {"Curve", {{11, 12, 13}, {14, 16, 13}}}};
  for (const auto& markup : markups) {
    EXPECT_EQ(places(markup), expected.at(markup["type"])) << markup["type"];
    EXPECT_EQ(markup["coordinateSystem"], "LPS");
    EXPECT_EQ(markup["coordinateUnits"], "mm");
    std::size_t number = 0;
    for (const auto& point : markup["controlPoints"]) {
      EXPECT_EQ(point["id"], std::to_string(++number)) << "a string, as the schema says";
    }
  }
}

/// 3D Slicer shows the label beside a point, and the description in its table.
TEST(MarksTables, SlicersPointsAreNamedAsTheMarks) {
  const nlohmann::json markups = nlohmann::json::parse(marks_as_markups(marks()))["markups"];
  using Words = std::vector<std::string>;
  const auto words_of = [](const nlohmann::json& markup, const char* key) {
    Words all;
    for (const auto& point : markup["controlPoints"]) all.push_back(point[key].get<std::string>());
    return all;
  };
  const std::map<std::string, Words> labels{{"Fiducial", {"A, left", "B", "C"}},
                                            {"Line", {"B", "C"}},
                                            {"Angle", {"C", "A, left", "B"}},
                                            {"Curve", {"P-1", "P-2"}}};
  for (const auto& markup : markups) {
    EXPECT_EQ(words_of(markup, "label"), labels.at(markup["type"])) << markup["type"];
    if (markup["type"] == "Fiducial") {
      EXPECT_EQ(words_of(markup, "description"), (Words{"skin", "bone", ""})) << "the boundary";
    }
  }
}

TEST(MarksTables, AReportsPointsLengthsAndAnglesAreTheMarks) {
  const io::MeasurementReport report = report_of(marks());
  ASSERT_EQ(report.points.size(), 3U);
  for (std::size_t n = 0; n < 3; ++n) {
    EXPECT_EQ(report.points[n].name, marks().points[n].name);
    EXPECT_EQ(report.points[n].position_mm, marks().points[n].position_mm);
    EXPECT_EQ(report.points[n].structure, marks().points[n].boundary);
    EXPECT_EQ(report.points[n].force_n, marks().points[n].force_n);
  }
  EXPECT_EQ(report.points[0].value, 41.5);
  EXPECT_EQ(report.points[2].value, std::nullopt);
  ASSERT_EQ(report.lengths.size(), 2U);
  EXPECT_EQ(report.lengths[0].name, "B to C");
  EXPECT_THAT(report.lengths[0].points_mm, ElementsAre(glm::dvec3(4, 5, -6), glm::dvec3(7, 8, 9)));
  EXPECT_EQ(report.lengths[0].length_mm, 15.5);
  EXPECT_EQ(report.lengths[1].name, "P, 2.0 mm of it in contact");
  EXPECT_THAT(report.lengths[1].points_mm, ElementsAre(glm::dvec3(11, 12, 13), glm::dvec3(14, 16, 13)));
  EXPECT_EQ(report.lengths[1].length_mm, 5);
  ASSERT_EQ(report.angles.size(), 1U);
  EXPECT_EQ(report.angles[0].name, "Angle at A, left, from C to B");
  EXPECT_THAT(report.angles[0].points_mm, ElementsAre(glm::dvec3(7, 8, 9), glm::dvec3(1, -2, 3), glm::dvec3(4, 5, -6)));
  EXPECT_EQ(report.angles[0].degrees, 77.5);
}

/// It is shown before it is sent.
TEST(MarksTables, AReportIsReadInWords) {
  Marks all = marks();
  all.paths.push_back({.name = "Q", .points_mm = {{0, 0, 0}, {0, 3, 0}}, .length_mm = 3});
  EXPECT_EQ(report_in_words(report_of(all), "HU"),
            "A, left: L 1.0 A 2.0 H 3.0 mm, felt boundary: skin, value 41.5 HU, 0.50 N\n"
            "B: L 4.0 P 5.0 F 6.0 mm, felt boundary: bone, value 300 HU, 0.75 N\n"
            "C: L 7.0 P 8.0 H 9.0 mm, no boundary felt, 0.00 N\n"
            "B to C: 15.5 mm\n"
            "P, 2.0 mm of it in contact: 5.0 mm\n"
            "Q, without contact: 3.0 mm\n"
            "Angle at A, left, from C to B: 77.5 degrees\n");
}

}  // namespace
}  // namespace palpate::plugin
