#include "device/touch/touch_driver.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <ctime>
#include <exception>
#include <stdexcept>
#include <string_view>
#include <thread>
#include <utility>

#include "device/link/realtime.h"
#include "device/messages.h"
#include "device/vectors.h"

namespace palpate::device {

namespace {

constexpr double mm = 1e-3;                  // m
constexpr int callbacks_without_force = 20;  // after which a force that is not renewed becomes zero
constexpr double longest_gap = 0.1;          // s between two callbacks
constexpr int calibration_every = 100;       // callbacks
constexpr unsigned short top_priority = 65535;

struct Model {
  std::string_view word;  // of the library's name for it
  double stiffness;       // N/m, as CHAI3D has them
};
constexpr std::array models{Model{"Omni", 700}, Model{"Desktop", 1000}, Model{"Premium", 1000}, Model{"Touch", 400}};

constexpr double usual_force = 3.3;  // N, of Touch and Omni

/// What is set, or else what is usual; never more than the device can.
double within(double set, double most, double usual = HUGE_VAL) {
  return std::min(set > 0 ? set : usual, most);
}

double stiffness_of(std::string_view name) {
  const auto found = std::find_if(models.begin(), models.end(),
                                  [&](const Model& model) { return name.find(model.word) != std::string_view::npos; });
  return found != models.end() ? found->stiffness : 400;
}

}  // namespace

TouchDriver::TouchDriver(const TouchSettings& settings, const DriverClock& clock) : settings_(settings), clock_(clock) {
  sem_init(&sampled_, 0, 0);
}

TouchDriver::~TouchDriver() {
  disconnect();
  sem_destroy(&sampled_);
}

void TouchDriver::throw_error(const Text& what) {
  const unsigned error = hd_->drain_errors();
  if (hd::severity_of(error) != hd::Severity::device_failed) return;
  const std::string reason = hd_->words_for(error);
  disconnect();
  throw Refusal(say("touch-refuses", what, reason));
}

void TouchDriver::read_model() {
  const char* const named = hd_->get_string(hd::model_type);
  const std::string name = named != nullptr ? named : "Touch";
  double force = 0, continuous = 0, stiffness = 0;
  std::array<double, 6> box{};  // mm: lowest x, y, z, highest x, y, z
  hd_->get_doubles(hd::nominal_force, &force);
  hd_->get_doubles(hd::nominal_continuous_force, &continuous);
  hd_->get_doubles(hd::nominal_stiffness, &stiffness);
  hd_->get_doubles(hd::usable_workspace, box.data());
  throw_error(say("touch-does-not-tell"));
  maximum_force_ = within(settings_.maximum_force, force > 0 ? force : usual_force);
  described_.name = name;
  described_.orientation_axes = 3;
  described_.maximum_force = maximum_force_;
  described_.continuous_force = continuous > 0 ? std::min(continuous, maximum_force_) : maximum_force_ / 4;
  // The library's is in N/mm, and is the motors'; what is rendered stably is the model's.
  const double own = stiffness_of(name);
  const double motors = stiffness > 0 ? 1e3 * stiffness : touch_limits.stiffness_n_per_m;
  described_.stiffness_limit = within(settings_.stiffness_limit, motors, own);
  for (int axis = 0; axis < 3; ++axis) {
    const auto at = static_cast<std::size_t>(axis);
    const double reach = mm * std::min(-box[at], box[at + 3]);
    described_.workspace_half_extent[axis] = reach > 0.01 && reach < 1 ? reach : 0.05;
  }
  described_.position_resolution = 0.055e-3;
}

// As the maker's own example chooses: automatic before the inkwell, and the encoders' reset only after asking, because
// it takes wherever the arm is for its reset position.
void TouchDriver::choose_calibration() {
  int styles = 0;
  hd_->get_integers(hd::calibration_style, &styles);
  throw_error(say("touch-does-not-tell"));
  const auto has = [&](unsigned style) { return (static_cast<unsigned>(styles) & style) != 0; };
  style_ = has(hd::automatic) ? hd::automatic : has(hd::inkwell) ? hd::inkwell : hd::encoder_reset;
  if (style_ != hd::encoder_reset || hd_->check_calibration() == hd::calibrated) return;
  if (!settings_.may_reset_encoders) {
    disconnect();
    throw Refusal(say("touch-has-to-be-reset-by-hand"));
  }
  hd_->update_calibration(hd::encoder_reset);
  throw_error(say("touch-does-not-tell"));
}

void TouchDriver::connect() {
  if (!hd_) hd_ = std::make_unique<HdLibrary>();
  const std::uint64_t news = status_.news;
  status_ = {};
  status_.news = news;
  status_.state = State::homing;
  lost_ = false;
  unsigned error = hd::success;
  device_ = hd_->open_device(settings_.address, error);
  if (device_ == hd::invalid_device) {
    throw Refusal(say("touch-cannot-be-opened", error == hd::success ? "no reason given" : hd_->words_for(error)));
  }
  hd_->make_current_device(device_);
  read_model();
  choose_calibration();
  hd_->enable(hd::force_output);
  hd_->enable(hd::max_force_clamping);
  hd_->enable(hd::force_ramping);
  throw_error(say("touch-has-no-forces"));
  // Nothing calls back yet. What is posted is of the session before, and so may be its error.
  drop_posts();
  force_.store(Vec3(0));
  unrenewed_ = callbacks_without_force;
  called_ = clock_.now();
  calibrating_ = 0;
  calibration_ = hd::needs_update;
  was_calibrated_ = pushed_ = false;
  hd_->set_scheduler_rate(1000);
  scheduled_ = hd_->schedule_asynchronous(&TouchDriver::on_schedule, this, top_priority);
  hd_->start_scheduler();
  running_ = true;
  throw_error(say("touch-does-not-start"));
}

void TouchDriver::disconnect() noexcept {
  if (device_ == hd::invalid_device) return;
  // Unscheduling while the scheduler runs hangs.
  if (running_) {
    hd_->stop_scheduler();
    hd_->unschedule(scheduled_);
    running_ = false;
  }
  hd_->disable_device(device_);
  device_ = hd::invalid_device;
}

double TouchDriver::now() noexcept {
  return clock_.now();
}

unsigned TouchDriver::on_schedule(void* self) {
  auto& driver = *static_cast<TouchDriver*>(self);
  driver.sample_.store(driver.exchange());
  sem_post(&driver.sampled_);
  return hd::callback_continue;
}

TouchDriver::Sample TouchDriver::exchange() noexcept {
  Sample sample;
  // After a standstill (Ctrl-Z, a debugger) the force of before is nothing to begin with.
  const double now = clock_.now();
  const bool stood_still = now - called_ > longest_gap;
  called_ = now;
  const bool renewed = !stood_still && force_.has_news();
  unrenewed_ =
      renewed ? 0 : (stood_still ? callbacks_without_force : std::min(unrenewed_ + 1, callbacks_without_force));
  const Vec3 newest = force_.load();
  hd_->begin_frame(device_);
  const bool is_pushing = pushed_ || (unrenewed_ < callbacks_without_force && newest != Vec3(0));
  if (calibrating_++ % calibration_every == 0) look_at_calibration(is_pushing);
  hd_->get_doubles(hd::position, &sample.position_mm.x);
  hd_->get_doubles(hd::transform, sample.transform);
  hd_->get_integers(hd::buttons, &sample.buttons);
  const bool may_push = calibration_ == hd::calibrated && unrenewed_ < callbacks_without_force;
  const Vec3 force = may_push ? clamp_length(newest, maximum_force_) : Vec3(0);
  hd_->set_doubles(hd::current_force, &force.x);
  pushed_ = force != Vec3(0);
  hd_->end_frame(device_);
  sample.error = hd_->drain_errors();
  sample.calibration = calibration_;
  return sample;
}

void TouchDriver::look_at_calibration(bool is_pushing) noexcept {
  calibration_ = hd_->check_calibration();
  // One that is automatic gathers better figures while the arm moves. Taking them moves every pose a little: never
  // under a force, and until then the former ones hold.
  const bool refines_itself = was_calibrated_ && style_ == hd::automatic && calibration_ == hd::needs_update;
  // Any other arm that pushed and has to be calibrated has lost its home: it is not set anew under the hand.
  const bool may_update = style_ != hd::encoder_reset && (refines_itself ? !is_pushing : !was_calibrated_);
  if (calibration_ == hd::needs_update && may_update) {
    hd_->update_calibration(style_);
    calibration_ = hd_->check_calibration();
  }
  if (refines_itself && calibration_ == hd::needs_update) calibration_ = hd::calibrated;
  was_calibrated_ = was_calibrated_ || calibration_ == hd::calibrated;
}

void TouchDriver::take(double timeout) noexcept {
  timespec until{};
  // Not by the wall clock, which may be set meanwhile.
  clock_gettime(CLOCK_MONOTONIC, &until);
  const auto end = static_cast<std::int64_t>(until.tv_nsec) + static_cast<std::int64_t>(timeout * 1e9);
  until.tv_sec += end / 1'000'000'000;
  until.tv_nsec = static_cast<long>(end % 1'000'000'000);
  if (sem_clockwait(&sampled_, CLOCK_MONOTONIC, &until) != 0) return;
  drop_posts();
  follow(sample_.load());
}

void TouchDriver::drop_posts() noexcept {
  while (sem_trywait(&sampled_) == 0) {
  }
}

void TouchDriver::follow(const Sample& sample) noexcept {
  if (status_.state == State::fault || lost_) return;
  switch (hd::severity_of(sample.error)) {
    case hd::Severity::none:
    case hd::Severity::force_clamped:
      break;
    case hd::Severity::force_taken_away:
      status_.state = State::fault;
      status_.fault = LinkFault::own_safety;
      return;
    case hd::Severity::device_failed:
      lost_ = true;
      return;
  }
  const Vec3 place = mm * sample.position_mm;
  if (!is_finite(place) || glm::length(place) > 1) {
    status_.state = State::fault;
    status_.fault = LinkFault::unreachable_pose;
    return;
  }
  ++status_.news;
  status_.buttons = static_cast<std::uint32_t>(sample.buttons);
  if (sample.calibration != hd::calibrated) {
    const bool had_a_home = status_.state == State::idle;
    status_.state = had_a_home ? State::fault : State::homing;
    if (had_a_home) status_.fault = LinkFault::unhomed;
    return;
  }
  status_.state = State::idle;
  status_.position = place;
  glm::dmat3 turned;
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row) turned[column][row] = sample.transform[4 * column + row];
  }
  const glm::dquat orientation = glm::quat_cast(turned);
  const double length = glm::length(orientation);
  if (std::isfinite(length) && length > 0.5) status_.orientation = orientation / length;
}

