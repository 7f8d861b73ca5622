/// Numbers of a settings file that multiply forces or positions: how far from the usual ones they may be.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "device/falcon/falcon.h"
#include "device/testing/falcon_bench.h"
#include "device/testing/settings_rig.h"
#include "device/testing/wooden_haptics_bench.h"
#include "device/wooden_haptics/wooden_haptics.h"

namespace palpate::device {
namespace {

using settings_rig::file_of;
using settings_rig::Json;
using settings_rig::refusal_of;

/// A number of a file that multiplies forces or positions, of the arm of 2015, and how far from the usual one it may
/// be.
struct Calibration {
  const char* key;
  double factor;
  std::vector<double> usual;  // of each axis; one for all
};
const Calibration arm_calibrations[] = {{"torque_constant", 2.5, {0.0259, 0.0259, 0.0259}},
                                        {"capstan_diameter", 1.6, {0.01, 0.01, 0.01}},
                                        {"body_diameter", 1.6, {0.16, 0.12, 0.12}},
                                        {"counts_per_turn", 2.5, {2000, 2000, 2000}},
                                        {"lower_length", 1.6, {0.205}},
                                        {"upper_length", 1.6, {0.245}}};

/// So many times the usual value, of one axis, or of all.
Json times_usual(const Calibration& calibration, double times, std::size_t axis = 3) {
  const bool is_whole = calibration.key == std::string("counts_per_turn");
  Json values = Json::array();
  for (std::size_t i = 0; i < calibration.usual.size(); ++i) {
    const double value = calibration.usual[i] * (axis == 3 || axis == i ? times : 1);
    values.push_back(is_whole ? Json(std::lround(value)) : Json(value));
  }
  return values.size() == 1 ? values[0] : values;
}

/// Each may be wrong by its factor, on each axis. What is farther away is refused by its name.
TEST(Settings, NoCalibrationIsFarFromTheUsual) {
  const auto said_of_arm = [](const char* key, const Json& value) {
    return refusal_of([&] { read_wooden_haptics(file_of({{"preset", "2015"}, {key, value}})); });
  };
  const auto said_of_falcon = [](double gain) {
    return refusal_of([&] { read_falcon(file_of({{"motor_gain", gain}})); });
  };
  const auto within = [](double factor) { return std::array{1.004 / factor, 0.7, 1.0, 1.4, 0.996 * factor}; };
  const auto beyond = [](double factor) { return std::array{0.996 / factor, 1.004 * factor, 1e-9, 1e5, 0.0, -1.0}; };
  for (const Calibration& one : arm_calibrations) {
    for (std::size_t axis = 0; axis < one.usual.size(); ++axis) {
      const std::string name = std::string("WoodenHaptics: '") + one.key + "'" +
                               (one.usual.size() > 1 ? std::string(" of axis ") + "abc"[axis] + " is " : " is ");
      for (const double times : within(one.factor)) {
        EXPECT_EQ(said_of_arm(one.key, times_usual(one, times, axis)), "") << name << times;
      }
      for (const double times : beyond(one.factor)) {
        const std::string said = said_of_arm(one.key, times_usual(one, times, axis));
        EXPECT_THAT(said, ::testing::HasSubstr(name)) << times;
        EXPECT_THAT(said, ::testing::HasSubstr("; measure it again")) << times;
      }
    }
  }
  for (const double times : within(2.5)) EXPECT_EQ(said_of_falcon(10000 * times), "") << times;
  for (const double times : beyond(2.5)) {
    const std::string said = said_of_falcon(10000 * times);
    EXPECT_THAT(said, ::testing::StartsWith("Novint Falcon: ")) << times;
    EXPECT_THAT(said, ::testing::HasSubstr("'motor_gain' is ")) << times;
    EXPECT_THAT(said, ::testing::HasSubstr("but lies between 4000 and 25000; measure it again")) << times;
    EXPECT_NE(refusal_of([&] { make_falcon({.motor_gain = 10000 * times}); }), "") << times;
  }
  EXPECT_EQ(refusal_of([] { make_falcon({}); }), "");
  for (const char* const preset : {"2015", "2016", "2019", "woody"}) {
    EXPECT_EQ(refusal_of([&] { read_wooden_haptics(file_of({{"preset", preset}})); }), "") << preset;
    EXPECT_EQ(refusal_of([&] { check(wooden_haptics_preset(preset)); }), "") << preset;
  }
}

/// Nor do they make forces larger or smaller together: whatever each is, the current for a force differs from the
/// preset's by a factor of 2.5 at most.
TEST(Settings, NorAreCalibrationsTogether) {
  const auto& [torque, capstan, body, counts, lower, upper] = arm_calibrations;
  int refused = 0;
  for (const double of_torque : {0.5, 1.0, 2.0}) {
    for (const double of_capstan : {1 / 1.5, 1.0, 1.5}) {
      for (const double of_body : {1 / 1.5, 1.0, 1.5}) {
        for (const double of_lengths : {1 / 1.5, 1.0, 1.5}) {
          const Json file{{"preset", "2015"},
                          {torque.key, times_usual(torque, of_torque)},
                          {capstan.key, times_usual(capstan, of_capstan)},
                          {body.key, times_usual(body, of_body)},
                          {counts.key, times_usual(counts, 2)},
                          {lower.key, times_usual(lower, of_lengths)},
                          {upper.key, times_usual(upper, of_lengths)}};
          const std::string said = refusal_of([&] { read_wooden_haptics(file_of(file)); });
          const double current = of_lengths * of_capstan / of_body / of_torque;
          const bool is_near = current > 1 / 2.5 && current < 2.5;
          EXPECT_EQ(said == "", is_near) << file.dump() << ": " << said;
          if (is_near) continue;
          EXPECT_THAT(said, ::testing::HasSubstr("the torque constant of axis a make the current for a force"));
          ++refused;
        }
      }
    }
  }
  EXPECT_EQ(refused, 22);
}

/// The fake has the published arm's numbers, whatever the file says. No one of them makes what acts more than 2.5 times
/// what was asked for, also where it moves the pose; where it makes the pose impossible nothing acts.
TEST(Settings, NoCalibrationMultipliesAForceByMoreThanItMay) {
  constexpr double asked = 0.3, rounding = 1.02;  // N
  for (const Calibration& one : arm_calibrations) {
    for (const double times : {1.004 / one.factor, 1 / 1.3, 1.0, 1.3, 0.996 * one.factor}) {
      FakeWoodenHapticsOptions options;
      const Json file{{"preset", "2015"}, {"home_counts", options.arm.home_counts}, {one.key, times_usual(one, times)}};
      options.arm = read_wooden_haptics(file_of(file));
      WoodenHapticsBench bench(options);
      bench.stylus->open();
      bench.run(0.3);
      for (const Vec3& direction : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, -1)}) {
        double most = 0;
        for (int n = 0; n < 40; ++n) {
          bench.run(0.01, asked * direction);
          most = std::max(most, glm::length(bench.arm.force()));
        }
        EXPECT_LE(most, 2.5 * asked * rounding) << one.key << " x " << times;
        if (times == 1) {
          EXPECT_NEAR(most, asked, 0.05 * asked) << one.key;
        }
      }
    }
  }
  for (const double times : {1 / 2.49, 0.5, 1.0, 2.0, 2.49}) {
    FalconBench bench({}, read_falcon(file_of({{"motor_gain", 10000 * times}})));
    bench.home();
    bench.run(0.5, Vec3(0, 1, 0));
    EXPECT_NEAR(bench.fake.falcon.force().y, times, 0.05 * times);
    EXPECT_LE(glm::length(bench.fake.falcon.strongest_force()), 2.5 * rounding) << times;
  }
}

}  // namespace
}  // namespace palpate::device
