#include "device/testing/random_faults.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <glm/geometric.hpp>
#include <random>
#include <stdexcept>

#include "device/link/link_stylus.h"
#include "device/safety/guardian_watch.h"
#include "device/safety/safety_filter.h"
#include "device/testing/fake_rigs.h"

namespace palpate::device {

namespace {

constexpr double random_tick_s = 1e-3;
/// Those with motors and a link.
constexpr std::array played_kinds{"falcon", "wooden_haptics", "haply", "minverse", "touch", "force_dimension"};
constexpr double oldest_pose_s = 0.020;  // that still counts
constexpr double rounding = 1.05;        // of motors, and of a fake's kinematics against the driver's

/// The chain of one sequence.
class RandomSession {
 public:
  explicit RandomSession(std::uint64_t seed)
      : random_(seed), kind_(played_kinds[random_() % played_kinds.size()]), rig_(make_rig(kind_)) {
    link_ = dynamic_cast<LinkStylus*>(rig_.stylus.get());
    rig_.stylus->open();
  }

  std::string play() {
    run(1.1);
    arm(state_);
    for (int events = 4 + static_cast<int>(random_() % 12); events > 0 && broken_.empty(); --events) {
      befall();
      run(chance() < 0.3 ? chance() : 0.1 * chance());
    }
    return broken_.empty() ? "" : kind_ + ": " + broken_;
  }

 private:
  double chance() { return std::uniform_real_distribution<double>(0, 1)(random_); }
  Vec3 any_vector(double most) {
    const double x = chance() - 0.5, y = chance() - 0.5, z = chance() - 0.5;
    return 2 * most * Vec3(x, y, z);
  }
  void say_broken(const char* law, double found, double allowed) {
    std::array<char, 200> text{};
    std::snprintf(text.data(), text.size(), "%s: %.4f N, where %.4f N are allowed, %.4f s after the last event (%s)",
                  law, found, allowed, rig_.now() - event_time_, event_);
    if (broken_.empty()) broken_ = text.data();
  }

  void befall() {
    event_time_ = rig_.now();
    const auto cause = [](const std::function<void()>& fault) {
      if (fault) fault();
    };
    switch (random_() % 20) {
      case 0:
        return event("the servo pauses"), pause_servo();
      case 1:
        return event("the program stands still"), stand_still(chance() < 0.5 ? 0.15 : 1.2);
      case 2:
        is_reached_ = is_reached_ && !rig_.unplug;
        return event("unplugged"), cause(rig_.unplug);
      case 3:
        return event("plugged in again"), replug();
      case 4:
        if (rig_.delay) rig_.delay(chance() < 0.5 ? 0 : 0.2 * chance() * chance());
        return event("answers are late");
      case 5:
        return event("silent"), fall_silent();
      case 6:
        return event("odd packets"), cause(chance() < 0.5 ? rig_.garble : rig_.shorten);
      case 7:
        return event("the hand goes elsewhere"), fling(any_vector(chance() < 0.3 ? 4 : 0.3));
      case 8:
        return event("a scene of any limits"), any_scene();
      case 9:
        return event("the machine sleeps"), put_rigs_to_sleep(chance() < 0.1 ? 30 : 0.05);
      case 10:
        return event("opened anew"), reopen();
      case 11:
        return event("released"), disarm(state_);
      case 12:
        return event("the panel hangs"), static_cast<void>(panel_lives_ = chance() < 0.5);
      case 13:
        return event("another force"), static_cast<void>(asked_ = any_vector(chance() < 0.3 ? 1e6 : 4));
      case 14:
        return event("no number"), static_cast<void>(asked_ = Vec3(0, chance() < 0.2 ? 0.0 / 0.0 : 1, 0));
      case 15:
        rig_.pass(0.4 * chance());
        went_on_ = rig_.now();
        return event("the clock jumps");
      case 16:
        guard_died_ = rig_.now();
        rig_.guard->lives = false;
        return event("its guardian dies");
      case 17:
        rig_.guard->beat.sleep_is_near = true;
        return event("the machine is about to sleep");
      default:
        clear_fault(state_);
        arm(state_);
        latched_n_ = -1;
        return event("armed");
    }
  }
  void event(const char* name) { event_ = name; }
  void fling(const Vec3& velocity) {
    if (!rig_.fling) return;
    rig_.fling(velocity);
    // The latest known poses may still be from the previous hand.
    const double before = std::max(hand_m_per_s_, rig_.now() < slower_from_ ? faster_m_per_s_ : 0.0);
    hand_m_per_s_ = glm::length(velocity);
    faster_m_per_s_ = before;
    slower_from_ = rig_.now() + oldest_pose_s;
  }
  void any_scene() {
    if (chance() < 0.5) {
      limits_ = {};
    } else {
      limits_ = {.force = 1e9, .device_force = 1e9, .slew = 1e12, .ramp_time = 1e-9, .speed = 1e9};
    }
    asked_ = any_vector(5);
  }
  void pause_servo() {
    servo_runs_ = false;
    run(0.25 * chance());
    servo_runs_ = true;
  }
  void reopen() {
    try {
      rig_.stylus->close();
      rig_.guard->lives = true;
      rig_.stylus->open();
      clear_fault(state_);
      latched_n_ = -1;
    } catch (const std::exception&) {
      // Gone: it stays closed until it is plugged in again.
    }
    last_force_ = rig_.force();
  }
  void fall_silent() {
    if (chance() >= 0.2 || !rig_.silence) return;
    rig_.silence();
    is_deaf_ = true;
    is_reached_ = false;
  }
  void replug() {
    if (!rig_.replug) return;
    rig_.replug();
    is_reached_ = !is_deaf_;
    reopen();
  }

