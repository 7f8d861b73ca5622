#pragma once

/// The last layer before a device: it keeps the force on the device and decides the next one. It keeps three rules. The
/// force on the device is known, or the largest possible one is assumed. No force changes faster than the slew ceiling.
/// Every zero that was inserted for any reason (a late servo, a doubtful pose, a device that refused or did not answer)
/// is followed by a ramp.

#include <limits>

#include "device/link/driver.h"
#include "device/safety/on_device.h"
#include "device/safety/safety_limits.h"

namespace palpate::device {

class GivenForce {
 public:
  /// The device may still hold the force of a program that ended before.
  void start(double now) noexcept;
  /// N: the force to give now. `wanted`: the requested force; `withheld`: a zero replaces it.
  Vec3 next(const Vec3& wanted, bool withheld, double now) noexcept;
  /// The state of the device if the force of next() reaches it. `news`: poses so far (ProtocolStatus::news).
  OnDevice while_giving(const Vec3& force, std::uint64_t news) noexcept;
  /// Records the device's answer to the force of next().
  void answered(ForceAnswer answer, const Vec3& force, std::uint64_t news, double now) noexcept;
  /// To be called if the device is gone or silent.
  void doubt() noexcept;
  OnDevice on_device() const noexcept { return on_device_; }
  /// s since the device began to refuse every force.
  double refused_for(double now) const noexcept { return refuses_ ? now - taken_time_ : 0; }
  /// s since the device last took a force, or a zero in its place.
  double untaken_for(double now) const noexcept { return now - taken_time_; }
  /// N
  const Vec3& given() const noexcept { return given_; }
  /// Whether less is given than was requested: a zero was inserted, or the ramp after it has not ended.
  bool is_held_back() const noexcept { return gain_ < 1; }

 private:
  void restart() noexcept;

  OnDevice on_device_ = OnDevice::unknown;
  Vec3 given_{0};                                                 // N
  double given_time_ = -std::numeric_limits<double>::infinity();  // s: since then `given_` is known to be on the device
  double gain_ = 0;
  double time_ = 0;  // s: of the last next()
  bool zero_given_ = false;
  std::uint64_t zero_news_ = 0;  // poses when the first zero in a row was given
  bool refuses_ = false;
  double taken_time_ = 0;  // s: when the device last took a force
};

}  // namespace palpate::device
