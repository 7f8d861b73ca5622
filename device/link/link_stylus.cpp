#include "device/link/link_stylus.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "device/messages.h"
#include "device/vectors.h"

namespace palpate::device {

const char* name_of(LinkFault fault) {
  switch (fault) {
    case LinkFault::none:
      return "none";
    case LinkFault::unplugged:
      return "unplugged";
    case LinkFault::silent:
      return "silent";
    case LinkFault::slow:
      return "too slow to push safely";
    case LinkFault::unreachable_pose:
      return "unreachable pose";
    case LinkFault::unhomed:
      return "lost its home";
    case LinkFault::held_up:
      return "the program was stopped or held up";
    case LinkFault::slept:
      return "the machine slept";
    case LinkFault::forces_refused:
      return "it does not take forces";
    case LinkFault::own_safety:
      return "its own safety took the force away";
    case LinkFault::foreign_force:
      return "another program pushes it, too";
    case LinkFault::unguarded:
      return "its guardian is gone";
  }
  return "unknown";
}

Text advice_for(LinkFault fault) {
  switch (fault) {
    case LinkFault::none:
      return {};
    case LinkFault::unplugged:
      return say("link-unplugged");
    case LinkFault::silent:
      return say("link-silent");
    case LinkFault::slow:
      return say("link-slow");
    case LinkFault::unreachable_pose:
      return say("link-unreachable-pose");
    case LinkFault::unhomed:
      return say("link-unhomed");
    case LinkFault::held_up:
      return say("link-held-up");
    case LinkFault::slept:
      return say("link-slept");
    case LinkFault::forces_refused:
      return say("link-forces-refused");
    case LinkFault::own_safety:
      return say("link-own-safety");
    case LinkFault::foreign_force:
      return say("link-foreign-force");
    case LinkFault::unguarded:
      return say("link-unguarded");
  }
  return {};
}

namespace {

// At a period of 8 ms and a delay of as much, the linear bound of stiffness.h lies below a wall of 400 N/m.
constexpr double rate_window = 0.25;  // s
constexpr std::uint64_t fewest_in_window = 30;
// s between two exchanges: longer, and this process was stopped. The guardian waits as long before it takes the force
// away, so a session that goes on after that is in this fault.
constexpr double longest_gap = 0.2;
constexpr double shortest_sleep = 0.1;  // s: of a machine that was suspended
constexpr double zeros_time = 0.050;    // s: in which a device that is closed takes a zero, or its guardian is to

}  // namespace

LinkStylus::LinkStylus(Specification specification, std::unique_ptr<Driver> driver, const LinkStylusOptions& options)
    : specification_(std::move(specification)), driver_(std::move(driver)), options_(options) {}

LinkStylus::LinkStylus(Specification specification, std::unique_ptr<Protocol> protocol, LinkMaker make_link,
                       const LinkStylusOptions& options)
    : LinkStylus(std::move(specification), std::make_unique<PacketDriver>(std::move(protocol), std::move(make_link)),
                 options) {}

LinkStylus::~LinkStylus() {
  close();
}

void LinkStylus::open() {
  close();
  // The guardian first: from the moment when a force can be sent, somebody can take it back.
  guardian_ = options_.start_guardian(options_.guardian);
  try {
    connect();
  } catch (...) {
    guardian_.reset();
    throw;
  }
  connected_ = true;
  driver_->describe(specification_);
  specification_.guardian = guardian_ ? guardian_->describe() : Text();
  if (options_.stays_awake) awake_ = stay_awake(specification_.name + " is held");
  if (guardian_) missed_guardian_.start(guardian_->shared().lives, driver_->now());
  opened_ = exchange_time_ = news_time_ = window_start_ = driver_->now();
  asleep_ = options_.asleep();
  news_ = window_news_ = driver_->status().news;
  load_ = {};
  loss_told_ = false;
  given_.start(opened_);
  taken_force_ = 0;
  told_force_.store(0, std::memory_order_relaxed);
  tell_force();
  force_.store(Vec3(0));
  wanted_ = force_.load();
  reading_.store({});
  has_pose_ = false;
  fault_.store(LinkFault::none, std::memory_order_relaxed);
  state_.store(told_state(), std::memory_order_release);
  if (!options_.threaded) return;
  stop_.store(false, std::memory_order_relaxed);
  thread_ = std::thread([this] { run(); });
}

void LinkStylus::connect() {
  if (guardian_) guardian_->prove(options_.guardian_patience);
  // While it was open, or closed: a machine that sleeps may switch the device's power off.
  if (options_.asleep() - asleep_ > shortest_sleep) driver_->forget_home();
  driver_->connect();
  if (!guardian_) return;
  try {
    guardian_->reach(options_.guardian_patience);
  } catch (...) {
    driver_->disconnect();
    throw;
  }
}

void LinkStylus::run() noexcept {
  make_thread_realtime(options_.priority);
  while (!stop_.load(std::memory_order_relaxed)) {
    if (driver_->lost()) {
      // Nothing to wait for any more: a link that is gone returns at once.
      exchange(0, false);
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    } else {
      exchange(1e-3, false);
    }
  }
}

void LinkStylus::close() noexcept {
  if (!connected_) return;
  if (thread_.joinable()) {
    stop_.store(true, std::memory_order_relaxed);
    thread_.join();
  }
  send_zeros();
  driver_->disconnect();
  connected_ = false;
  if (guardian_) may_push_on() ? guardian_->hand_over() : guardian_->dismiss();
  guardian_.reset();
  awake_.reset();
  state_.store(State::disconnected, std::memory_order_relaxed);
}

void LinkStylus::send_zeros() noexcept {
  const double start = driver_->now();
  bool waits = true;
  while (waits && !driver_->lost() && driver_->now() - start < zeros_time) {
    exchange(1e-3, true);
    waits = may_push_on();
  }
  driver_->flush(0.020);
}

bool LinkStylus::may_push_on() const noexcept {
  return specification_.force_axes > 0 && given_.on_device() != OnDevice::zero_taken;
}

void LinkStylus::service(double timeout) noexcept {
  if (connected_ && !options_.threaded) exchange(timeout, false);
}

void LinkStylus::exchange(double timeout, bool closing) noexcept {
  driver_->take(timeout);
  const double now = driver_->now();
  const ProtocolStatus& status = driver_->status();
  if (driver_->lost()) {
    fail(LinkFault::unplugged);
    given_.doubt();
    tell_force();
    // After this one there is no beat: a guardian that sees a force stand still takes it away when the device is back.
    if (guardian_ && !loss_told_) guardian_->beat(given_.on_device());
    loss_told_ = true;
    // A device whose poses fail may still take forces, and hold its last one. One that is gone refuses the zero.
    if (may_push_on()) driver_->give(Vec3(0));
    return;
  }
  judge_clocks(now);  // before the device: what this process slept through is not its fault
  if (status.news != news_) {
    news_ = status.news;
    news_time_ = now;
    has_pose_ = true;
    reading_.store(
        {now - opened_, options_.signs.position * status.position, status.buttons, true, status.orientation});
  }
  if (status.state == State::fault) fail(status.fault);
  if (now - news_time_ > driver_->longest_silence()) {
    fail(LinkFault::silent);
    given_.doubt();
    driver_->forget_home();
  }
  judge_rate(now);
  judge_guardian(now);

  give(now, closing);
  exchange_time_ = now;
  if (fault() == LinkFault::none) state_.store(told_state(), std::memory_order_release);
}

State LinkStylus::told_state() const noexcept {
  // A driver may know its home, and so be idle, before a pose has come: nobody knows yet where the hand is.
  const State state = driver_->status().state;
  return state == State::idle && !has_pose_ ? State::homing : state;
}

bool LinkStylus::withholds(double now, bool closing) const noexcept {
  return closing || fault() != LinkFault::none || now - force_time_ > options_.force_age;
}

void LinkStylus::give(double now, bool closing) noexcept {
  const std::uint64_t news = driver_->status().news;
  // With a doubtful pose no new force is taken: the last one stays until it is too old.
  if (!driver_->status().doubtful) {
    if (force_.has_news()) force_time_ = now;
    wanted_ = force_.load();
  }
  const SustainedLimit limit{specification_.continuous_force, specification_.maximum_force};
  const double allowed = load_.allowed(limit);
  allowed_force_.store(allowed, std::memory_order_relaxed);
  const Vec3 force = given_.next(clamp_length(wanted_, allowed), withholds(now, closing), now);
  load_.add(limit, glm::length(force), now - exchange_time_);
  // Before the force is given: a program that is stopped in between is one that pushes.
  const OnDevice on_device = given_.while_giving(force, news);
  if (guardian_) guardian_->beat(on_device);
  const ForceAnswer answer = driver_->give(options_.signs.force * force);
  given_.answered(answer, force, news, now);
  // A device that takes nothing may have its last force still, however often it was offered a zero.
  if (answer == ForceAnswer::taken || answer == ForceAnswer::withheld) {
    taken_force_ = std::min(glm::length(given_.given()), driver_->status().most_force);
  }
  tell_force();
  if (specification_.force_axes > 0 && takes_nothing(now)) fail(LinkFault::forces_refused);
}

void LinkStylus::tell_force() noexcept {
  const OnDevice on_device = may_push_on() ? given_.on_device() : OnDevice::zero_taken;
  told_on_device_.store(on_device, std::memory_order_relaxed);
  if (on_device != OnDevice::unknown) told_force_.store(taken_force_, std::memory_order_relaxed);
  const bool is_on_trial = glm::length(given_.given()) > driver_->status().most_force;
  is_held_back_.store(given_.is_held_back() || is_on_trial, std::memory_order_relaxed);
}

bool LinkStylus::takes_nothing(double now) const noexcept {
  // A driver may wait for a lost answer (LockStep), but not for as long as that. A link on which every write fails
  // waits for ever, and the device holds its last force.
  return given_.refused_for(now) > ceiling::refusal_s || given_.untaken_for(now) > ceiling::stall_s;
}

void LinkStylus::judge_rate(double now) noexcept {
  if (now - window_start_ < rate_window) return;
  if (state() == State::idle && news_ - window_news_ < fewest_in_window) fail(LinkFault::slow);
  window_start_ = now;
  window_news_ = news_;
}

void LinkStylus::judge_clocks(double now) noexcept {
  // Whoever was stopped (Ctrl-Z, a debugger) or slept does not know where the hand is now: nothing is pushed again
  // before the user opens the device anew.
  if (now - exchange_time_ > longest_gap) fail(LinkFault::held_up);
  if (options_.asleep() - asleep_ > shortest_sleep) fail(LinkFault::slept);
}

void LinkStylus::judge_guardian(double now) noexcept {
  if (!guardian_) return;
  const GuardianBeat& shared = guardian_->shared();
  if (missed_guardian_.silent_for(shared.lives.load(std::memory_order_relaxed), now) > ceiling::guardian_s) {
    fail(LinkFault::unguarded);
  }
  if (shared.sleep_is_near.load(std::memory_order_relaxed)) fail(LinkFault::slept);
}

void LinkStylus::fail(LinkFault fault) noexcept {
  if (this->fault() != LinkFault::none) return;
  fault_.store(fault, std::memory_order_relaxed);
  state_.store(State::fault, std::memory_order_relaxed);
}

Reading LinkStylus::read() noexcept {
  const bool news = reading_.has_news();
  last_reading_ = reading_.load();
  last_reading_.fresh = news && last_reading_.fresh;
  return last_reading_;
}

void LinkStylus::write_force(const Vec3& force) noexcept {
  force_.store(is_finite(force) ? force : Vec3(0));
}

}  // namespace palpate::device
