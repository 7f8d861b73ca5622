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

#include "device/testing/fake_wooden_haptics.h"
#include "device/testing/public_wooden_haptics.h"
#include "device/testing/test_files.h"
#include "device/testing/wall_ringing.h"
#include "device/wooden_haptics/wooden_haptics_driver.h"

namespace palpate::device {
namespace {

Vec3 random_position(std::mt19937& random, double radius) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  Vec3 direction;
  do {
    direction = {uniform(random), uniform(random), uniform(random)};
  } while (glm::length(direction) > 1);
  return radius * direction;
}

/// Whole counts of a position, as the maker's host has them.
std::array<int, 3> host_counts(PublicHost host, const Vec3& position) {
  const Vec3 counts = public_wooden_counts(host, position);
  return {static_cast<int>(counts.x), static_cast<int>(counts.y), static_cast<int>(counts.z)};
}

Vec3 as_vector(const std::array<int, 3>& counts) {
  return {counts[0], counts[1], counts[2]};
}

Vec3 angles_at(const WoodenHapticsSettings& settings, const Vec3& position) {
  return wooden_haptics_angles(settings, host_counts(PublicHost::haptikfabriken, position));
}

TEST(WoodenHapticsKinematics, PresetsAgreeWithTheirMakersHosts) {
  const struct {
    const char* preset;
    PublicHost host;
    std::array<int, 3> home;  // the driver's counts where the host's are 0
  } arms[] = {{"2015", PublicHost::haptikfabriken, {0, 0, 0}}, {"2016", PublicHost::woody_2016, {0, 0, -6000}}};
  for (const auto& arm : arms) {
    const WoodenHapticsSettings settings = wooden_haptics_preset(arm.preset);
    std::mt19937 random(1);
    for (int i = 0; i < 500; ++i) {
      const std::array<int, 3> counts = host_counts(arm.host, random_position(random, settings.workspace_radius));
      std::array<int, 3> own{};
      for (std::size_t axis = 0; axis < 3; ++axis) own[axis] = counts[axis] + arm.home[axis];
      const Vec3 angles = wooden_haptics_angles(settings, own);
      ASSERT_LT(
          glm::distance(wooden_haptics_position(settings, angles), public_wooden_position(arm.host, as_vector(counts))),
          1e-12)
          << arm.preset;
      const Vec3 force = random_position(random, 0.5);
      const Vec3 amperes = public_wooden_amperes(arm.host, as_vector(counts), force);
      const auto sent = wooden_haptics_currents(settings, wooden_haptics_torques(settings, angles, force));
      ASSERT_LT(glm::distance(as_vector(sent), 1e3 * amperes), 2) << arm.preset << ": mA";
    }
  }
}

TEST(WoodenHapticsKinematics, The2016ArmHangsInItsHomePoseWhereItsCountersAreZero) {
  const WoodenHapticsSettings settings = wooden_haptics_preset("2016");
  const Vec3 position = wooden_haptics_position(settings, wooden_haptics_angles(settings, settings.home_counts));
  EXPECT_LT(glm::distance(position, public_wooden_position(PublicHost::woody_2016, Vec3(0))), 1e-12);
}

TEST(WoodenHapticsKinematics, TheHomePoseOfThe2019ArmIsWhereItsDrawingHasIt) {
  // Lower body upright, upper body level: the tip is one upper length out, one lower length up.
  const WoodenHapticsSettings settings = wooden_haptics_preset("2019");
  const Vec3 angles = wooden_haptics_angles(settings, settings.home_counts);
  EXPECT_NEAR(angles.z, std::acos(-1.0) / 2, 1e-12) << "6000 counts are 90 degrees";
  const Vec3 position = wooden_haptics_position(settings, angles);
  EXPECT_NEAR(position.z, 0.245 - 0.220, 1e-12) << "towards the user";
  EXPECT_NEAR(position.y, 0.080 + 0.205 - 0.080, 1e-12) << "up";
  EXPECT_NEAR(position.x, 0, 1e-12);
}

TEST(WoodenHapticsKinematics, TorquesDoTheForcesWork) {
  const WoodenHapticsSettings settings = wooden_haptics_preset("2015");
  std::mt19937 random(2);
  for (int i = 0; i < 500; ++i) {
    const Vec3 angles = angles_at(settings, random_position(random, 0.09));
    const Vec3 force = random_position(random, 5);
    const Vec3 torques = wooden_haptics_torques(settings, angles, force);
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 turn(0);
      turn[axis] = 1e-6;
      const Vec3 moved =
          wooden_haptics_position(settings, angles + turn) - wooden_haptics_position(settings, angles - turn);
      EXPECT_NEAR(torques[axis], glm::dot(force, moved) / 2e-6, 1e-6);
    }
  }
}

