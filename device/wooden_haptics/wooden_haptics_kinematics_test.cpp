#include "device/wooden_haptics/wooden_haptics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>

#include "device/testing/public_wooden_haptics.h"

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

/// Of the fake: everywhere in the cube that its hand can be in, the counts give the position back, and no part of the
/// arm has turned by more than a quarter.
TEST(WoodenHapticsKinematics, TheFakesCountsAreThoseOfAnArmThatStaysOnItsSide) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-0.06, 0.06);
  for (int i = 0; i < 20'000; ++i) {
    const double x = uniform(random), y = uniform(random), z = uniform(random);
    const Vec3 position(x, y, z);
    for (const PublicHost host : {PublicHost::haptikfabriken, PublicHost::woody_2016}) {
      const Vec3 counts = public_wooden_counts(host, position);
      ASSERT_LT(glm::length(public_wooden_position(host, counts) - position), 1e-12);
      ASSERT_LT(std::abs(counts.x), 2000 * 16 / 4);
      ASSERT_LT(std::abs(counts.y), 2000 * 12 / 4);
      ASSERT_LT(std::abs(counts.z), 2000 * 12 / 4);
    }
  }
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

/// A current is a word of 16 bits in its packet: one beyond them would come out with the other sign.
TEST(WoodenHapticsKinematics, CurrentsFitTheirWords) {
  WoodenHapticsSettings settings = wooden_haptics_preset("2015");
  for (const double limit : {3.0, 32.0, 33.0, 65.0, 100.0, 1e5}) {
    settings.current_limit = limit;
    for (const double torque : {1e6, -1e6}) {
      const auto currents = wooden_haptics_currents(settings, Vec3(torque));
      const auto small = wooden_haptics_currents(settings, Vec3(torque) * 1e-8);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_EQ(static_cast<std::int16_t>(currents[axis]), currents[axis]) << limit;
        EXPECT_GT(static_cast<long>(currents[axis]) * small[axis], 0) << "no sign may change";
      }
    }
  }
}

}  // namespace
}  // namespace palpate::device
