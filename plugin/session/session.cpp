#include "plugin/session/session.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

#include "plugin/session/sampled_once.h"
#include "solver/chain.h"
#include "solver/exact.h"

namespace palpate::plugin {
namespace {

static_assert(distance_count == io::most_structures);

void copy(const glm::dvec3& from, double (&to)[3]) {
  for (int axis = 0; axis < 3; ++axis) {
    to[axis] = from[axis];
  }
}

bool can_push(device::State state) {
  return state == device::State::idle || state == device::State::ramping || state == device::State::active;
}

/// Between two styluses: nothing is held, and nothing can be pushed.
class NoStylus final : public device::Stylus {
 public:
  device::Specification specification() const override { return {.name = "none"}; }
  void open() override {}
  void close() noexcept override {}
  device::Reading read() noexcept override { return {}; }
  void write_force(const device::Vec3& /*force*/) noexcept override {}
  device::State state() const noexcept override { return device::State::disconnected; }
};

std::uint32_t count(const auto& value) {
  return static_cast<std::uint32_t>(value);
}

/// A tick that could not be solved asks for a force that is not a number: the filter latches the fault and lets go.
glm::dvec3 asked_force(const modes::StepResult& result) {
  const bool solved = result.outcome == solver::Outcome::solved || result.outcome == solver::Outcome::capped;
  return solved ? result.force_n : glm::dvec3(std::numeric_limits<double>::quiet_NaN());
}

/// Counts of the processor's clock in each stage of a tick.
using StageCounts = std::array<std::uint64_t, stage_count>;

/// What the step counted of its own stages is not counted as modes too.
void part_modes(const modes::StepTimes& times, StageCounts& counts) {
  counts[static_cast<std::size_t>(Stage::map)] = times.map;
  counts[static_cast<std::size_t>(Stage::sample)] = times.sample;
  counts[static_cast<std::size_t>(Stage::solve)] = times.solve;
  counts[static_cast<std::size_t>(Stage::modes)] -= times.map + times.sample + times.solve;
}

}  // namespace

/// A snapshot as the servo holds it, with solvers of its own so that the tick runs exactly its plan.
struct Session::Setting {
  Setting(const Snapshot& published, std::shared_ptr<const SampledOnce> sampled, std::uint32_t number)
      : snapshot(published),
        source(std::move(sampled)),
        epoch(number),
        chain({.solvers = published.plan->solvers}),
        changing_chain(number == 0 ? nullptr
                                   : std::make_unique<solver::Chain>(solver::ChainOptions{
                                         .solvers = published.plan->solvers.with(solver::exact_solver),
                                         .capacity = modes::most_primitives})) {}

  Snapshot snapshot;
  /// The snapshot's source; one and the same for settings on the same data.
  std::shared_ptr<const SampledOnce> source;
  std::uint32_t epoch;
  solver::Chain chain;
  /// Of the change to it, in which two scenes together can need what neither does alone; null where there is none.
  std::unique_ptr<solver::Chain> changing_chain;
  Setting* next_returned = nullptr;
};

/// An open stylus; closed when this goes.
struct Session::Held {
  Held(std::shared_ptr<device::Stylus> opened, std::uint32_t number)
      : stylus(std::move(opened)), specification(stylus->specification()), epoch(number) {}
  Held(const Held&) = delete;
  Held& operator=(const Held&) = delete;
  ~Held() { stylus->close(); }

