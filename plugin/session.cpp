#include "palpate/plugin/session.h"

#include <chrono>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

namespace palpate::plugin {
namespace {

using Clock = std::chrono::steady_clock;

void copy(const glm::dvec3& from, double (&to)[3]) {
  for (int axis = 0; axis < 3; ++axis) {
    to[axis] = from[axis];
  }
}

/// Notes how long each stage took. The clock is read, never acted upon: a replay gives the same forces.
class StageTimer {
 public:
  explicit StageTimer(Frame& frame) : frame_(frame) {}
  void finish(Stage stage) noexcept {
    const Clock::time_point now = Clock::now();
    frame_.stage_ns[static_cast<std::size_t>(stage)] =
        static_cast<std::uint32_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(now - begun_).count());
    begun_ = now;
  }

 private:
  Frame& frame_;
  Clock::time_point begun_ = Clock::now();
};

}  // namespace

device::SafetyLimits limits_for(const modes::Limits& scene, const device::Specification& device) {
  device::SafetyLimits limits;
  limits.force = scene.force_n;
  limits.device_force = device.maximum_force;
  limits.slew = scene.slew_n_per_ms * 1e3;
  limits.ramp_time = scene.ramp_s;
  limits.speed = scene.speed_m_per_s;
  return limits;
}

Session::Session(std::shared_ptr<const modes::Plan> plan, std::shared_ptr<const io::FieldSource> source,
                 device::Stylus& stylus, const device::SafetyLimits& limits)
    : plan_(std::move(plan)),
      source_(std::move(source)),
      stylus_(stylus),
      limits_(limits),
      chain_(
          {.analytical = plan_->solvers.analytical, .exact = plan_->solvers.exact, .descent = plan_->solvers.descent}),
      scratch_(std::make_unique<modes::StepScratch>()) {
  stylus_.open();
  device::arm(safety_);
}

Session::~Session() {
  stylus_.close();
}

const Frame& Session::tick() noexcept {
  StageTimer timer(frame_);
  const device::Reading reading = stylus_.read();
  timer.finish(Stage::read);

  const modes::StepResult result = modes::step(*plan_, *source_, reading.position, touch_, chain_, *scratch_);
  timer.finish(Stage::step);

  // A frame that could not be solved asks for a force that is not a number: the filter latches the fault and lets go.
  const bool solved = result.outcome == solver::Outcome::solved || result.outcome == solver::Outcome::capped;
  const glm::dvec3 asked = solved ? result.force_n : glm::dvec3(std::numeric_limits<double>::quiet_NaN());
  const device::SafetyInput input{.time = reading.time,
                                  .reading = reading,
                                  .device = stylus_.state(),
                                  .force = asked,
                                  .force_time = reading.time,
                                  .heartbeat_time = reading.time};
  const device::SafetyResult safe = device::filter_force(limits_, input, safety_);
  timer.finish(Stage::filter);

  stylus_.write_force(safe.force);
  timer.finish(Stage::write);

  frame_.index = ticks_++;
  frame_.dt_s = reading.time - last_time_;
  frame_.time_s = last_time_ = reading.time;
  copy(reading.position, frame_.probe_m);
  copy(result.proxy_m, frame_.proxy_m);
  copy(result.force_n, frame_.force_n);
  copy(safe.force, frame_.sent_n);
  const io::Sample here = source_->sample(plan_->workspace.to_patient(result.proxy_m), io::FieldSet::value);
  frame_.value = here.inside ? here.value : std::numeric_limits<double>::quiet_NaN();
  frame_.error_bound_m = result.error_bound;
  frame_.sub_steps = static_cast<std::uint32_t>(result.sub_steps);
  frame_.iterations = static_cast<std::uint32_t>(result.iterations);
  frame_.solver = static_cast<std::uint32_t>(result.solver);
  frame_.outcome = static_cast<std::uint32_t>(result.outcome);
  frame_.safety = pack_safety(safe.state, safe.fault);
  frame_.buttons = reading.buttons;
  frame_.from_brick = result.sample.from_brick ? 1 : 0;
  frame_.share_count = static_cast<std::uint32_t>(result.primitives.size());
  glm::dvec3 balance = -result.force_n;
  for (std::size_t n = 0; n < result.primitives.size(); ++n) {
    shares_[n] = {.frame = frame_.index,
                  .mode = result.mode_of[n],
                  .type = static_cast<std::uint32_t>(result.primitives[n].type),
                  .strength_n = result.primitives[n].strength};
    copy(result.shares[n], shares_[n].force_n);
    balance += result.shares[n];
  }
  frame_.residual_n = glm::length(balance);
  timer.finish(Stage::observe);
  return frame_;
}

}  // namespace palpate::plugin