TEST(WoodenHapticsKinematics, CurrentsKeepTheirLimitAndDirection) {
  const WoodenHapticsSettings settings = wooden_haptics_preset("2015");
  std::mt19937 random(3);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 torques = random_position(random, std::pow(10, static_cast<double>(i % 7) - 3));
    const auto currents = wooden_haptics_currents(settings, torques);
    const auto small = wooden_haptics_currents(settings, torques * (0.02 / glm::length(torques)));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      ASSERT_LE(std::abs(currents[axis]), 2000);
      ASSERT_GE(static_cast<long>(currents[axis]) * small[axis], 0) << "no sign may change";
    }
  }
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(wooden_haptics_currents(settings, Vec3(nan, 1, 1)), (std::array<int, 3>{}));
  EXPECT_EQ(wooden_haptics_currents(settings, Vec3(1e308, 0, 0)), (std::array<int, 3>{}));
}

/// The driver on the fake, stepped in one thread on the fake's own clock.
struct Bench {
  FakeHidBench bench;
  FakeWoodenHaptics arm;
  std::unique_ptr<LinkStylus> stylus;

  explicit Bench(const FakeWoodenHapticsOptions& options = {}) : arm(options) {
    LinkStylusOptions link_options;
    link_options.threaded = false;
    stylus = make_wooden_haptics_on(
        options.arm, [this] { return std::make_unique<FakeHidLink>(arm, bench); }, link_options);
  }
  void run(double seconds, const std::function<Vec3(const Reading&)>& force) {
    const double end = bench.time + seconds;
    double tick = bench.time;
    while (bench.time < end) {
      stylus->service(0.2e-3);
      if (bench.time < tick) continue;
      tick += 1e-3;
      stylus->write_force(force(stylus->read()));
    }
  }
  void run(double seconds, const Vec3& force = Vec3(0)) {
    run(seconds, [&](const Reading&) { return force; });
  }
  bool is_pushing() const { return arm.is_pushing(bench.time); }
  void home() {
    stylus->open();
    run(0.3);
    ASSERT_EQ(stylus->state(), State::idle);
  }
};

TEST(WoodenHapticsDriver, IsCalibratedByItsButtonAndFollowsTheHand) {
  for (const std::size_t size : {14U, 64U}) {
    FakeWoodenHapticsOptions options;
    options.report_size = size;
    options.path = {{0.3, {0, 0, 0}}, {0.6, {0.02, -0.03, 0.01}}};
    Bench bench(options);
    bench.stylus->open();
    bench.run(0.1, Vec3(0, 2, 0));
    EXPECT_EQ(bench.stylus->state(), State::homing);
    EXPECT_EQ(bench.arm.pushed_until(), 0) << "no force before calibration";
    bench.run(0.9);
    EXPECT_EQ(bench.stylus->state(), State::idle);
    EXPECT_LT(glm::length(bench.stylus->read().position - bench.arm.hand().body().position), 0.1e-3);
    EXPECT_GT(bench.arm.outputs(), 900U) << "a report and an answer every millisecond";
    EXPECT_LE(bench.arm.outputs(), 1010U);
  }
}

TEST(WoodenHapticsDriver, SpeaksTheShortReportsOf2016) {
  FakeWoodenHapticsOptions options;
  options.report_size = 8;
  options.arm = arm_with_home_at(Vec3(0), 8);
  Bench bench(options);
  bench.stylus->open();
  bench.run(0.2, Vec3(0, 1, 0));
  EXPECT_EQ(bench.stylus->state(), State::idle);
  EXPECT_LT(glm::length(bench.stylus->read().position - bench.arm.hand().body().position), 0.2e-3);
  EXPECT_LT(glm::length(bench.arm.force() - Vec3(0, 1, 0)), 0.02);
}

TEST(WoodenHapticsDriver, TheHandFeelsTheForceAskedFor) {
  Bench bench;
  bench.home();
  for (const Vec3& force : {Vec3(1, 0, 0), Vec3(0, -2, 0), Vec3(0.5, 0.5, -1)}) {
    bench.run(0.4, force);
    EXPECT_LT(glm::length(bench.arm.force() - force), 0.02);
    EXPECT_GT(glm::dot(bench.stylus->read().position, force), 0) << "the simulated hand relaxes";
  }
}

/// How far the hand still moves on a wall of this stiffness (N/m), m.
double ringing(double stiffness, double friction) {
  FakeWoodenHapticsOptions options;
  options.friction = friction;
  options.path = {{0.3, {0, 0, 0}}, {0.5, {0, 0.005, 0}}, {1.0, {0, -0.002, 0}}};
  Bench bench(options);
  bench.home();
  return ringing_of_wall(bench, bench.arm.hand(), stiffness);
}