  std::shared_ptr<device::Stylus> stylus;
  device::Specification specification;
  std::uint32_t epoch;
  Held* next_returned = nullptr;
};

Session::Session(std::shared_ptr<const modes::Plan> plan, std::shared_ptr<const io::FieldSource> source,
                 device::Stylus& stylus, const device::SafetyLimits& limits)
    : Session({.plan = std::move(plan), .source = std::move(source), .limits = limits},
              std::shared_ptr<device::Stylus>(&stylus, [](device::Stylus*) {})) {}

Session::Session(const Snapshot& first, std::shared_ptr<device::Stylus> stylus, TickRing* ring)
    : Session(first, OpenStylus(std::move(stylus)), ring) {}

Session::Session(const Snapshot& first, OpenStylus stylus, TickRing* ring)
    : fault_log_(std::make_unique<device::FaultLog>()),
      scratch_(std::make_unique<modes::StepScratch>()),
      ring_(ring),
      rate_hz_(stylus.specification().rate),
      ns_per_count_(1 / modes::counts_per_ns()) {
  auto held = std::make_unique<Held>(stylus.release(), last_stylus_);
  sampled_ = std::make_shared<const SampledOnce>(first.source);
  setting_ = std::make_unique<Setting>(first, sampled_, last_setting_).release();
  held_ = held.release();
}

Session::~Session() {
  held_->stylus->write_force(device::Vec3(0));
  const std::unique_ptr<Held> held(held_);
  const std::unique_ptr<Setting> setting(setting_);
  const std::unique_ptr<Setting> leaving(leaving_);
  const std::unique_ptr<Setting> coming(coming_);
}

std::uint32_t Session::publish(const Snapshot& next) {
  if (sampled_->source() != next.source) sampled_ = std::make_shared<const SampledOnce>(next.source);
  settings_.give(std::make_unique<Setting>(next, sampled_, ++last_setting_));
  collect();
  return last_setting_;
}

std::uint32_t Session::change_stylus(std::shared_ptr<device::Stylus> stylus) {
  collect();
  if (!stylus) {
    stylus = std::make_shared<NoStylus>();
  }
  stylus->open();
  styluses_.give(std::make_unique<Held>(std::move(stylus), ++last_stylus_));
  return last_stylus_;
}

std::size_t Session::solver_bytes() const noexcept {
  std::size_t bytes = 0;
  for (const Setting* setting : {setting_, leaving_, coming_}) {
    if (setting == nullptr) continue;
    bytes += setting->chain.memory_bytes();
    if (setting->changing_chain) bytes += setting->changing_chain->memory_bytes();
  }
  return bytes;
}

void Session::collect() {
  settings_.collect();
  styluses_.collect();
  if (fault_log_->stopped()) {
    fault_ticks_ = fault_log_->ticks();
    ++faults_;
    fault_log_->clear();
  }
}

void Session::take_commands() noexcept {
  tick_.commands = 0;
  if (commands_.load(std::memory_order_relaxed) != 0) {
    tick_.commands = commands_.exchange(0, std::memory_order_acquire);
  }
  // Looked for after the commands: who sees that it shall arm sees the stylus that was changed before.
  if (!exchanging_ && styluses_.is_offered()) {
    exchanging_ = true;
    let_force_fall();
    tick_.commands |= command::change_stylus;
  }
  if ((tick_.commands & command::clear_fault) != 0) {
    device::clear_fault(safety_);
    arm_again_ = false;
  }
  if ((tick_.commands & command::disarm) != 0) {
    device::disarm(safety_);
    arm_again_ = false;
  }
  if ((tick_.commands & command::arm) != 0) {
    if (exchanging_) {
      arm_again_ = true;  // the next stylus
    } else if (coming_ != nullptr) {
      arm_again_ = true;
      tick_.commands &= ~command::arm;  // of the tick in which it takes effect
    } else {
      device::arm(safety_);
    }
  }
}

void Session::let_force_fall() noexcept {
  arm_again_ = arm_again_ || safety_.armed;
  device::disarm(safety_);
}

void Session::go_over_to_stylus() noexcept {
  if (!exchanging_ || safety_.gain > 0) {
    return;
  }
  if (Held* next = styluses_.take()) {
    held_->stylus->write_force(device::Vec3(0));
    styluses_.give_back(std::exchange(held_, next));
    stylus_epoch_.store(held_->epoch, std::memory_order_release);
    safety_ = {.fault = safety_.fault};
    if (std::exchange(arm_again_, false)) {
      device::arm(safety_);
      if (coming_ != nullptr) tick_.commands |= command::arm;
    }
    exchanging_ = false;
    engaged_ = false;
  }
}

void Session::take_setting(double time) noexcept {
  if (leaving_ == nullptr) {
    if (Setting* next = settings_.take()) {
      if (coming_ != nullptr) settings_.give_back(coming_);
      coming_ = next;
    }
    if (coming_ != nullptr) go_over_to_coming(time);
  }
  part_ = 1;
  if (leaving_ != nullptr && change_s_ > 0) {
    part_ = std::clamp((time - change_began_s_) / change_s_, 0.0, 1.0);
  }
}

void Session::go_over_to_coming(double time) noexcept {
  const Snapshot& next = coming_->snapshot;
  const bool differs = next.plan->workspace != setting_->snapshot.plan->workspace;
  const bool moves = differs && !next.is_replayed;
  if (moves && safety_.gain > 0) {
    if (safety_.armed) tick_.commands = (tick_.commands & ~command::arm) | command::disarm;
    let_force_fall();
    return;
  }
  change_began_s_ = time;
  change_s_ = moves ? 0 : next.change_s;
  if (differs && change_s_ == 0) engaged_ = false;
  leaving_ = std::exchange(setting_, std::exchange(coming_, nullptr));
  if (std::exchange(arm_again_, false)) {
    device::arm(safety_);
    tick_.commands |= command::arm;
  }
}

modes::StepResult Session::step(const device::Reading& reading) noexcept {
  const Snapshot& to = setting_->snapshot;
  if (leaving_ == nullptr) {
    return modes::step(*to.plan, *setting_->source, reading.position, touch_, setting_->chain, *scratch_);
  }
  const Snapshot& from = leaving_->snapshot;
  const modes::SceneChange change{
      .from = {from.plan.get(), leaving_->source.get()}, .to = {to.plan.get(), setting_->source.get()}, .part = part_};
  modes::StepResult result = modes::step(change, reading.position, touch_, *setting_->changing_chain, *scratch_);
  if (part_ >= 1) {
    // To be freed with the setting that it was a change from.
    leaving_->changing_chain.swap(setting_->changing_chain);
    settings_.give_back(std::exchange(leaving_, nullptr));
  }
  return result;
}

device::SafetyLimits Session::limits() const noexcept {
  device::SafetyLimits limits = setting_->snapshot.limits;
  limits.device_force = std::min(limits.device_force, held_->specification.maximum_force);
  if (leaving_ != nullptr) {
    const double from = leaving_->snapshot.limits.force;
    limits.force = from + part_ * (limits.force - from);
  }
  return limits;
}

const TickRecord& Session::tick() noexcept {
  const double time = static_cast<double>(ticks_) / rate_hz_;
  return tick({.time_s = time, .heartbeat_s = time});
}

const TickRecord& Session::tick(const Beat& beat) noexcept {
  modes::Stopwatch watch;
  watch.start();
  StageCounts counts{};
  const auto lap = [&](Stage stage) { watch.lap(counts[static_cast<std::size_t>(stage)]); };

  take_commands();
  go_over_to_stylus();
  take_setting(beat.time_s);
  // A stylus that is ready before its pose is read has a pose.
  const device::State before = held_->stylus->state();
  const device::Reading reading = held_->stylus->read();
  const device::State state = can_push(before) ? held_->stylus->state() : before;
  orientation_.store(reading.orientation);
  lap(Stage::read);

  const bool engaged = safety_.armed && can_push(state);
  if (engaged && !engaged_) {
    // What was touched before the force came back means nothing to the hand now.
    touch_ = {};
    energy_ = {};
  }
  engaged_ = engaged;
  const device::SafetyLimits limits_now = limits();
  const modes::StepResult result = step(reading);
  lap(Stage::modes);
  part_modes(scratch_->times, counts);

  glm::dvec3 asked = asked_force(result);
  if (held_->specification.force_axes > 0) {
    asked = device::damp_ringing({}, reading, asked, energy_);
  }
  const device::SafetyInput input{.time = beat.time_s,
                                  .reading = reading,
                                  .device = state,
                                  .force = asked,
                                  .force_time = beat.time_s,
                                  .heartbeat_time = beat.heartbeat_s};
  const device::SafetyResult safe = device::filter_force(limits_now, input, safety_);
  fault_log_->record(input, safe);
  lap(Stage::filter);

  held_->stylus->write_force(safe.force);
  lap(Stage::write);

  tick_.stylus_state = count(state);
  tick_.safety = pack_safety(safe.state, safe.fault);
  copy(safe.force, tick_.sent_n);
  observe(beat, reading, result);
  lap(Stage::observe);
  for (std::size_t stage = 0; stage < stage_count; ++stage) {
    tick_.stage_ns[stage] = count(static_cast<double>(counts[stage]) * ns_per_count_);
  }
  if (ring_ != nullptr) {
    ring_->push(tick_, shares());
  }
  return tick_;
}

void Session::observe(const Beat& beat, const device::Reading& reading, const modes::StepResult& result) noexcept {
  tick_.index = ticks_++;
  tick_.dt_s = beat.time_s - tick_.time_s;
  tick_.time_s = beat.time_s;
  tick_.pose_time_s = reading.time;
  tick_.heartbeat_s = beat.heartbeat_s;
  tick_.missed = beat.missed;
  tick_.late_ns = beat.late_ns;
  copy(reading.position, tick_.probe_m);
  copy(result.proxy_m, tick_.proxy_m);
  copy(result.force_n, tick_.force_n);
  const Snapshot& now = setting_->snapshot;
  const std::size_t structures = now.plan->structures.size();
  const io::FieldSet told = structures == 0 ? io::FieldSet::value : io::FieldSet::value | io::FieldSet::distance;
  // With what the next tick wants of this place.
  const io::Sample here =
      setting_->source->sample(touch_.workspace.to_patient(result.proxy_m), told | now.plan->fields);
  for (std::size_t n = 0; n < distance_count; ++n) {
    tick_.distance_mm[n] = n < structures ? here.distance[n].mm : std::numeric_limits<double>::quiet_NaN();
  }
  tick_.value = here.inside ? here.value : std::numeric_limits<double>::quiet_NaN();
  tick_.error_bound_m = result.error_bound;
  tick_.change_part = part_;
  tick_.scene_epoch = setting_->epoch;
  tick_.sub_steps = count(result.sub_steps);
  tick_.halts = count(result.halts);
  tick_.iterations = count(result.iterations);
  tick_.solver = solver::number_of(result.solver);
  tick_.outcome = count(result.outcome);
  tick_.buttons = reading.buttons | pressed_.load(std::memory_order_relaxed);
  tick_.fresh = reading.fresh ? 1 : 0;
  tick_.stylus_epoch = held_->epoch;
  tick_.from_brick = result.sample.from_brick ? 1 : 0;
  tick_.share_count = count(result.primitives.size());
  glm::dvec3 balance = -result.force_n;
  for (std::size_t n = 0; n < result.primitives.size(); ++n) {
    shares_[n] = {.tick = tick_.index,
                  .mode = result.mode_of[n],
                  .type = count(result.primitives[n].type),
                  .strength_n = result.primitives[n].strength};
    copy(result.shares[n], shares_[n].force_n);
    balance += result.shares[n];
  }
  tick_.residual_n = glm::length(balance);
}

}  // namespace palpate::plugin
