#pragma once

/// The Stylus implementation that drivers share: a thread of its own drives the device, and the servo tick only swaps
/// values with it, wait-free. The thread is also the first watchdog: a force that is not renewed becomes zero there. It
/// is the last layer before the device (given_force.h).

#include <atomic>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <thread>

#include "device/axis_signs.h"
#include "device/link/driver.h"
#include "device/link/given_force.h"
#include "device/link/latest.h"
#include "device/link/packet_driver.h"
#include "device/link/realtime.h"
#include "device/safety/guardian.h"
#include "device/safety/stay_awake.h"
#include "device/safety/sustained.h"
#include "device/stylus.h"

namespace palpate::device {

struct LinkStylusOptions {
  bool threaded = true;                          ///< false: the owner of the stylus calls service()
  double force_age = ceiling::link_force_age_s;  ///< s: a force that write_force() does not renew becomes zero
  int priority = 60;  ///< of SCHED_FIFO, above the servo's; not used if the system forbids it
  GuardianSettings guardian;
  /// Starts the guardian: the process, or a fake in a test.
  std::function<std::unique_ptr<Guardian>(const GuardianSettings&)> start_guardian = device::start_guardian;
  double guardian_patience = Guardian::patience_s;  ///< s: within this time the guardian has to send its proof
  AxisSigns signs;
  bool stays_awake = false;                   ///< the machine is asked not to sleep while the stylus is open
  double (*asleep)() noexcept = time_asleep;  ///< s that the machine has slept: a jump is a fault
};

class LinkStylus final : public Stylus {
 public:
  using LinkMaker = device::LinkMaker;

  LinkStylus(Specification specification, std::unique_ptr<Driver> driver, const LinkStylusOptions& options = {});
  LinkStylus(Specification specification, std::unique_ptr<Protocol> protocol, LinkMaker make_link,
             const LinkStylusOptions& options = {});
  ~LinkStylus() override;

  /// The specification of the kind of device; after open(), of the device that was opened.
  Specification specification() const override { return specification_; }
  void open() override;
  void close() noexcept override;
  Reading read() noexcept override;
  void write_force(const Vec3& force) noexcept override;
  /// Homing until the first pose after open(). If it is idle, read() has a pose of this opening from then on.
  State state() const noexcept override { return state_.load(std::memory_order_acquire); }

  Text trouble() const override { return advice_for(fault()); }

  double allowed_force() const noexcept override { return allowed_force_.load(std::memory_order_relaxed); }
  std::optional<ForceOnDevice> force_on_device() const noexcept override {
    return ForceOnDevice{told_on_device_.load(std::memory_order_relaxed), told_force_.load(std::memory_order_relaxed),
                         is_held_back_.load(std::memory_order_relaxed)};
  }

  LinkFault fault() const noexcept { return fault_.load(std::memory_order_relaxed); }
  /// For the exchanging thread. After close() it is the last state of the device.
  OnDevice on_device() const noexcept { return given_.on_device(); }
  /// One exchange, waiting for packets at most `timeout` s. Only without a thread.
  void service(double timeout) noexcept;

 private:
  void run() noexcept;
  void exchange(double timeout, bool closing) noexcept;
  void judge_rate(double now) noexcept;
  void judge_clocks(double now) noexcept;
  void judge_guardian(double now) noexcept;
  void connect();
  void give(double now, bool closing) noexcept;
  bool withholds(double now, bool closing) const noexcept;
  bool takes_nothing(double now) const noexcept;
  void fail(LinkFault fault) noexcept;
  void tell_force() noexcept;
  void send_zeros() noexcept;
  bool may_push_on() const noexcept;
  State told_state() const noexcept;

  Specification specification_;
  std::unique_ptr<Driver> driver_;
  LinkStylusOptions options_;
  std::unique_ptr<Guardian> guardian_;
  std::unique_ptr<StayAwake> awake_;
  bool connected_ = false;
  std::thread thread_;
  std::atomic<bool> stop_{false};
  std::atomic<State> state_{State::disconnected};
  std::atomic<LinkFault> fault_{LinkFault::none};

  // Across the threads.
  Latest<Reading> reading_;
  Latest<Vec3> force_;
  std::atomic<double> allowed_force_{std::numeric_limits<double>::infinity()};  // N, by the motors' heat
  std::atomic<OnDevice> told_on_device_{OnDevice::unknown};
  std::atomic<double> told_force_{0};  // N: its length
  std::atomic<bool> is_held_back_{false};
  // The exchanging thread's.
  double opened_ = 0;
  double exchange_time_ = 0;
  double asleep_ = 0;
  double force_time_ = 0;
  double news_time_ = 0;
  std::uint64_t news_ = 0;
  bool has_pose_ = false;  // since it was opened
  double window_start_ = 0;
  std::uint64_t window_news_ = 0;
  Vec3 wanted_{0};          // N: the newest force asked for
  double taken_force_ = 0;  // N: the length of the last one taken
  bool loss_told_ = false;  // to the guardian
  MissedGuardian missed_guardian_;
  SustainedLoad load_;
  GivenForce given_;
  // The servo's.
  Reading last_reading_;
};

}  // namespace palpate::device
