#include "device/testing/fake_wooden_haptics.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "device/testing/public_wooden_haptics.h"

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

PublicHost host_of(std::size_t report_size) {
  return report_size == 8 ? PublicHost::woody_2016 : PublicHost::haptikfabriken;
}

/// Whole counts where the hand is.
std::array<int, 3> rounded(const Vec3& counts) {
  return {static_cast<int>(std::lround(counts.x)), static_cast<int>(std::lround(counts.y)),
          static_cast<int>(std::lround(counts.z))};
}

}  // namespace

WoodenHapticsSettings arm_with_home_at(const Vec3& position, std::size_t report_size) {
  WoodenHapticsSettings settings = wooden_haptics_preset(report_size == 8 ? "2016" : "2015");
  std::array<int, 3> counts = rounded(public_wooden_counts(host_of(report_size), position));
  // The older host counts from its home, where the driver has -6000.
  if (report_size == 8) counts[2] -= 6000;
  settings.home_counts = counts;
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

std::array<int, 3> FakeWoodenHaptics::true_counts() const {
  return rounded(public_wooden_counts(host_of(options_.report_size), hand_.body().position));
}

std::optional<std::size_t> FakeWoodenHaptics::read(std::span<std::uint8_t> report, double now) {
  if (watchdog_bites(now)) {
    milliamperes_ = {};
    force_ = Vec3(0);
  }
  if (faults.silent) return std::nullopt;
  if ((faults.speaks_on || !waits_for_output_) && now >= next_report_) make_report(now);
  if (to_host_.empty() || to_host_.front().ready > now) return std::nullopt;
  const std::vector<std::uint8_t> made = std::move(to_host_.front().bytes);
  to_host_.pop_front();
  std::copy(made.begin(), made.end(), report.begin());
  return made.size();
}

void FakeWoodenHaptics::make_report(double now) {
  hand_.advance(now, force_);
  if (options_.report_size != 8 && !button_was_pressed_ && now >= options_.button_time) {
    button_was_pressed_ = button_latched_ = true;
  }
  const std::size_t size = options_.report_size;
  std::vector<std::uint8_t> report(size);
  const std::array<int, 3> counts = true_counts();
  for (std::size_t i = 0; i < 3; ++i) {
    const int value = faults.impossible_pose ? 30'000 : counts[i] - zero_[i];
    report[2 * i] = static_cast<std::uint8_t>(value & 0xff);
    report[2 * i + 1] = static_cast<std::uint8_t>((value >> 8) & 0xff);
  }
  if (size != 8) {
    report[6] = static_cast<std::uint8_t>(faults.fourth_encoder & 0xff);
    report[7] = static_cast<std::uint8_t>((faults.fourth_encoder >> 8) & 0xff);
  }
  if (size != 8) report[12] = button_latched_ || faults.button_pressed ? 1 : 0;
  waits_for_output_ = true;
  if (faults.speaks_on) next_report_ = now + 1e-3;
  ++reports_;
  const auto nth = [&](int every) { return every > 0 && reports_ % static_cast<std::uint64_t>(every) == 0; };
  if (nth(faults.drop_every)) return;
  if (nth(faults.garble_every)) {
    for (std::uint8_t& byte : report) byte ^= 0x5a;
  }
  if (nth(faults.short_every)) report.resize(5);
  to_host_.push_back({std::move(report), now + faults.report_delay});
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

  const std::array<int, 3> counts = true_counts();
  force_ = public_wooden_force(host_of(options_.report_size), Vec3(counts[0], counts[1], counts[2]),
                               1e-3 * Vec3(milliamperes_[0], milliamperes_[1], milliamperes_[2]));
  if (glm::length(force_) > glm::length(strongest_)) strongest_ = force_;
  if (waits_for_output_) next_report_ = std::max(next_report_ + 1e-3, now);
  waits_for_output_ = false;
}

void FakeWoodenHaptics::switch_off_and_on() {
  zero_ = true_counts();
  button_latched_ = waits_for_output_ = false;
  to_host_.clear();
  milliamperes_ = {};
  force_ = Vec3(0);
}

bool FakeWoodenHaptics::is_pushing(double now) const {
  return !watchdog_bites(now) && milliamperes_ != std::array<int, 3>{};
}

}  // namespace palpate::device
