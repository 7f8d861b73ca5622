#include "device/simulated/simulated_stylus.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "device/messages.h"
#include "device/safety/stiffness.h"
#include "device/vectors.h"

namespace palpate::device {

namespace {

constexpr double longest_step = 50e-6;  // s: the contact of a 6 kN/m wall is resolved 30 times a period

void require(bool holds, const Text& what) {
  if (!holds) throw InvalidInput(at_place("simulated stylus", what));
}

const SimulatedDevice& checked(const SimulatedDevice& device) {
  require(device.arm.mass > 0 && device.hand.mass >= 0, say("masses-must-be-above-zero"));
  require(device.arm.coulomb_friction >= 0 && device.arm.viscous_friction >= 0, say("friction-must-not-be-negative"));
  require(device.hand.stiffness >= 0 && device.hand.damping >= 0, say("hand-spring-and-damper-must-not"));
  require(device.position_step >= 0, say("position-steps-must-not-be-negative"));
  require(device.rate >= 100 && device.rate <= 20000, say("rate-must-lie-between-100"));
  require(device.delay >= 0 && device.delay * device.rate <= 60, say("delay-must-lie-between-0"));
  require(device.maximum_force > 0 && device.target_speed > 0, say("maximum-force-and-target-speed-must"));
  return device;
}

Vec3 in_steps(const Vec3& position, double step) {
  if (step == 0) return position;
  return {std::round(position.x / step) * step, std::round(position.y / step) * step,
          std::round(position.z / step) * step};
}

}  // namespace

SimulatedStylus::SimulatedStylus(const SimulatedDevice& device)
    : device_(checked(device)),
      tremor_(device.hand),
      steps_per_tick_(static_cast<std::int64_t>(std::ceil(1 / (device.rate * longest_step) - 1e-9))),
      delay_steps_(std::llround(device.delay * device.rate * static_cast<double>(steps_per_tick_))) {}

void SimulatedStylus::follow(std::span<const Waypoint> path, PathInterpolation interpolation) {
  check_path(path);
  path_.assign(path.begin(), path.end());
  interpolation_ = interpolation;
}

void SimulatedStylus::move_target(const Vec3& target, std::uint32_t buttons) noexcept {
  if (is_finite(target)) live_target_.store({target, buttons, true});
}

Specification SimulatedStylus::specification() const {
  Specification specification;
  specification.name = "simulated";
  specification.workspace_half_extent = device_.arm.half_extent;
  specification.position_resolution = device_.position_step;
  specification.maximum_force = device_.maximum_force;
  specification.continuous_force = device_.continuous_force;
  specification.stiffness_limit =
      stiffness_bounds({device_.arm.viscous_friction, device_.hand.damping, device_.arm.coulomb_friction,
                        device_.position_step, 1 / device_.rate, device_.delay})
          .advised;
  specification.rate = device_.rate;
  return specification;
}

void SimulatedStylus::open() {
  if (fault_.load(std::memory_order_relaxed) == SimulatedFault::unplugged) {
    throw Refusal(say("simulated-stylus-unplugged"));
  }
  tick_ = 0;
  read_tick_ = -1;
  forces_.fill(Vec3(0));
  acting_force_ = Vec3(0);
  const LiveTarget& live = live_target_.load();
  const Waypoint start = path_.empty() ? Waypoint{} : path_.front();
  intended_ = live.given ? live.position : start.position;
  buttons_ = live.given ? live.buttons : start.buttons;
  target_ = intended_ + tremor_(0);
  body_ = {glm::clamp(intended_, -device_.arm.half_extent, device_.arm.half_extent), Vec3(0)};
  last_reading_ = {};
  state_.store(State::idle, std::memory_order_relaxed);
}

void SimulatedStylus::close() noexcept {
  acting_force_ = Vec3(0);
  state_.store(State::disconnected, std::memory_order_relaxed);
}

Reading SimulatedStylus::read() noexcept {
  if (state() == State::disconnected) return last_reading_;
  const SimulatedFault fault = fault_.load(std::memory_order_relaxed);
  if (fault == SimulatedFault::unplugged) state_.store(State::fault, std::memory_order_relaxed);
  if (state() == State::fault || fault == SimulatedFault::stalled) {
    last_reading_.fresh = false;
    return last_reading_;
  }
  last_reading_ = {time(), in_steps(body_.position, device_.position_step), buttons_, read_tick_ != tick_};
  if (fault == SimulatedFault::not_a_number) {
    last_reading_.position = Vec3(std::numeric_limits<double>::quiet_NaN());
  }
  read_tick_ = tick_;
  return last_reading_;
}

void SimulatedStylus::write_force(const Vec3& force) noexcept {
  if (state() == State::disconnected) return;
  const SimulatedFault fault = fault_.load(std::memory_order_relaxed);
  const auto slots = static_cast<std::int64_t>(forces_.size());
  Vec3& slot = forces_[static_cast<std::size_t>(tick_ % slots)];
  if (state() == State::fault || fault == SimulatedFault::unplugged || !is_finite(force)) {
    forces_.fill(Vec3(0));
  } else if (fault == SimulatedFault::stalled) {
    slot = forces_[static_cast<std::size_t>((tick_ + slots - 1) % slots)];
  } else {
    slot = clamp_length(force, device_.maximum_force);
  }

  const double step = 1 / (device_.rate * static_cast<double>(steps_per_tick_));
  const double start = time();
  const Vec3 old_target = target_;
  aim(start + 1 / device_.rate);
  const Vec3 target_velocity = (target_ - old_target) * device_.rate;
  for (std::int64_t i = 0; i < steps_per_tick_; ++i) {
    // Which tick's force arrives at the arm in this sub-step.
    const std::int64_t arrived = tick_ * steps_per_tick_ + i - delay_steps_;
    acting_force_ = arrived < 0 ? Vec3(0) : forces_[static_cast<std::size_t>(arrived / steps_per_tick_ % slots)];
    const double share = static_cast<double>(i + 1) / static_cast<double>(steps_per_tick_);
    step_body(device_.arm, device_.hand, acting_force_, old_target + share * (target_ - old_target), target_velocity,
              step, body_);
  }
  ++tick_;
}

void SimulatedStylus::aim(double time) noexcept {
  const LiveTarget& live = live_target_.load();
  if (live.given) {
    intended_ += clamp_length(live.position - intended_, device_.target_speed / device_.rate);
    buttons_ = live.buttons;
  } else if (!path_.empty()) {
    const Waypoint point = point_on(path_, interpolation_, time);
    intended_ = point.position;
    buttons_ = point.buttons;
  }
  target_ = intended_ + tremor_(time);
}

}  // namespace palpate::device
