#pragma once

/// Connects a scan, a scene and a stylus. Each tick reads the pose, steps the balance, filters the force, writes it,
/// and leaves a tick record.
///
/// Two threads meet here. The servo calls tick() and shares(). All other functions are called from one controlling
/// thread at a time (the panel's or the command line's). Scenes, scans, frames and styluses are replaced whole, between
/// two ticks; the force is ramped across the change. If one thread does both, a call takes effect in the next tick.

#include <array>
#include <atomic>
#include <cstdint>
#include <glm/gtc/quaternion.hpp>
#include <memory>
#include <span>
#include <vector>

#include "device/link/latest.h"
#include "device/safety/energy.h"
#include "device/safety/fault_log.h"
#include "device/safety/safety_filter.h"
#include "device/stylus.h"
#include "io/fields/field_source.h"
#include "modes/scene/plan.h"
#include "modes/tick/haptic_step.h"
#include "plugin/session/felt_limits.h"
#include "plugin/session/handover.h"
#include "plugin/session/open_stylus.h"
#include "plugin/session/tick_record.h"
#include "plugin/session/tick_ring.h"

namespace palpate::plugin {

class SampledOnce;

/// A scene on a scan or on one of its frames. Immutable once it is published; shared by pointer.
struct Snapshot {
  std::shared_ptr<const modes::Plan> plan;
  std::shared_ptr<const io::FieldSource> source;
  device::SafetyLimits limits;
  double change_s = 0.5;  ///< s: how long the change to it takes, if it keeps the workspace
  /// Of a recording: comes as it was recorded, under a force too.
  bool is_replayed = false;
};

/// The time of a tick, from the session's driver. Recorded, so that a replay can repeat it.
struct Beat {
  double time_s = 0;       ///< since the session began; ascending
  double heartbeat_s = 0;  ///< when the controlling thread was last seen alive, same clock
  std::uint32_t missed = 0, late_ns = 0;
};

class Session {
 public:
  /// Opens the stylus and asks for it to be armed. The stylus must outlive the session. Throws what Stylus::open()
  /// throws.
  Session(std::shared_ptr<const modes::Plan> plan, std::shared_ptr<const io::FieldSource> source,
          device::Stylus& stylus, const device::SafetyLimits& limits);
  /// The same. The ring gets every tick record; it may be null, and must outlive the session.
  Session(const Snapshot& first, std::shared_ptr<device::Stylus> stylus, TickRing* ring = nullptr);
  /// The same with a stylus that is already open.
  Session(const Snapshot& first, OpenStylus stylus, TickRing* ring);
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;
  /// Sends zero force and closes the stylus. No thread may still call tick().
  ~Session();

  // --- The servo. Does not allocate, free, lock, log, throw or call the system.
  const TickRecord& tick(const Beat& beat) noexcept;
  /// The same, in even steps of the first stylus' rate, with a heartbeat in every tick.
  const TickRecord& tick() noexcept;
  /// The force of each primitive in the last tick's last sub-step.
  std::span<const PrimitiveRecord> shares() const noexcept { return {shares_.data(), tick_.share_count}; }
  device::Fault fault() const noexcept { return safety_.fault; }