void TouchDriver::flush(double timeout) noexcept {
  // The library's thread takes the last force within its period.
  clock_.sleep(std::min(timeout, 0.003));
}

std::unique_ptr<LinkStylus> make_touch_with(const TouchSettings& settings, const LinkStylusOptions& options,
                                            const DriverClock& clock) {
  check_limits("3D Systems Touch", settings, touch_limits);
  Specification specification;
  specification.name = "3D Systems Touch";
  specification.orientation_axes = 3;
  specification.workspace_half_extent = Vec3(0.08, 0.06, 0.035);
  specification.position_resolution = 0.055e-3;
  specification.maximum_force = within(settings.maximum_force, touch_limits.force_n, usual_force);
  specification.continuous_force = specification.maximum_force / 4;
  specification.stiffness_limit = settings.stiffness_limit > 0 ? settings.stiffness_limit : 400;
  return std::make_unique<LinkStylus>(specification, std::make_unique<TouchDriver>(settings, clock), options);
}

std::unique_ptr<Stylus> make_touch(const TouchSettings& settings) {
  LinkStylusOptions options;
  if (settings.guarded) options.guardian = {guardian_program(), "touch", settings.address};
  options.signs = settings.signs;
  options.stays_awake = true;
  return make_touch_with(settings, options);
}

