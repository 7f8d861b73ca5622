#pragma once

/// A stylus without hardware: both the arm and the hand that holds it are simulated. The hand follows a scripted path
/// or a live target, and is moved by the forces that are written.
///
/// It advances by simulated time, never by the clock: each read() and write_force() pair is one tick of 1 / rate, so
/// the same forces give the same poses bit for bit. A force is held for a tick (zero-order hold) and acts `delay` after
/// it was written; poses are read in steps, as from encoders.

#include <array>
#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "device/link/latest.h"
#include "device/simulated/hand_path.h"
#include "device/simulated/simulated_hand.h"
#include "device/stylus.h"

namespace palpate::device {

/// The simulated device of every study, modeled on a Desktop PHANTOM.
struct SimulatedDevice {
  ArmModel arm;
  HandModel hand;
  double position_step = 0.02e-3;  ///< m; 0 reads the exact position
  double rate = 1000;              ///< Hz
  double delay = 0.5e-3;           ///< s, rounded to sub-steps of at most 50 us
  double maximum_force = 7.9;      ///< N: more than this saturates, direction kept
  double continuous_force = 1.75;  ///< N
  double target_speed = 0.25;      ///< m/s: how fast the hand follows a live target
};

enum class SimulatedFault : std::uint8_t {
  none,
  unplugged,     ///< State::fault: the last pose stays, and no force reaches the arm
  stalled,       ///< the last pose and the last force stay, while the hand moves on
  not_a_number,  ///< poses of NaN
};

class SimulatedStylus final : public Stylus {
 public:
  /// Throws std::invalid_argument naming the setting that is impossible.
  explicit SimulatedStylus(const SimulatedDevice& device = {});

  /// The hand follows these waypoints from open() on; copied. Not while ticking. Throws as check_path().
  void follow(std::span<const Waypoint> path, PathInterpolation interpolation = PathInterpolation::minimum_jerk);
  /// The hand leaves its path and moves to this target (m). From one thread at a time, also while ticking. The hand
  /// stays in place while the device is closed.
  void move_target(const Vec3& target, std::uint32_t buttons = 0) noexcept;
  /// From any thread, also while ticking. SimulatedFault::none plugs it in again; open() is needed after unplugged.
  void inject(SimulatedFault fault) noexcept { fault_.store(fault, std::memory_order_relaxed); }

  Specification specification() const override;
  void open() override;
  void close() noexcept override;
  Reading read() noexcept override;
  void write_force(const Vec3& force) noexcept override;
  State state() const noexcept override { return state_.load(std::memory_order_relaxed); }

  // A real device cannot report these; for studies and tests, from the ticking thread.
  const BodyState& body() const noexcept { return body_; }             ///< before the position steps
  const Vec3& acting_force() const noexcept { return acting_force_; }  ///< N, now on the arm

 private:
  struct LiveTarget {
    Vec3 position{0};
    std::uint32_t buttons = 0;
    bool given = false;
  };

  double time() const { return static_cast<double>(tick_) / device_.rate; }
  void aim(double time) noexcept;

  SimulatedDevice device_;
  Tremor tremor_;
  std::int64_t steps_per_tick_;
  std::int64_t delay_steps_;
  std::vector<Waypoint> path_;
  PathInterpolation interpolation_ = PathInterpolation::minimum_jerk;
  Latest<LiveTarget> live_target_;
  std::atomic<SimulatedFault> fault_{SimulatedFault::none};
  std::atomic<State> state_{State::disconnected};

  std::int64_t tick_ = 0;
  std::int64_t read_tick_ = -1;
  BodyState body_;
  Vec3 intended_{0};  // the hand's target without its tremor
  Vec3 target_{0};
  std::uint32_t buttons_ = 0;
  Vec3 acting_force_{0};
  Reading last_reading_;
  std::array<Vec3, 64> forces_{};  // by tick, on their way to the arm
};

}  // namespace palpate::device