TEST(WoodenHapticsDriver, AWallAtItsStiffnessLimitIsQuiet) {
  const double limit = Bench().stylus->specification().stiffness_limit;
  EXPECT_LT(ringing(limit, 0.06), 0.15e-3) << "tremor alone";
  // Whatever a real one's friction: without any, a stiffer wall lets less of the tremor through, until it rings.
  EXPECT_LT(ringing(limit, 0), ringing(limit / 2, 0));
  EXPECT_LT(ringing(1.5 * limit, 0), ringing(limit, 0)) << "and there is a margin";
  EXPECT_GT(ringing(4 * limit, 0), 3 * ringing(limit, 0)) << "or nothing could be seen here";
}

TEST(WoodenHapticsDriver, APoseIsFreshOnce) {
  Bench bench;
  bench.home();
  int fresh = 0;
  bench.run(0.5, [&](const Reading& reading) {
    fresh += reading.fresh ? 1 : 0;
    EXPECT_FALSE(bench.stylus->read().fresh);
    return Vec3(0);
  });
  EXPECT_GT(fresh, 300);
}

/// No safety filter here, and a current limit that would allow more: what limits is the driver.
TEST(WoodenHapticsDriver, HoldsItsOwnForceLimit) {
  FakeWoodenHapticsOptions options;
  options.arm.maximum_force = 1.5;
  Bench bench(options);
  bench.home();
  EXPECT_EQ(bench.stylus->specification().maximum_force, 1.5);
  for (const Vec3& force : {Vec3(1, 0, 1), Vec3(2, 0, 0), Vec3(0, -2.5, 1), Vec3(0, 0, 1.7)}) {
    bench.run(0.05, force);
    const Vec3 expected = force * std::min(1.0, 1.5 / glm::length(force));
    EXPECT_LT(glm::length(bench.arm.force() - expected), 0.02) << force.x << ' ' << force.y << ' ' << force.z;
  }
  EXPECT_LT(glm::length(bench.arm.strongest_force()), 1.52);
}

TEST(WoodenHapticsDriver, ComesUpAtAnyTimeOfTheClock) {
  Bench bench;
  bench.bench.time = 5000;
  bench.stylus->open();
  bench.run(0.1);
  EXPECT_GT(bench.arm.reports(), 50U);
  EXPECT_NE(bench.stylus->state(), State::fault);
}

TEST(WoodenHapticsDriver, StartsAFirmwareThatWaits) {
  Bench bench;
  bench.home();
  bench.arm.faults.drop_every = 50;  // the firmware then blocks until it is sent something
  bench.run(1, Vec3(0, 1, 0));
  EXPECT_EQ(bench.stylus->fault(), LinkFault::none);
  EXPECT_GT(bench.arm.outputs(), 700U);
}

TEST(WoodenHapticsDriver, ShortReportsAreRefused) {
  Bench bench;
  bench.home();
  bench.arm.faults.short_every = 20;
  bench.run(1, Vec3(0, 1, 0));
  EXPECT_EQ(bench.stylus->fault(), LinkFault::none);
  EXPECT_LT(glm::length(bench.stylus->read().position - bench.arm.hand().body().position), 0.5e-3);
}

TEST(WoodenHapticsDriver, FaultsEndInZeros) {
  Bench impossible;
  impossible.home();
  impossible.run(0.1, Vec3(0, 1, 0));
  impossible.arm.faults.impossible_pose = true;
  impossible.run(0.1, Vec3(0, 1, 0));
  EXPECT_EQ(impossible.stylus->fault(), LinkFault::unreachable_pose);
  EXPECT_FALSE(impossible.is_pushing());

  Bench unplugged;
  unplugged.home();
  unplugged.run(0.1, Vec3(0, 1, 0));
  unplugged.bench.unplugged = true;
  unplugged.run(0.01, Vec3(0, 1, 0));
  EXPECT_EQ(unplugged.stylus->fault(), LinkFault::unplugged);
  EXPECT_TRUE(unplugged.is_pushing()) << "nobody can reach it";
  unplugged.bench.time += 0.51;
  EXPECT_FALSE(unplugged.is_pushing()) << "its own watchdog of 0.5 s";

  Bench stalled;
  stalled.home();
  stalled.run(0.1, Vec3(0, 1, 0));
  for (int i = 0; i < 30; ++i) stalled.stylus->service(1e-3);
  EXPECT_FALSE(stalled.is_pushing());

  Bench closed;
  closed.home();
  closed.run(0.1, Vec3(0, 1, 0));
  ASSERT_TRUE(closed.is_pushing());
  closed.stylus->close();
  EXPECT_FALSE(closed.is_pushing());
}