  // --- The controlling thread.
  /// Changes to another scene, scan, frame or workspace. One change runs at a time: the next begins when the current
  /// one has ended. If several wait, only the last is made. Another workspace moves the stylus through the patient: the
  /// force falls to zero, the workspace comes at once, and the force is ramped up again if the session is still armed.
  /// Returns the TickRecord::scene_epoch of its ticks.
  std::uint32_t publish(const Snapshot& next);
  /// Changes to another stylus. It is opened here. The servo takes it when the force has fallen to zero, and ramps the
  /// force up again. Throws what Stylus::open() throws; the session then keeps its stylus. Null: no stylus is held
  /// until the next call. Returns the TickRecord::stylus_epoch of its ticks.
  std::uint32_t change_stylus(std::shared_ptr<device::Stylus> stylus);
  /// Whether the servo has taken the stylus of the last change_stylus().
  bool holds_stylus(std::uint32_t epoch) const noexcept {
    return stylus_epoch_.load(std::memory_order_acquire) == epoch;
  }
  void arm() noexcept { ask(command::arm, command::disarm); }
  void disarm() noexcept { ask(command::disarm, command::arm); }
  void clear_fault() noexcept { ask(command::clear_fault, 0); }
  /// Holds buttons down from the next tick on, in addition to those of the stylus (TickRecord::buttons has both). 0:
  /// none.
  void press(std::uint32_t buttons) noexcept { pressed_.store(buttons, std::memory_order_relaxed); }
  /// Input and output of the safety filter in the second before the last fault and in the tenth of a second after it,
  /// oldest first. Empty before the first fault. collect() updates it.
  const std::vector<device::SafetyTick>& fault_ticks() const noexcept { return fault_ticks_; }
  /// The orientation of the stylus, device frame; the identity if it does not measure any. For display only: no torque
  /// is ever sent.
  const glm::dquat& orientation() noexcept { return orientation_.load(); }
  /// How many faults collect() has found.
  int faults() const noexcept { return faults_; }
  /// Frees the scenes, scans and styluses that the servo no longer uses (styluses are closed), and takes over what the
  /// servo recorded of a fault. publish() and change_stylus() call it too.
  void collect();
  /// Bytes that the solvers hold for the tick. Not to be called while another thread ticks.
  std::size_t solver_bytes() const noexcept;

 private:
  struct Setting;
  struct Held;

  /// If two commands before the same tick contradict each other, the last one counts.
  void ask(std::uint32_t wanted, std::uint32_t instead_of) noexcept {
    commands_.fetch_and(~instead_of, std::memory_order_relaxed);
    commands_.fetch_or(wanted, std::memory_order_release);
  }
  void take_commands() noexcept;
  /// Disarms until a stylus or a workspace has been taken; then what was armed, or is to be armed, is armed again.
  void let_force_fall() noexcept;
  void go_over_to_stylus() noexcept;
  void go_over_to_coming(double time) noexcept;
  void take_setting(double time) noexcept;
  modes::StepResult step(const device::Reading& reading) noexcept;
  device::SafetyLimits limits() const noexcept;
  void observe(const Beat& beat, const device::Reading& reading, const modes::StepResult& result) noexcept;

  // Across the threads.
  Handover<Setting> settings_;
  Handover<Held> styluses_;
  std::atomic<std::uint32_t> commands_{command::arm};
  std::atomic<std::uint32_t> stylus_epoch_{0};
  std::atomic<std::uint32_t> pressed_{0};
  device::Latest<glm::dquat> orientation_{glm::dquat(1, 0, 0, 0)};
  // Of the controlling thread.
  std::shared_ptr<const SampledOnce> sampled_;  ///< of the last snapshot published; only the servo samples it
  std::uint32_t last_setting_ = 0;
  std::uint32_t last_stylus_ = 0;
  std::vector<device::SafetyTick> fault_ticks_;
  int faults_ = 0;
  // The servo's.
  Setting* setting_ = nullptr;
  Setting* leaving_ = nullptr;  ///< the setting that it replaces; null: the change is complete
  Setting* coming_ = nullptr;   ///< has another workspace: waits until there is no force
  double change_began_s_ = 0, change_s_ = 0;
  double part_ = 1;
  Held* held_ = nullptr;
  bool exchanging_ = false;  ///< the force falls before another stylus is taken
  bool arm_again_ = false;
  bool engaged_ = false;  ///< armed, and the stylus ready
  device::SafetyState safety_;
  std::unique_ptr<device::FaultLog> fault_log_;
  device::EnergyState energy_;
  modes::Touch touch_;
  std::unique_ptr<modes::StepScratch> scratch_;
  TickRecord tick_;
  std::array<PrimitiveRecord, modes::most_primitives> shares_{};
  TickRing* ring_;
  double rate_hz_;
  double ns_per_count_;
  std::uint64_t ticks_ = 0;
};

/// TickRecord::safety holds both.
constexpr std::uint32_t pack_safety(device::State state, device::Fault fault) {
  return static_cast<std::uint32_t>(state) | static_cast<std::uint32_t>(fault) << 8U;
}
constexpr device::State state_of(const TickRecord& tick) {
  return static_cast<device::State>(tick.safety & 0xFFU);
}
constexpr device::Fault fault_of(const TickRecord& tick) {
  return static_cast<device::Fault>(tick.safety >> 8U);
}

}  // namespace palpate::plugin
