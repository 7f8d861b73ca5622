/// An arm of which no two numbers are alike: three capstans, three motors, an origin beside the middle. What holds for
/// it holds by no symmetry.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <random>

#include "device/wooden_haptics/wooden_haptics.h"

namespace palpate::device {
namespace {

double any_number(std::mt19937& random, double least, double most) {
  return std::uniform_real_distribution<double>(least, most)(random);
}

WoodenHapticsSettings odd_arm(std::mt19937& random) {
  WoodenHapticsSettings arm;
  for (std::size_t i = 0; i < 3; ++i) {
    arm.capstan_diameter[i] = any_number(random, 0.008, 0.014);
    arm.body_diameter[i] = any_number(random, 0.1, 0.2);
    arm.torque_constant[i] = any_number(random, 0.02, 0.08);
    arm.counts_per_turn[i] = static_cast<int>(random() % 3000) + 500;
    arm.encoder_sign[i] = random() % 2 == 0 ? 1 : -1;
    arm.motor_aligned[i] = random() % 2 == 0;
    arm.origin[i] = any_number(random, -0.3, 0.3);
  }
  arm.base_height = any_number(random, 0.05, 0.15);
  arm.lower_length = any_number(random, 0.1, 0.3);
  arm.upper_length = any_number(random, 0.1, 0.3);
  arm.current_limit = any_number(random, 0.5, 3);
  return arm;
}

Vec3 any_vector(std::mt19937& random, double size) {
  return {any_number(random, -size, size), any_number(random, -size, size), any_number(random, -size, size)};
}

/// A turn of the encoder is one of the capstan, and turns the body by the ratio of the two; aligned motors turn it
/// back.
TEST(WoodenHapticsOddArm, BodiesTurnByTheRatioOfTheirCapstans) {
  std::mt19937 random(1);
  for (int n = 0; n < 200; ++n) {
    const WoodenHapticsSettings arm = odd_arm(random);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::array<int, 3> counts{};
      counts[axis] = 3 * arm.counts_per_turn[axis];
      Vec3 wanted(0);
      wanted[static_cast<int>(axis)] = 3 * 2 * std::numbers::pi * arm.capstan_diameter[axis] / arm.body_diameter[axis] *
                                       arm.encoder_sign[axis] * (arm.motor_aligned[axis] ? -1 : 1);
      EXPECT_LT(glm::distance(wooden_haptics_angles(arm, counts), wanted), 1e-12);
    }
  }
}

/// The base turns both bodies about the vertical. Each leans outward by its own angle to the vertical, the lower one
/// from upright, the upper one from hanging.
TEST(WoodenHapticsOddArm, TheTipIsTwoBodiesFromTheBase) {
  std::mt19937 random(2);
  const auto turned = [](double angle, const Vec3& axis, const Vec3& v) {
    return Vec3(glm::rotate(glm::dmat4(1), angle, axis) * glm::dvec4(v, 1));
  };
  for (int n = 0; n < 500; ++n) {
    const WoodenHapticsSettings arm = odd_arm(random);
    const Vec3 angles = any_vector(random, 3);
    // In the arm's frame, z up: about y from z to x.
    const Vec3 lower = turned(angles.y, Vec3(0, 1, 0), Vec3(0, 0, arm.lower_length));
    const Vec3 upper = turned(-angles.z, Vec3(0, 1, 0), Vec3(0, 0, -arm.upper_length));
    const Vec3 tip = Vec3(0, 0, arm.base_height) + turned(angles.x, Vec3(0, 0, 1), lower + upper) -
                     Vec3(arm.origin[0], arm.origin[1], arm.origin[2]);
    EXPECT_LT(glm::distance(wooden_haptics_position(arm, angles), Vec3(tip.y, tip.z, tip.x)), 1e-12);
  }
}

/// Virtual work from the currents to the hand: what the motors do in a small turn, each torque constant times current
/// times turn of its shaft, the force does along the tip's way.
TEST(WoodenHapticsOddArm, TheMotorsDoTheWorkOfTheForce) {
  std::mt19937 random(3);
  for (int n = 0; n < 500; ++n) {
    WoodenHapticsSettings arm = odd_arm(random);
    arm.current_limit = 30;  // out of the way
    std::array<int, 3> counts{}, before{}, after{};
    for (std::size_t i = 0; i < 3; ++i) {
      counts[i] = static_cast<int>(any_number(random, -1, 1) * arm.counts_per_turn[i]);
      const int step = static_cast<int>(random() % 7) - 3;
      before[i] = counts[i] - step;
      after[i] = counts[i] + step;
    }
    const auto tip = [&](const std::array<int, 3>& at) {
      return wooden_haptics_position(arm, wooden_haptics_angles(arm, at));
    };
    const Vec3 force = any_vector(random, 3);
    const Vec3 torques = wooden_haptics_torques(arm, wooden_haptics_angles(arm, counts), force);
    const std::array<int, 3> milliamperes = wooden_haptics_currents(arm, torques);
    double work = 0, rounding = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double turn = arm.encoder_sign[i] * 2 * std::numbers::pi * (after[i] - before[i]) / arm.counts_per_turn[i];
      work += arm.torque_constant[i] * 1e-3 * milliamperes[i] * turn;
      rounding += arm.torque_constant[i] * 1e-3 * std::abs(turn);
    }
    EXPECT_NEAR(work, glm::dot(force, tip(after) - tip(before)), rounding + 1e-6);
  }
}

/// Beyond the limit the largest current is the limit, to the milliampere, and the others are in proportion; within it
/// nothing is changed.
TEST(WoodenHapticsOddArm, CurrentsAreShrunkTogether) {
  std::mt19937 random(4);
  int limited = 0;
  for (int n = 0; n < 1000; ++n) {
    const WoodenHapticsSettings arm = odd_arm(random);
    const Vec3 torques = any_vector(random, 2);
    std::array<double, 3> amperes{};
    double largest = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      amperes[i] = torques[static_cast<int>(i)] * arm.capstan_diameter[i] / arm.body_diameter[i] /
                   arm.torque_constant[i] * (arm.motor_aligned[i] ? -1 : 1);
      largest = std::max(largest, std::abs(amperes[i]));
    }
    limited += largest > arm.current_limit ? 1 : 0;
    const double factor = std::min(1.0, arm.current_limit / largest);
    const std::array<int, 3> told = wooden_haptics_currents(arm, torques);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(told[i], 1e3 * factor * amperes[i], 1) << i;
      EXPECT_LE(std::abs(told[i]), 1e3 * arm.current_limit);
    }
  }
  EXPECT_GT(limited, 100);
  EXPECT_LT(limited, 900);
}

}  // namespace
}  // namespace palpate::device