TEST(WoodenHapticsDriver, ADeviceThatDoesNotAnswerIsRefused) {
  Bench bench;
  bench.arm.faults.silent = true;
  EXPECT_THROW(bench.stylus->open(), std::runtime_error);
  EXPECT_EQ(bench.stylus->state(), State::disconnected);
}

TEST(WoodenHapticsDriver, KeepsItsHomeWhenItIsOpenedAgain) {
  for (const std::size_t size : {8U, 14U}) {
    FakeWoodenHapticsOptions options;
    options.report_size = size;
    options.arm = arm_with_home_at(Vec3(0), size);
    options.path = {{0.5, {0, 0, 0}}, {0.8, {0.04, -0.03, 0.03}}};
    Bench bench(options);
    bench.stylus->open();
    bench.run(1.2);
    bench.stylus->close();
    bench.stylus->open();
    bench.run(0.1, Vec3(0, 1, 0));
    ASSERT_EQ(bench.stylus->state(), State::idle) << size;
    EXPECT_LT(glm::distance(bench.stylus->read().position, bench.arm.hand().body().position), 0.2e-3) << size;
    EXPECT_LT(glm::distance(bench.arm.force(), Vec3(0, 1, 0)), 0.02) << size;
  }
}

TEST(WoodenHapticsDriver, AnUnpluggedArmHasToBeHomedAgain) {
  Bench bench;
  bench.home();
  bench.bench.unplugged = true;
  bench.run(0.01);
  bench.stylus->close();
  bench.bench.unplugged = false;
  bench.stylus->open();
  bench.run(0.1, Vec3(0, 1, 0));
  EXPECT_EQ(bench.stylus->state(), State::homing);
  EXPECT_FALSE(bench.is_pushing());
}

TEST(WoodenHapticsDriver, AnotherArmThanThePresetIsRefused) {
  FakeWoodenHapticsOptions options;
  options.report_size = 8;
  options.arm = arm_with_home_at(Vec3(0), 14);
  Bench bench(options);
  try {
    bench.stylus->open();
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("reports of 8 bytes, which the preset 2015 does not have"));
  }
}

TEST(WoodenHapticsDriver, MotorsAreNotHeatedForLong) {
  Bench bench;
  bench.home();
  const auto strongest = [&] {
    const auto& milliamperes = bench.arm.milliamperes();
    return std::max({std::abs(milliamperes[0]), std::abs(milliamperes[1]), std::abs(milliamperes[2])});
  };
  bench.run(1, Vec3(0, 5, 0));
  EXPECT_GT(strongest(), 1900) << "short-term, to the limit of the current";
  bench.run(15, Vec3(0, 5, 0));
  EXPECT_LT(strongest(), 1010) << "for long, to the continuous current";
  EXPECT_GT(strongest(), 900);
}

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
          "current_limit": 2.1, "maximum_force": 5.1, "stiffness_limit": 1001, "guarded": false})"));
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
}

TEST(WoodenHapticsSettings, DefaultsAreThoseOfThePublishedArm) {
  const WoodenHapticsSettings s;
  EXPECT_EQ(s.capstan_diameter, (std::array{0.010, 0.010, 0.010}));
  EXPECT_EQ(s.body_diameter, (std::array{0.160, 0.120, 0.120}));
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
               {R"({"preset": "2015", "torque_constant": [0, 1, 1]})", "torque constant of axis a"},
               {R"({"preset": "2015", "encoder_sign": [1, 1, 2]})", "encoder sign of axis c"},
               {R"({"preset": "2015", "current_limit": 30})", "current limit"},
               {R"({"preset": "2015", "stiffness_limit": 0})", "stiffness limit"},
               {R"({"preset": "2015", "capstan_diameter": [0.01, 0, 0.01]})", "diameters of axis b"},
               {R"({"preset": "2015", "body_diameter": [0.16, 0.12, 0.01]})", "diameters of axis c"},
               {R"({"preset": "2015", "counts_per_turn": [2000, 0, 2000]})", "counts per turn of axis b"},
               {R"({"preset": "2015", "encoder_sign": [0, 1, 1]})", "encoder sign of axis a"},
               {R"({"preset": "2015", "home_counts": [0, 32768, 0]})", "home counts of axis b"},
               {R"({"preset": "2015", "home_counts": [-32769, 0, 0]})", "home counts of axis a"},
               {R"({"preset": "2015", "lower_length": 0})", "lengths of the bodies"},
               {R"({"preset": "2015", "upper_length": 0})", "lengths of the bodies"},
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
      EXPECT_THAT(error.what(), testing::HasSubstr(example.names));
      EXPECT_THAT(error.what(), testing::HasSubstr("wooden.json"));
    }
  }
}

}  // namespace
}  // namespace palpate::device
