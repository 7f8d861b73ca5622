/// Tables and charts of strokes: every number is under its own name. All numbers here are different.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "modes/testing/test_rig.h"
#include "plugin/report/compare_strokes.h"
#include "plugin/report/mark_results.h"
#include "plugin/report/stroke_picture.h"
#include "plugin/testing/csv_rows.h"
#include "plugin/testing/test_files.h"
#include "solver/analytical.h"
#include "solver/exact.h"

namespace palpate::plugin {
namespace {

using ::testing::ElementsAre;
using testing::fresh_path;
using testing::Row;
using testing::rows_of;
using testing::text_in;

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
