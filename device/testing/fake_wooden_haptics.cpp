#include "device/testing/fake_wooden_haptics.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <numbers>
#include <utility>

namespace palpate::device {

namespace {

ArmModel wooden_arm(double friction) {
  ArmModel arm;
  arm.coulomb_friction = friction;
  arm.mass = 0.15;
  arm.half_extent = Vec3(0.06);
  return arm;
}

std::vector<Waypoint> path_of(const FakeWoodenHapticsOptions& options) {
  return options.path.empty() ? std::vector<Waypoint>{{0, Vec3(0)}} : options.path;
}

int word(std::span<const std::uint8_t> report, std::size_t index) {
  return static_cast<std::int16_t>(report[2 * index] | report[2 * index + 1] << 8);
}

/// The motors' counts per radian of a body, signed.
double counts_per_radian(const WoodenHapticsSettings& s, std::size_t axis) {
  const double direction = s.motor_aligned[axis] ? -1 : 1;
  return s.encoder_sign[axis] * direction * s.counts_per_turn[axis] / (2 * std::numbers::pi) * s.body_diameter[axis] /
         s.capstan_diameter[axis];
}

}  // namespace

Vec3 wooden_haptics_inverse(const WoodenHapticsSettings& s, const Vec3& position) {
  const double x = position.z + s.origin[0];
  const double y = position.x + s.origin[1];
  const double height = position.y + s.origin[2] - s.base_height;
  const double reach = std::hypot(x, y);
  const double distance = std::hypot(reach, height);
  const double cosine = (s.lower_length * s.lower_length + distance * distance - s.upper_length * s.upper_length) /
                        (2 * s.lower_length * distance);
  const double lower = std::atan2(reach, height) - std::acos(cosine);
  const double upper = std::atan2(reach - s.lower_length * std::sin(lower), s.lower_length * std::cos(lower) - height);
  return {std::atan2(y, x), lower, upper};
}

WoodenHapticsSettings arm_with_home_at(const Vec3& position) {
  WoodenHapticsSettings settings;
  const Vec3 angles = wooden_haptics_inverse(settings, position);
  for (std::size_t i = 0; i < 3; ++i) {
    settings.home_counts[i] =
        static_cast<int>(std::lround(angles[static_cast<int>(i)] * counts_per_radian(settings, i)));
  }
  return settings;
}

FakeWoodenHaptics::FakeWoodenHaptics(const FakeWoodenHapticsOptions& options)
    : options_(options), hand_(wooden_arm(options.friction), HandModel{}, path_of(options)) {
  zero_ = true_counts();  // incremental encoders read 0 when they are switched on
}

HidIdentity FakeWoodenHaptics::identity() const {
  const auto size = static_cast<std::uint8_t>(options_.report_size);
  // The maker's page; one input and one output report of bytes, without numbers.
  std::vector<std::uint8_t> descriptor{0x06, 0xab, 0xff, 0x0a, 0x00, 0x02, 0xa1, 0x01, 0x75, 0x08,
                                       0x15, 0x00, 0x26, 0xff, 0x00, 0x95, size, 0x09, 0x01, 0x81,
                                       0x02, 0x95, size, 0x09, 0x02, 0x91, 0x02, 0xc0};
  if (size == 64) return {0x16c0, 0x0486, "Teensy Haptics", std::move(descriptor), false};
  return {0x1234, 0x0006, "WoodenHaptics", std::move(descriptor), false};
}

Vec3 FakeWoodenHaptics::angles() const {
  return wooden_haptics_inverse(options_.arm, hand_.body().position);
}

std::array<int, 3> FakeWoodenHaptics::true_counts() const {
  const Vec3 now = angles();
  std::array<int, 3> counts{};
  for (std::size_t i = 0; i < 3; ++i) {
    counts[i] = static_cast<int>(std::lround(now[static_cast<int>(i)] * counts_per_radian(options_.arm, i)));
  }
  return counts;
}

std::optional<std::size_t> FakeWoodenHaptics::read(std::span<std::uint8_t> report, double now) {
  if (watchdog_bites(now)) {
    milliamperes_ = {};
    force_ = Vec3(0);
  }
  if (faults.silent || waits_for_output_ || now < next_report_ + faults.report_delay) return std::nullopt;
  hand_.advance(now, force_);
  if (options_.report_size != 8 && !button_was_pressed_ && now >= options_.button_time) {
    button_was_pressed_ = button_latched_ = true;
  }
  const std::size_t size = options_.report_size;
  std::fill(report.begin(), report.begin() + static_cast<std::ptrdiff_t>(size), std::uint8_t{0});
  const std::array<int, 3> counts = true_counts();
  for (std::size_t i = 0; i < 3; ++i) {
    const int value = faults.impossible_pose ? 30'000 : counts[i] - zero_[i];
    report[2 * i] = static_cast<std::uint8_t>(value & 0xff);
    report[2 * i + 1] = static_cast<std::uint8_t>((value >> 8) & 0xff);
  }
  if (size != 8) report[12] = button_latched_ ? 1 : 0;
  waits_for_output_ = true;
  ++reports_;
  const auto nth = [&](int every) { return every > 0 && reports_ % static_cast<std::uint64_t>(every) == 0; };
  if (nth(faults.drop_every)) return std::nullopt;
  if (nth(faults.garble_every)) {
    for (std::uint8_t& byte : report.first(size)) byte ^= 0x5a;
  }
  return nth(faults.short_every) ? 5 : size;
}

void FakeWoodenHaptics::write(std::span<const std::uint8_t> report, double now) {
  if (faults.silent) return;
  if (report.size() != options_.report_size) {
    ++odd_outputs_;
    return;
  }
  ++outputs_;
  hand_.advance(now, force_);
  last_output_ = now;
  const bool sets_counters = report.size() != 8 && word(report, 3) == 1;
  milliamperes_ =
      sets_counters ? std::array<int, 3>{} : std::array<int, 3>{word(report, 0), word(report, 1), word(report, 2)};
  if (sets_counters) {
    const std::array<int, 3> counts = true_counts();
    for (std::size_t i = 0; i < 3; ++i) zero_[i] = counts[i] - word(report, 4 + i);
    button_latched_ = false;
  }
  if (milliamperes_ != std::array<int, 3>{}) pushed_until_ = now;

  // Force from torques: the torques of the three unit forces are the Jacobian's rows.
  Vec3 torques;
  for (std::size_t i = 0; i < 3; ++i) {
    const double direction = options_.arm.motor_aligned[i] ? -1 : 1;
    torques[static_cast<int>(i)] = milliamperes_[i] * 1e-3 * direction * options_.arm.torque_constant[i] *
                                   options_.arm.body_diameter[i] / options_.arm.capstan_diameter[i];
  }
  glm::dmat3 torques_of_unit_forces;
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 unit(0);
    unit[axis] = 1;
    torques_of_unit_forces[axis] = wooden_haptics_torques(options_.arm, angles(), unit);
  }
  force_ = glm::inverse(torques_of_unit_forces) * torques;
  if (glm::length(force_) > glm::length(strongest_)) strongest_ = force_;
  if (waits_for_output_) next_report_ = std::max(next_report_ + 1e-3, now);
  waits_for_output_ = false;
}

bool FakeWoodenHaptics::is_pushing(double now) const {
  return !watchdog_bites(now) && milliamperes_ != std::array<int, 3>{};
}

}  // namespace palpate::device
