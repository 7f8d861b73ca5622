#include "plugin/paraview/common/scan_look.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace palpate::plugin {
namespace {

/// Shares of a scan made of these parts (percent), each of values spread evenly over 40 units about its own.
std::vector<double> made_of(const std::vector<std::pair<int, double>>& parts) {
  std::vector<double> shares;
  for (const auto& [percent, value] : parts) {
    for (int n = 0; n < percent; ++n) shares.push_back(value - 20 + 40.0 * n / percent);
  }
  shares.push_back(shares.back());
  std::ranges::sort(shares);
  return shares;
}

double opacity_at(const VolumeLook& look, double value) {
  double before = look.opacity[0];
  double opacity = look.opacity[1];
  if (value <= before) return opacity;
  for (std::size_t n = 4; n < look.opacity.size(); n += 4) {
    const double here = look.opacity[n];
    const double there = look.opacity[n + 1];
    if (value <= here) return opacity + (there - opacity) * (value - before) / (here - before);
    before = here;
    opacity = there;
  }
  return opacity;
}

Values ct(std::vector<double> shares) {
  return {.modality = "CT", .hounsfield = true, .low = -1024, .high = 3000, .own = {}, .shares = std::move(shares)};
}

Values mr(std::vector<double> shares) {
  return {.modality = "MR", .hounsfield = false, .low = 0, .high = 2000, .own = {}, .shares = std::move(shares)};
}

TEST(Windows, OfHounsfieldUnitsAreTheOnesRadiologyKnowsByName) {
  const auto windows = windows_for(ct({}));
  ASSERT_EQ(windows.size(), 8U);
  const auto expect = [&](std::size_t n, const std::string& name, double level, double width) {
    EXPECT_EQ(windows[n].name, name);
    EXPECT_EQ(windows[n].window.level, level);
    EXPECT_EQ(windows[n].window.width, width);
  };
  expect(0, "Soft tissue", 40, 400);
  expect(1, "Brain", 40, 80);
  expect(2, "Lung", -600, 1500);
  expect(3, "Bone", 480, 2500);
  expect(4, "Mediastinum", 50, 350);
  expect(5, "Abdomen", 60, 400);
  expect(6, "Angio", 300, 600);
  expect(7, "Stroke", 40, 40);
}

TEST(Windows, BeginWithTheSeriesOwn) {
  for (Values values : {ct({}), mr(made_of({{50, 20}, {50, 500}}))}) {
    const std::size_t others = windows_for(values).size();
    values.own = Window{35, 80};
    const auto windows = windows_for(values);
    ASSERT_EQ(windows.size(), others + 1);
    EXPECT_EQ(windows[0].window.level, 35);
    EXPECT_EQ(windows[0].window.width, 80);
  }
}

TEST(Windows, OfMrLeaveTheOuterPercentOnBothSidesOut) {
  std::vector<double> shares;
  for (int percent = 0; percent <= 100; ++percent) shares.push_back(10.0 * percent);
  shares.back() = 1e6;  // one voxel
  const auto windows = windows_for(mr(shares));
  ASSERT_EQ(windows.size(), 2U);
  EXPECT_EQ(windows[0].window.level, 500);
  EXPECT_EQ(windows[0].window.width, 980);
  EXPECT_EQ(windows[1].window.level, 1000);
  EXPECT_EQ(windows[1].window.width, 2000);
}

TEST(Windows, OfSpeedsBeginAtRestAndLeaveRoomForAPulse) {
  Values values;
  for (int percent = 0; percent <= 100; ++percent) values.shares.push_back(0.8 + 0.004 * percent);
  values.speeds = true;
  values.low = -3e38;  // where nothing was measured
  values.high = 1.2;
  const auto windows = windows_for(values);
  ASSERT_EQ(windows.size(), 2U);
  for (const NamedWindow& one : windows) EXPECT_DOUBLE_EQ(one.window.level, one.window.width / 2);
  EXPECT_NEAR(windows[0].window.width, 2 * 1.196, 1e-9);
  EXPECT_NEAR(windows[1].window.width, 1.2, 1e-9);
  for (double& share : values.shares) share -= 1;  // along one direction: forth and back
  EXPECT_LT(windows_for(values)[0].window.level, windows_for(values)[0].window.width / 2);
}

VolumeLook suited(const Values& values) {
  return volume_looks_for(values).at(suited_look(values));
}

TEST(VolumeLook, OfAHeadIsItsSkin) {
  const VolumeLook look = suited(ct(made_of({{50, -1000}, {40, 40}, {10, 700}})));
  EXPECT_EQ(look.name, std::string("CT skin"));
  EXPECT_GT(opacity_at(look, 40), 0.5);
  EXPECT_EQ(opacity_at(look, -900), 0);
}

TEST(VolumeLook, OfAChestShowsTheLungs) {
  const VolumeLook look = suited(ct(made_of({{40, -1000}, {20, -820}, {35, 40}, {5, 500}})));
  EXPECT_EQ(look.name, std::string("CT lung"));
  EXPECT_GT(opacity_at(look, -800), 0);
  EXPECT_EQ(opacity_at(look, -1000), 0) << "the air around the patient hides the lungs";
  EXPECT_EQ(opacity_at(look, 40), 0) << "the chest's wall hides the lungs";
}

TEST(VolumeLook, OfAHeadOnFoamIsItsSkin) {
  Values head = ct(made_of({{40, -1000}, {20, -820}, {35, 40}, {5, 500}}));
  head.light_part = 0.01;
  EXPECT_EQ(suited(head).name, std::string("CT skin"));
  head.light_part = 0.3;
  EXPECT_EQ(suited(head).name, std::string("CT lung"));
}

TEST(VolumeLook, WithoutAirIsBoneAlone) {
  const VolumeLook look = suited(ct(made_of({{70, 40}, {30, 700}})));
  EXPECT_EQ(look.name, std::string("CT bone"));
  EXPECT_EQ(opacity_at(look, 60), 0);
  EXPECT_GT(opacity_at(look, 700), 0.5);
}

TEST(VolumeLook, OfVesselsHidesMuscleAndShowsContrast) {
  const VolumeLook look = volume_looks_for(ct({})).at(3);
  EXPECT_EQ(look.name, std::string("CT vessels"));
  EXPECT_EQ(opacity_at(look, 70), 0);
  EXPECT_GT(opacity_at(look, 350), 0.5);
}

TEST(VolumeLook, OfMrHidesTheBackgroundWhereverItEnds) {
  for (const double tissue : {120.0, 700.0, 5000.0}) {
    const VolumeLook look = suited(mr(made_of({{55, 25}, {45, tissue}})));
    EXPECT_EQ(look.name, std::string("MR"));
    EXPECT_EQ(opacity_at(look, 40), 0) << tissue;
    EXPECT_GT(opacity_at(look, tissue + 15), 0.2) << tissue;
  }
}

TEST(VolumeLook, OfAnAngiogramShowsTheFewBrightVoxels) {
  const VolumeLook look = suited(mr(made_of({{97, 60}, {3, 900}})));
  EXPECT_EQ(look.name, std::string("MR vessels"));
  EXPECT_EQ(opacity_at(look, 80), 0);
  EXPECT_GT(opacity_at(look, 900), 0.5);
}

TEST(VolumeLook, AscendsWhateverTheValuesAre) {
  for (const Values& values : {mr({}), mr(std::vector<double>(101, 7.0)), mr(made_of({{60, 25}, {40, 300}})), ct({})}) {
    for (const VolumeLook& look : volume_looks_for(values)) {
      for (std::size_t n = 4; n < look.opacity.size(); n += 4) EXPECT_GT(look.opacity[n], look.opacity[n - 4]);
      for (std::size_t n = 4; n < look.colors.size(); n += 4) EXPECT_GT(look.colors[n], look.colors[n - 4]);
    }
  }
}

TEST(OtsuThreshold, LiesBetweenTwoClasses) {
  const double threshold = otsu_threshold(made_of({{70, 100}, {30, 900}}));
  EXPECT_GT(threshold, 120);
  EXPECT_LT(threshold, 880);
}

}  // namespace
}  // namespace palpate::plugin