namespace {

/// What the guardian's callbacks do.
struct Zeros {
  const HdLibrary& hd;
  unsigned device;
  std::atomic<int> sent{0};

  static unsigned send(void* self) {
    auto& zeros = *static_cast<Zeros*>(self);
    const Vec3 zero(0);
    zeros.hd.begin_frame(zeros.device);
    zeros.hd.set_doubles(hd::current_force, &zero.x);
    zeros.hd.end_frame(zeros.device);
    // Motors that are warm take a zero as others do.
    if (hd::severity_of(zeros.hd.drain_errors()) != hd::Severity::device_failed) ++zeros.sent;
    return hd::callback_continue;
  }
};

}  // namespace

bool send_zeros_to_touch(const std::string& address) {
  constexpr int enough = 5, longest_ms = 100;
  const HdLibrary hd;
  unsigned error = hd::success;
  const unsigned device = hd.open_device(address, error);
  if (device == hd::invalid_device) return false;
  hd.make_current_device(device);
  Zeros zeros{hd, device};
  const unsigned long scheduled = hd.schedule_asynchronous(&Zeros::send, &zeros, top_priority);
  hd.start_scheduler();
  for (int ms = 0; ms < longest_ms && zeros.sent < enough; ++ms) sleep_seconds(1e-3);
  hd.stop_scheduler();
  hd.unschedule(scheduled);
  hd.disable_device(device);
  return zeros.sent >= enough;
}

std::vector<FoundDevice> find_touch() {
  try {
    const HdLibrary hd;
    return {{"touch", "3D Systems Touch", "", true,
             "OpenHaptics is installed; whether a device is there shows when it is connected"}};
  } catch (const std::exception&) {
    return {};
  }
}

}  // namespace palpate::device