  void stand_still(double seconds) {
    if (link_ == nullptr) return;
    stands_still_ = true;
    for (double passed = 0; passed < seconds; passed += random_tick_s) {
      rig_.pass(random_tick_s);
      const bool looks = static_cast<int>(passed / random_tick_s) % GuardianWatch::look_every_ms == 0;
      if (looks && watch_.stopped() && rig_.guardian) rig_.guardian();
      look_at_device();
    }
    stands_still_ = false;
    went_on_ = rig_.now();
    // No guardian takes a force away from a device that is unplugged or deaf: it tries until the device is back.
    const bool can_take = rig_.guardian && !rig_.guardian_looks_on && is_reached_ && seconds > 0.3;
    if (can_take && glm::length(rig_.force()) > 0)
      say_broken("a force stays while the program stands still", glm::length(rig_.force()), 0);
  }

  void run(double seconds) {
    // Devices that are gone return at once: not all of them let time go by.
    for (int n = 0; n < static_cast<int>(seconds / 0.2e-3) && broken_.empty(); ++n) {
      const double before = rig_.now();
      rig_.exchange();
      if (rig_.now() == before) rig_.pass(random_tick_s);
      if (link_ != nullptr && link_->state() != State::disconnected && link_->fault() != LinkFault::unplugged) {
        beat_.on_device = link_->on_device();
        ++beat_.count;
      }
      if (servo_runs_ && rig_.now() >= next_tick_) tick();
      look_at_device();
    }
  }
  void tick() {
    next_tick_ = rig_.now() + random_tick_s - 1e-9;
    SafetyInput input{
        .time = rig_.now(), .reading = rig_.stylus->read(), .device = rig_.stylus->state(), .force = asked_};
    input.force_time = input.time;
    input.heartbeat_time = panel_time_ = panel_lives_ ? input.time : panel_time_;
    const SafetyResult result = filter_force(limits_, input, state_);
    rig_.stylus->write_force(result.force);
    if (result.fault != Fault::none && latched_n_ < 0) {
      // A command in transit exceeds the present force by at most a step.
      latched_n_ = std::max({glm::length(rig_.force()), glm::length(last_force_), glm::length(result.force)});
      latched_at_ = rig_.now();
    }
  }

  /// Upper bound, N: the motors get torques for the latest known pose, which may be as old as the oldest valid answer.
  /// If a fast hand has moved on since, the arm turns them into another force.
  double turned_by_the_arm(const Vec3& force) const {
    constexpr double shortest_arm_m = 0.04;
    const double fastest = std::max(hand_m_per_s_, rig_.now() < slower_from_ ? faster_m_per_s_ : 0.0);
    return glm::length(force) * std::min(1.0, fastest * oldest_pose_s / shortest_arm_m);
  }

  void look_at_device() {
    const Vec3 force = rig_.force();
    const double length = glm::length(force);
    const double most = std::min(rig_.stylus->specification().maximum_force, ceiling::force_n) * rounding;
    if (length > most) say_broken("a force above the ceiling", length, most);
    const double step = length > 0 ? glm::length(force - last_force_) : 0;
    const double slew = ceiling::slew_n_per_s * ceiling::slew_time_s * rounding + turned_by_the_arm(force);
    if (step > slew) say_broken("a step above the slew ceiling", step, slew);
    const double grown = latched_n_ * rounding + 1e-6;
    if (latched_n_ >= 0 && rig_.now() - latched_at_ > 0.004 && length > grown) {
      say_broken("a force that grows after a fault", length, grown);
    }
    // Only a program that runs can miss its guardian. One that stood still sees it at its next exchanges.
    const bool is_unguarded = !stands_still_ && !rig_.guard->lives && rig_.now() - went_on_ > 0.1 &&
                              rig_.now() - guard_died_ > ceiling::guardian_s + 0.1;
    const bool is_seen = link_->state() != State::disconnected && link_->fault() != LinkFault::unplugged &&
                         link_->fault() != LinkFault::silent && link_->on_device() == OnDevice::pushing;
    if (is_unguarded && is_seen && length > 0) say_broken("a force without a guardian", length, 0);
    const bool claims_zero = link_ != nullptr && link_->on_device() == OnDevice::zero_taken;
    if (claims_zero && length > 0) say_broken("a force where a zero counts as taken", length, 0);
    last_force_ = force;
  }

  std::mt19937_64 random_;
  std::string kind_;
  FakeRig rig_;
  LinkStylus* link_ = nullptr;
  SafetyLimits limits_;
  SafetyState state_;
  GuardianBeat beat_;
  GuardianWatch watch_{&beat_};
  Vec3 asked_{0, 2.5, 0}, last_force_{0};
  double hand_m_per_s_ = 0;                      // that it was flung at last
  double faster_m_per_s_ = 0, slower_from_ = 0;  // before that
  bool servo_runs_ = true, panel_lives_ = true;
  bool is_reached_ = true, is_deaf_ = false, stands_still_ = false;
  double guard_died_ = 0, went_on_ = 0;
  double next_tick_ = 0, panel_time_ = 0, event_time_ = 0;
  double latched_n_ = -1, latched_at_ = 0;
  const char* event_ = "none";
  std::string broken_;
};

}  // namespace

std::string play_random_faults(std::uint64_t seed) {
  return RandomSession(seed).play();
}

}  // namespace palpate::device
