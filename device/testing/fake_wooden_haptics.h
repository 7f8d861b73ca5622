#pragma once

/// A WoodenHaptics arm as seen through its reports, with a hand on it: lock-step, calibration button, watchdog of 0.5
/// s.

#include <array>
#include <cstdint>
#include <deque>
#include <vector>

#include "device/testing/fake_hand.h"
#include "device/testing/fake_hid.h"
#include "device/wooden_haptics/wooden_haptics.h"

namespace palpate::device {

/// Settings for an arm with such reports whose home pose is at this position (m, device's frame).
WoodenHapticsSettings arm_with_home_at(const Vec3& position, std::size_t report_size = 14);

struct FakeWoodenHapticsOptions {
  WoodenHapticsSettings arm = arm_with_home_at(Vec3(0));
  std::size_t report_size = 14;  ///< 14, 64 (Teensy) or 8 (firmware of 2016, without a button)
  double friction = 0.06;        ///< N, of the arm
  double button_time = 0.2;      ///< s: time at which the user holds the arm in its home pose and presses the button
  std::vector<Waypoint> path;    ///< of the hand, m in the device's frame; empty: at rest at the origin, the home pose
};

struct FakeWoodenHapticsFaults {
  bool silent = false;
  double report_delay = 0;  ///< s of delay of a report
  int short_every = 0;      ///< every n-th report is cut to 5 bytes
  int drop_every = 0;       ///< every n-th report is lost
  int garble_every = 0;     ///< every n-th report has all its bytes changed
  bool speaks_on = false;   ///< it sends a report each millisecond, answered or not
  bool impossible_pose = false;
  bool button_pressed = false;  ///< the calibration button, held down
  int fourth_encoder = 0;       ///< counts; a button on the stylus adds 10000
};

class FakeWoodenHaptics final : public FakeHid {
 public:
  explicit FakeWoodenHaptics(const FakeWoodenHapticsOptions& options);

  HidIdentity identity() const override;
  std::optional<std::size_t> read(std::span<std::uint8_t> report, double now) override;
  void write(std::span<const std::uint8_t> report, double now) override;
  bool is_pushing(double now) const override;
  /// Its counters begin anew where the hand is.
  void switch_off_and_on();

  FakeWoodenHapticsFaults faults;

  const std::array<int, 3>& milliamperes() const noexcept { return milliamperes_; }
  const Vec3& force() const noexcept { return force_; }                ///< N on the stylus
  const Vec3& strongest_force() const noexcept { return strongest_; }  ///< N: the largest so far
  double pushed_until() const noexcept { return pushed_until_; }       ///< s: time of the last report with a current
  const FakeHand& hand() const noexcept { return hand_; }
  FakeHand& hand() noexcept { return hand_; }
  std::uint64_t reports() const noexcept { return reports_; }
  std::uint64_t outputs() const noexcept { return outputs_; }
  std::uint64_t odd_outputs() const noexcept { return odd_outputs_; }  ///< reports of a wrong size

 private:
  std::array<int, 3> true_counts() const;
  void make_report(double now);
  bool watchdog_bites(double now) const { return now - last_output_ > 0.5; }

  FakeWoodenHapticsOptions options_;
  FakeHand hand_;
  std::array<int, 3> zero_{};  // true counts where the counters read 0
  bool button_latched_ = false;
  bool button_was_pressed_ = false;
  bool waits_for_output_ = false;
  struct Report {
    std::vector<std::uint8_t> bytes;
    double ready;
  };
  std::deque<Report> to_host_;
  double next_report_ = 0;
  double last_output_ = 0;
  double pushed_until_ = 0;
  std::array<int, 3> milliamperes_{};
  Vec3 force_{0};
  Vec3 strongest_{0};
  std::uint64_t reports_ = 0;
  std::uint64_t outputs_ = 0;
  std::uint64_t odd_outputs_ = 0;
};

}  // namespace palpate::device
