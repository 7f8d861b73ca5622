#pragma once

/// Connects a scan, a scene and a stylus. Each tick reads the pose, steps the balance, filters the force, writes it,
/// and leaves a tick record.
///
/// Two threads meet here. The servo calls tick() and shares(). All other functions are called from one controlling
/// thread at a time (the panel's or the command line's). Scenes, scans, frames and styluses are replaced whole, between
/// two ticks; the force is ramped across the change. Where one thread does both, a call takes effect in the next tick.

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <span>

#include "device/safety/energy.h"
#include "device/safety/safety_filter.h"
#include "device/stylus.h"
#include "io/fields/field_source.h"
#include "modes/scene/plan.h"
#include "modes/tick/haptic_step.h"
#include "plugin/session/handover.h"
#include "plugin/session/tick_record.h"
#include "plugin/session/tick_ring.h"

namespace palpate::plugin {

/// What is felt: a scene on a scan or on one of its frames. Immutable once it is published; shared by pointer.
struct Snapshot {
  std::shared_ptr<const modes::Plan> plan;
  std::shared_ptr<const io::FieldSource> source;
  device::SafetyLimits limits;
  double change_s = 0.5;  ///< s: how long the change to it takes
};

/// The time of a tick, from the session's driver. Recorded, so that a replay can repeat it.
struct Beat {
  double time_s = 0;       ///< since the session began; ascending
  double heartbeat_s = 0;  ///< when the controlling thread was last seen alive, same clock
  std::uint32_t missed = 0, late_ns = 0;
};

class Session {
 public:
  /// Opens the stylus and asks for it to be armed. The stylus has to outlive the session. Throws what Stylus::open()
  /// throws.
  Session(std::shared_ptr<const modes::Plan> plan, std::shared_ptr<const io::FieldSource> source,
          device::Stylus& stylus, const device::SafetyLimits& limits);
  /// The same; the ring (may be null, has to outlive the session) gets every tick record.
  Session(const Snapshot& first, std::shared_ptr<device::Stylus> stylus, TickRing* ring = nullptr);
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;
  /// Zero force, stylus closed. No thread may be ticking any more.
  ~Session();

  // --- The servo. Does not allocate, free, lock, log, throw or call the system.
  const TickRecord& tick(const Beat& beat) noexcept;
  /// The same, in even steps of the first stylus' rate, by a driver that is always there.
  const TickRecord& tick() noexcept;
  /// What each primitive did in the last tick's last sub-step.
  std::span<const PrimitiveRecord> shares() const noexcept { return {shares_.data(), frame_.share_count}; }
  device::Fault fault() const noexcept { return safety_.fault; }

  // --- The controlling thread.
  /// Changes to another scene, scan, frame or workspace. One change at a time: the next begins when the one under way
  /// has ended; of several that wait, the last counts. Returns the TickRecord::scene_epoch of its ticks.
  std::uint32_t publish(const Snapshot& next);
  /// Changes to another stylus. It is opened here; the servo takes it once the force has fallen, and ramps the force up
  /// from zero. Throws what Stylus::open() throws, and the session then keeps its stylus. Null: none is held until the
  /// next. Returns the TickRecord::stylus_epoch of its ticks.
  std::uint32_t change_stylus(std::shared_ptr<device::Stylus> stylus);
  /// Whether the servo has taken the stylus of the last change_stylus().
  bool holds_stylus(std::uint32_t epoch) const noexcept {
    return stylus_epoch_.load(std::memory_order_acquire) == epoch;
  }
  void arm() noexcept { ask(command::arm, command::disarm); }
  void disarm() noexcept { ask(command::disarm, command::arm); }
  void clear_fault() noexcept { ask(command::clear_fault, 0); }
  /// Frees scenes, scans and styluses (these are closed) that the servo has left. publish() and change_stylus() do it,
  /// too.
  void collect();
  /// What its solvers hold for the tick. Not while another thread ticks.
  std::size_t solver_bytes() const noexcept;

 private:
  struct Setting;
  struct Held;

  /// Of two that contradict each other before the same tick the last counts.
  void ask(std::uint32_t wanted, std::uint32_t instead_of) noexcept {
    commands_.fetch_and(~instead_of, std::memory_order_relaxed);
    commands_.fetch_or(wanted, std::memory_order_release);
  }
  void take_commands() noexcept;
  void go_over_to_stylus() noexcept;
  void take_setting(double time) noexcept;
  modes::StepResult step(const device::Reading& reading) noexcept;
  device::SafetyLimits limits() const noexcept;
  void observe(const Beat& beat, const device::Reading& reading, const modes::StepResult& result) noexcept;

  // Across the threads.
  Handover<Setting> settings_;
  Handover<Held> styluses_;
  std::atomic<std::uint32_t> commands_{command::arm};
  std::atomic<std::uint32_t> stylus_epoch_{0};
  // Of the controlling thread.
  std::uint32_t last_setting_ = 0;
  std::uint32_t last_stylus_ = 0;
  // The servo's.
  Setting* setting_ = nullptr;
  Setting* leaving_ = nullptr;  ///< the setting that it replaces; null: settled
  double change_began_s_ = 0;
  double part_ = 1;
  Held* held_ = nullptr;
  bool exchanging_ = false;  ///< the force falls before another stylus is taken
  bool arm_again_ = false;
  bool engaged_ = false;  ///< armed, and the stylus ready
  device::SafetyState safety_;
  device::EnergyState energy_;
  modes::Touch touch_;
  std::unique_ptr<modes::StepScratch> scratch_;
  TickRecord frame_;
  std::array<PrimitiveRecord, modes::most_primitives> shares_{};
  TickRing* ring_;
  double rate_hz_;
  double ns_per_count_;
  std::uint64_t ticks_ = 0;
};

/// N/m: the scene's stiffness, but no more than the stylus renders stably.
double stiffness_for(const modes::Scene& scene, const device::Specification& stylus) noexcept;

/// The safety filter's limits for a scene on a device: never above what the device can do.
device::SafetyLimits limits_for(const modes::Limits& scene, const device::Specification& device);

/// TickRecord::safety holds both.
constexpr std::uint32_t pack_safety(device::State state, device::Fault fault) {
  return static_cast<std::uint32_t>(state) | static_cast<std::uint32_t>(fault) << 8U;
}
constexpr device::State state_of(const TickRecord& frame) {
  return static_cast<device::State>(frame.safety & 0xFFU);
}
constexpr device::Fault fault_of(const TickRecord& frame) {
  return static_cast<device::Fault>(frame.safety >> 8U);
}

}  // namespace palpate::plugin
