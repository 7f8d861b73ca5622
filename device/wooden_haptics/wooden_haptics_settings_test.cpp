#include "device/wooden_haptics/wooden_haptics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>

#include "device/testing/test_files.h"
#include "device/wooden_haptics/wooden_haptics_driver.h"

namespace palpate::device {
namespace {

std::string write_settings(const std::string& json) {
  static const TestFiles files;
  return files.write("wooden.json", json);
}

TEST(WoodenHapticsSettings, AreReadFromJson) {
  const auto settings = read_wooden_haptics(write_settings(
      R"({"preset": "2019", "address": "/dev/hidraw3", "encoder_sign": [1, -1, 1], "home_counts": [0, 0, 5900]})"));
  EXPECT_EQ(settings.address, "/dev/hidraw3");
  EXPECT_EQ(settings.encoder_sign[1], -1);
  EXPECT_EQ(settings.home_counts[2], 5900);
  EXPECT_EQ(settings.torque_constant[0], 0.321);
  EXPECT_EQ(settings.lower_length, 0.205) << "absent keys have the preset's";
}

/// Every key sets what it is named after, and nothing else: values that no default has.
TEST(WoodenHapticsSettings, EveryKeyIsRead) {
  const auto s = read_wooden_haptics(write_settings(
      R"({"preset": "woody", "address": "/dev/hidraw7", "capstan_diameter": [0.011, 0.012, 0.013], "body_diameter": [0.161, 0.122, 0.123],
          "base_height": 0.081, "lower_length": 0.206, "upper_length": 0.246, "origin": [0.221, 0.001, 0.082],
          "workspace_radius": 0.101, "torque_constant": [0.031, 0.032, 0.033], "counts_per_turn": [2001, 2002, 2003],
          "encoder_sign": [-1, 1, -1], "motor_aligned": [true, false, true], "home_counts": [11, 12, 13],
          "current_limit": 2.1, "maximum_force": 5.1, "stiffness_limit": 1001, "guarded": false,
          "position_signs": [1, -1, 1], "force_signs": [-1, 1, 1]})"));
  EXPECT_EQ(s.address, "/dev/hidraw7");
  EXPECT_EQ(s.capstan_diameter, (std::array{0.011, 0.012, 0.013}));
  EXPECT_EQ(s.body_diameter, (std::array{0.161, 0.122, 0.123}));
  EXPECT_EQ(s.base_height, 0.081);
  EXPECT_EQ(s.lower_length, 0.206);
  EXPECT_EQ(s.upper_length, 0.246);
  EXPECT_EQ(s.origin, (std::array{0.221, 0.001, 0.082}));
  EXPECT_EQ(s.workspace_radius, 0.101);
  EXPECT_EQ(s.torque_constant, (std::array{0.031, 0.032, 0.033}));
  EXPECT_EQ(s.counts_per_turn, (std::array{2001, 2002, 2003}));
  EXPECT_EQ(s.encoder_sign, (std::array{-1, 1, -1}));
  EXPECT_EQ(s.motor_aligned, (std::array{true, false, true}));
  EXPECT_EQ(s.home_counts, (std::array{11, 12, 13}));
  EXPECT_EQ(s.current_limit, 2.1);
  EXPECT_EQ(s.maximum_force, 5.1);
  EXPECT_EQ(s.stiffness_limit, 1001);
  EXPECT_FALSE(s.guarded);
  EXPECT_EQ(s.signs.position, Vec3(1, -1, 1));
  EXPECT_EQ(s.signs.force, Vec3(-1, 1, 1));
}

TEST(WoodenHapticsSettings, DefaultsAreThoseOfThePublishedArm) {
  const WoodenHapticsSettings s;
  EXPECT_EQ(s.capstan_diameter, (std::array{0.010, 0.010, 0.010}));
  EXPECT_EQ(s.body_diameter, (std::array{0.160, 0.120, 0.120}));
  EXPECT_EQ(s.base_height, 0.080);
  EXPECT_EQ(s.lower_length, 0.205);
  EXPECT_EQ(s.upper_length, 0.245);
  EXPECT_EQ(s.origin, (std::array{0.220, 0.0, 0.080}));
  EXPECT_EQ(s.workspace_radius, 0.100);
  EXPECT_EQ(s.continuous_current, 1);
  EXPECT_EQ(s.stiffness_limit, 1000);
  EXPECT_EQ(s.counts_per_turn, (std::array{2000, 2000, 2000}));
  EXPECT_EQ(s.torque_constant, (std::array{0.0259, 0.0259, 0.0259}));
  EXPECT_EQ(s.encoder_sign, (std::array{1, 1, 1}));
  EXPECT_EQ(s.home_counts, (std::array{0, 0, 0}));
  EXPECT_EQ(s.current_limit, 2);
  EXPECT_EQ(s.maximum_force, 5);
  EXPECT_TRUE(s.guarded);
}

TEST(WoodenHapticsSettings, WrongOnesAreRefusedByName) {
  const struct {
    const char* json;
    const char* names;
  } wrong[] = {{R"({"preset": "2015", "lower_lenght": 0.2})", "'lower_lenght' is not a setting"},
               {R"({"preset": "2015", "lower_length": "long"})", "'lower_length'"},
               {R"({"preset": "2015", "torque_constant": [0, 1, 1]})",
                "'torque_constant' of axis a is 0, but lies between 0.01036 and 0.06475; measure it again"},
               {R"({"preset": "2015", "encoder_sign": [1, 1, 2]})", "encoder sign of axis c"},
               {R"({"preset": "2015", "current_limit": 30})", "current limit"},
               {R"({"preset": "2015", "stiffness_limit": 0})", "stiffness limit"},
               {R"({"preset": "2015", "capstan_diameter": [0.01, 0, 0.01]})", "'capstan_diameter' of axis b"},
               {R"({"preset": "2015", "body_diameter": [0.16, 0.12, 0.01]})", "'body_diameter' of axis c"},
               {R"({"preset": "2015", "counts_per_turn": [2000, 0, 2000]})", "'counts_per_turn' of axis b"},
               {R"({"preset": "2015", "encoder_sign": [0, 1, 1]})", "encoder sign of axis a"},
               {R"({"preset": "2015", "home_counts": [0, 32768, 0]})", "home counts of axis b"},
               {R"({"preset": "2015", "home_counts": [-32769, 0, 0]})", "home counts of axis a"},
               {R"({"preset": "2015", "lower_length": 0})", "'lower_length' is 0"},
               {R"({"preset": "2015", "upper_length": 0})", "'upper_length' is 0"},
               {R"({"preset": "2015", "workspace_radius": 0})", "radius"},
               {R"({"preset": "2015", "workspace_radius": 1.01})", "radius"},
               {R"({"preset": "2015", "current_limit": 0})", "current limit"},
               {R"({"preset": "2015", "current_limit": 3.01})", "current limit"},
               {R"({"preset": "2015", "maximum_force": 0})", "largest force"},
               {R"({"preset": "2015", "maximum_force": 20.1})", "largest force"},
               {R"({"lower_length": 0.2})", "name the arm as \"preset\""},
               {R"({"preset": "2017"})", "2015, 2016, 2019 or woody"},
               {R"({"preset": "2015", "continuous_current": 2.5})", "continuous current"},
               {R"([1, 2])", "not a JSON object"},
               {R"({"address": )", "wooden.json"}};
  for (const auto& example : wrong) {
    try {
      read_wooden_haptics(write_settings(example.json));
      FAIL() << example.json;
    } catch (const std::runtime_error& error) {
      EXPECT_THAT(error.what(), ::testing::HasSubstr(example.names));
      EXPECT_THAT(error.what(), ::testing::HasSubstr("wooden.json"));
    }
  }
}

}  // namespace
}  // namespace palpate::device
