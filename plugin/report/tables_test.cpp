/// Tables, charts and reports: every number is under its own name. All numbers here are different.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "modes/testing/test_rig.h"
#include "plugin/report/compare_strokes.h"
#include "plugin/report/mark_results.h"
#include "plugin/report/marks_text.h"
#include "plugin/report/stroke_picture.h"
#include "plugin/testing/test_files.h"
#include "solver/analytical.h"
#include "solver/exact.h"

namespace palpate::plugin {
namespace {

using ::testing::ElementsAre;
using testing::fresh_path;
using testing::text_in;
using Row = std::map<std::string, std::string>;

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (const char c : line) {
    if (c == '"') {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      cells.emplace_back();
    } else {
      cells.back() += c;
    }
  }
  return cells;
}

/// Of a CSV table, by heading; empty cells left out.
std::vector<Row> rows_of(const std::string& table) {
  std::istringstream lines(table);
  std::string line;
  std::getline(lines, line);
  const std::vector<std::string> names = cells_of(line);
  std::vector<Row> rows;
  while (std::getline(lines, line)) {
    const std::vector<std::string> cells = cells_of(line);
    EXPECT_EQ(cells.size(), names.size()) << line;
    Row& row = rows.emplace_back();
    for (std::size_t n = 0; n < std::min(cells.size(), names.size()); ++n) {
      if (!cells[n].empty()) row[names[n]] = cells[n];
    }
  }
  return rows;
}

Profile profile() {
  modes::Mode skin = modes::testing::surface(modes::TransferFunction(1.0));
  skin.name = "skin";
  modes::Mode bone = modes::testing::surface(modes::TransferFunction(2.0));
  bone.name = "bone";
  Profile made{.stroke = {}, .plan = nullptr, .scene = modes::testing::scene_of({skin, bone}), .unit = "HU"};
  made.scene.tissues = {{.name = "flesh", .low = 0, .high = 99}, {.name = "chalk", .low = 100, .high = 500}};
  made.stroke.push_back({.position_mm = {1, 2, 3},
                         .proxy_mm = {1.5, 2.5, 3.5},
                         .value = 41,
                         .value_passed = 42,
                         .solver = &solver::analytical_solver,
                         .error_bound_m = 1e-13});
  made.stroke.push_back({.position_mm = {3, 5, 9},  // 7 mm on
                         .proxy_mm = {10, 20, 30},  // 7, 15 and 21 mm away
                         .force_n = {-0.3, 1.2, 0.4},
                         .value = 101,
                         .value_passed = 302,
                         .solver = &solver::exact_solver,
                         .error_bound_m = 2e-13,
                         .boundary = 1,
                         .primitive = solver::PrimitiveType::plane});
  made.met = {{.contact = {.boundary = 1, .first = 1, .last = 1}, .depth_mm = 6.5, .known_to_mm = 0.25}};
  return made;
}

TEST(Tables, AProfilesColumnsAreWhatTheyAreCalled) {
  const auto file = fresh_path("columns.csv");
  write_csv(profile(), file);
  EXPECT_THAT(rows_of(text_in(file)), ElementsAre(Row{{"depth_mm", "0"},
                                                      {"probe_x_mm", "1"},
                                                      {"probe_y_mm", "2"},
                                                      {"probe_z_mm", "3"},
                                                      {"proxy_x_mm", "1.5"},
                                                      {"proxy_y_mm", "2.5"},
                                                      {"proxy_z_mm", "3.5"},
                                                      {"force_x_n", "0"},
                                                      {"force_y_n", "0"},
                                                      {"force_z_n", "0"},
                                                      {"force_n", "0"},
                                                      {"value_at_probe", "42"},
                                                      {"value_at_proxy", "41"},
                                                      {"tissue", "flesh"},
                                                      {"solver", "analytical"},
                                                      {"error_bound_m", "1e-13"},
                                                      {"known_to_mm", "nan"}},
                                                  Row{{"depth_mm", "7"},
                                                      {"probe_x_mm", "3"},
                                                      {"probe_y_mm", "5"},
                                                      {"probe_z_mm", "9"},
                                                      {"proxy_x_mm", "10"},
                                                      {"proxy_y_mm", "20"},
                                                      {"proxy_z_mm", "30"},
                                                      {"force_x_n", "-0.3"},
                                                      {"force_y_n", "1.2"},
                                                      {"force_z_n", "0.4"},
                                                      {"force_n", "1.3"},
                                                      {"value_at_probe", "302"},
                                                      {"value_at_proxy", "101"},
                                                      {"tissue", "chalk"},
                                                      {"boundary", "bone"},
                                                      {"primitive", "plane"},
                                                      {"solver", "exact"},
                                                      {"error_bound_m", "2e-13"},
                                                      {"known_to_mm", "0.25"}}));
}

TEST(Tables, AProfilesCurvesAreWhatTheyAreCalled) {
  const std::vector<Chart> charts = charts_of(profile());
  ASSERT_EQ(charts.size(), 3U);
  ASSERT_EQ(charts[1].curves.size(), 2U);
  EXPECT_EQ(charts[1].curves[0].label, "at the probe");
  EXPECT_THAT(charts[1].curves[0].y, ElementsAre(42, 302));
  EXPECT_EQ(charts[1].curves[1].label, "at the proxy");
  EXPECT_THAT(charts[1].curves[1].y, ElementsAre(41, 101));
  ASSERT_EQ(charts[2].curves.size(), 1U);
  EXPECT_THAT(charts[2].curves[0].y, ElementsAre(std::sqrt(0.75), std::sqrt(7 * 7 + 15 * 15 + 21 * 21)));
  for (const Chart& chart : charts) {
    for (const Curve& curve : chart.curves) EXPECT_THAT(curve.x, ElementsAre(0, 7));
    ASSERT_EQ(chart.marks.size(), 1U);
    EXPECT_EQ(chart.marks[0].at, 6.5);
    EXPECT_EQ(chart.marks[0].label, "bone");
  }
  EXPECT_EQ(point_in_words(profile(), 0), "0.0 mm: 0.00 N, 42 HU, flesh");
  EXPECT_EQ(point_in_words(profile(), 1), "7.0 mm: 1.30 N by bone (plane), 302 HU, chalk");
}

/// Tissues beside each other are told apart by their gray.
TEST(Tables, AProfilesTissuesAreToldApart) {
  Profile crossed;
  crossed.unit = "HU";
  crossed.scene.tissues = {{.name = "a", .low = 0, .high = 9}, {.name = "b", .low = 10, .high = 99}};
  for (const double value : {1, 2, 20, 3, 30, 4}) {
    crossed.stroke.push_back(
        {.position_mm = {static_cast<double>(crossed.stroke.size()), 0, 0}, .value = value, .value_passed = value});
  }
  const std::vector<Band> bands = charts_of(crossed)[1].bands;
  ASSERT_EQ(bands.size(), 5U);
  for (std::size_t n = 1; n < bands.size(); ++n) EXPECT_NE(bands[n].color.red, bands[n - 1].color.red) << n;
}

/// Every n-th point is left, and with it each contact: from its first point that is left, to its last.
TEST(Tables, AThinnedProfilesContactsAreOnTheSamePoints) {
  Profile whole;
  whole.unit = "HU";
  whole.limit_n = 1.75;
  whole.scene.name = "thinned";
  for (int n = 0; n < 1003; ++n) whole.stroke.push_back({.position_mm = {0.5 * n, 0, 0}});
  whole.met = {{.contact = {.boundary = 0, .first = 100, .last = 295}, .depth_mm = 50},
               {.contact = {.boundary = 1, .first = 400, .last = 600}, .depth_mm = 200}};
  const Profile thin = thinned(whole, 200);
  ASSERT_EQ(thin.stroke.size(), 201U);
  EXPECT_EQ(thin.unit, "HU");
  EXPECT_EQ(thin.limit_n, 1.75);
  EXPECT_EQ(thin.scene.name, "thinned");
  ASSERT_EQ(thin.met.size(), 2U);
  for (std::size_t n = 0; n < 2; ++n) {
    EXPECT_EQ(thin.met[n].depth_mm, whole.met[n].depth_mm);
    for (const auto end : {&Contact::first, &Contact::last}) {
      EXPECT_EQ(thin.stroke[thin.met[n].contact.*end].position_mm, whole.stroke[whole.met[n].contact.*end].position_mm);
    }
  }
}

Comparison comparison() {
  return {.along_mm = {0, 4},
          .first_n = {0.25, 0.5},
          .second_n = {1, 1.5},
          .apart_mm = {2, 3},
          .most_apart_mm = 3,
          .largest_difference_n = 1.25,
          .largest_difference_at_mm = 4,
          .mean_difference_n = 0.875};
}

TEST(Tables, AComparisonsColumnsAndCurvesAreWhatTheyAreCalled) {
  const auto file = fresh_path("compared.csv");
  write_csv(comparison(), file);
  EXPECT_THAT(rows_of(text_in(file)),
              ElementsAre(Row{{"along_mm", "0"}, {"first_n", "0.25"}, {"second_n", "1"}, {"apart_mm", "2"}},
                          Row{{"along_mm", "4"}, {"first_n", "0.5"}, {"second_n", "1.5"}, {"apart_mm", "3"}}));
  const std::vector<Chart> charts = charts_of(comparison(), "before", "after");
  ASSERT_EQ(charts.size(), 3U);
  ASSERT_EQ(charts[0].curves.size(), 2U);
  EXPECT_EQ(charts[0].curves[0].label, "before");
  EXPECT_THAT(charts[0].curves[0].y, ElementsAre(0.25, 0.5));
  EXPECT_EQ(charts[0].curves[1].label, "after");
  EXPECT_THAT(charts[0].curves[1].y, ElementsAre(1, 1.5));
  EXPECT_EQ(charts[1].title, "Force: second less first");
  EXPECT_THAT(charts[1].curves[0].y, ElementsAre(0.75, 1));
  EXPECT_THAT(charts[2].curves[0].y, ElementsAre(2, 3));
  for (const Chart& chart : charts) {
    for (const Curve& curve : chart.curves) EXPECT_THAT(curve.x, ElementsAre(0, 4));
  }
  EXPECT_EQ(in_words(comparison()),
            "Forces differ by at most 1.25 N, 4.0 mm along the stroke; by 0.88 N on average. The two ways are at most "
            "3.0 mm apart.");
}

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

TEST(Tables, TheMarksColumnsAreWhatTheyAreCalled) {
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
TEST(Tables, TheMarksCellsAreQuotedWhereTheyHaveToBe) {
  Marks all;
  for (const char* const name : {"plain", "a, b", "say \"ah\"", "two\nlines"}) all.points.push_back({.name = name});
  const std::string csv = marks_as_csv(all);
  for (const char* const line :
       {"\nmark,plain,", "\nmark,\"a, b\",", "\nmark,\"say \"\"ah\"\"\",", "\nmark,\"two\nlines\","}) {
    EXPECT_THAT(csv, ::testing::HasSubstr(line));
  }
}

TEST(Tables, TheMarksJsonIsWhatItIsCalled) {
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
TEST(Tables, SlicersMarkupsAreAtTheMarks) {
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

TEST(Tables, AReportsPointsLengthsAndAnglesAreTheMarks) {
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
TEST(Tables, AReportIsReadInWords) {
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

/// What else a stroke's charts show: who pushes where, what tissue is crossed, and how far each axis reaches.
TEST(Tables, AProfilesForceChartTellsWhoPushes) {
  const std::vector<Chart> charts = charts_of(profile());
  const std::vector<Curve>& curves = charts[0].curves;
  ASSERT_EQ(curves.size(), 2U);
  EXPECT_EQ(curves[0].y[0], 0);
  EXPECT_TRUE(std::isnan(curves[0].y[1]));
  EXPECT_EQ(curves[1].label, "bone (plane)");
  EXPECT_EQ(curves[1].y[0], 0) << "from where the stretch before ends";
  EXPECT_DOUBLE_EQ(curves[1].y[1], 1.3);
  EXPECT_EQ(charts[0].y.label, "force (N)");
  EXPECT_EQ(charts[1].y.label, "value (HU)");
  EXPECT_EQ(charts[2].y.label, "distance (mm)");
  EXPECT_EQ(charts[0].y.minimum, 0);
  EXPECT_NEAR(charts[0].y.maximum.value(), 1.08 * 1.3, 1e-12);
  EXPECT_NEAR(charts[2].y.maximum.value(), 1.08 * std::sqrt(7 * 7 + 15 * 15 + 21 * 21), 1e-9);
  ASSERT_EQ(charts[1].bands.size(), 2U);
  EXPECT_EQ(charts[1].bands[0].label, "flesh");
  EXPECT_EQ(charts[1].bands[1].label, "chalk");
}

/// A table for which there is no room is refused: what waits in a buffer, too.
TEST(Tables, OnAFullDiskAreRefused) {
  const auto refusal_of = [](const auto& table) -> std::string {
    try {
      write_csv(table, "/dev/full");
      return "written";
    } catch (const std::runtime_error& error) {
      return error.what();
    }
  };
  const std::string refused = "/dev/full: the table cannot be written: cannot write to file: No space left on device";
  EXPECT_EQ(refusal_of(profile()), refused);
  EXPECT_EQ(refusal_of(comparison()), refused);
}

}  // namespace
}  // namespace palpate::plugin
