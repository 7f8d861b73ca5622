#include "plugin/paraview/client/model/session_controller.h"

#include <QPointer>

#include <algorithm>
#include <exception>
#include <glm/geometric.hpp>
#include <stdexcept>
#include <utility>

#include "io/fields/filtered.h"
#include "io/quantile.h"
#include "modes/scene/scene.h"
#include "plugin/app/stylus_choice.h"
#include "plugin/messages/messages.h"
#include "plugin/paraview/client/model/session_state.h"
#include "plugin/paraview/client/words.h"
#include "plugin/report/held_boundary.h"
#include "plugin/report/live_view.h"
#include "plugin/report/summary.h"
#include "plugin/session/scene_fit.h"

namespace palpate::plugin {
namespace {

constexpr int heart_ms = 100;
constexpr int poll_ms = 33;
constexpr std::uint32_t clutch_button = 1, release_button = 4;  // between them mark_button

void refuse_misfit(const modes::Scene& scene, const io::Volume& volume) {
  if (const Text why = why_not_felt(scene, volume); !why.empty()) throw InvalidInput(why);
}

}  // namespace

SessionController::SessionController(SceneModel& model, QObject* parent) : QObject(parent), model_(model) {
  setObjectName(QStringLiteral("palpateSession"));
  model.set_commit([this](const modes::Scene& scene, Pace pace) { commit(scene, pace); });
  model.set_read([this](const modes::Scene& scene, auto done) {
    return !coming_.expected && reader_.read(scene, live_.scan(), std::move(done));
  });
  connect(&heart_, &QTimer::timeout, this, [this] { live_.heartbeat(); });
  connect(&polls_, &QTimer::timeout, this, [this] { poll(); });
  polls_.setTimerType(Qt::PreciseTimer);
  heart_.start(heart_ms);
  polls_.start(poll_ms);
}

SessionController::~SessionController() {
  model_.set_commit({});
  model_.set_read({});
  live_.disconnect();
}

void SessionController::set_no_scan(const QString& why) {
  mark_button_.forget();
  if (coming_.reader.cancel() || !why.isEmpty()) coming_.expected = false;
  why_no_scan_ = why;
  const auto recorded_now = live_.disconnect();
  live_.set_scan(nullptr);
  hand_.hold(nullptr);
  parted_.reset();
  poll();
  emit felt_scan_changed();
  emit connection_changed();
  tell_recorded(recorded_now);
}

void SessionController::set_scan(std::shared_ptr<const io::Volume> volume, const ScanFrame& frame) {
  why_no_scan_.clear();
  const bool is_unfiltered = volume && io::filter_of(*volume) != model_.scene().filter;
  if ((coming_.expected || !live_.scan() || is_unfiltered) && is_read_for(volume, frame)) return;
  take_scan(std::move(volume), frame);
}

bool SessionController::is_read_for(const std::shared_ptr<const io::Volume>& volume, const ScanFrame& frame) {
  const auto done = [this, volume, frame](const QString& error) {
    if (error.isEmpty()) return set_scan(volume, frame);
    coming_.expected = false;
    set_no_scan({});
    emit told(error, true);
  };
  if (!volume || !why_not_felt(model_.scene(), *volume).empty() || !coming_.reader.read(model_.scene(), volume, done)) {
    return false;
  }
  coming_.expected = true;
  release();
  emit connection_changed();
  return true;
}

void SessionController::take_scan(std::shared_ptr<const io::Volume> volume, const ScanFrame& frame) {
  coming_.reader.cancel();
  if (std::exchange(coming_.expected, false)) parted_.reset();  // where the stylus was says nothing of this scan
  mark_button_.forget();                                        // they would be of two scans
  QString problem;
  std::optional<RecorderStatus> recorded_now;
  try {
    if (volume) refuse_misfit(model_.scene(), *volume);
    live_.set_scan(std::move(volume), model_.scene(), frame);
  } catch (const std::exception& error) {
    recorded_now = live_.disconnect();
    live_.set_scan(nullptr);
    problem = QString::fromUtf8(error.what());
  }
  follow_workspace();
  if (std::exchange(coming_.begins_outside, false)) begin_outside();
  emit felt_scan_changed();
  emit connection_changed();
  tell_recorded(recorded_now);
  if (!problem.isEmpty()) emit told(problem, true);
}

void SessionController::commit(const modes::Scene& scene, Pace pace) {
  if (coming_.expected) {
    modes::validate(scene);
    return;
  }
  if (live_.scan()) refuse_misfit(scene, *live_.scan());
  live_.set_scene(scene, may_remap() ? Pace::at_once : pace);
  follow_workspace();
}

void SessionController::follow_workspace() {
  if (!live_.plan() || !workspace_.change_to(live_.plan()->workspace, live_.epoch())) return;
  hand_.forget_place();
  // The stylus jumps to another place in the patient: the force comes back when the user asks for it.
  if (feels()) release();
}

void SessionController::connect_stylus(const StylusChoice& choice) {
  const QString why = coming_.expected ? words(say("scan-is-still-being-read")) : why_no_scan_;
  if (!live_.scan() && !why.isEmpty()) {
    emit told(why, true);
    return;
  }
  QString problem;
  try {
    const auto stylus =
        make_stylus({.device = choice.device, .firmware = choice.firmware, .settings = choice.settings});
    hand_.hold(std::dynamic_pointer_cast<device::SimulatedStylus>(stylus));
    parted_.reset();
    status_ = {};  // of a recording, perhaps
    ticks_.restart();
    mark_button_.forget();
    if (live_.plan()) {
      workspace_.set(live_.plan()->workspace);
      if (hand_.holds() && start_) move_hand(start_(stylus->specification()));  // before the first tick
    }
    live_.connect(stylus, LiveSession::Start::released);
    homing_ = QString::fromUtf8(type_of(choice).homing.data(), static_cast<int>(type_of(choice).homing.size()));
    workspace_.set(live_.plan()->workspace);
  } catch (const std::exception& error) {
    hand_.hold(nullptr);
    problem = QString::fromUtf8(error.what());
  }
  emit connection_changed();
  emit told(problem, true);
}

void SessionController::disconnect_stylus() {
  mark_button_.forget();
  const auto recorded_now = live_.disconnect();
  hand_.hold(nullptr);
  parted_.reset();
  poll();
  emit connection_changed();
  tell_recorded(recorded_now);
}

void SessionController::begin_outside() {
  coming_.begins_outside = coming_.expected;
  if (coming_.expected) return;
  if (has_simulated() && !feels() && start_) move_hand(start_(live_.specification()));
}

void SessionController::feel() {
  if (!live_.is_connected()) return;
  if (const QString why = why_kept_off(); !why.isEmpty()) {
    emit told(why, true);
    return;
  }
  parted_.reset();
  live_.feel();
  emit told({}, false);
}

QString SessionController::why_kept_off() const {
  return coming_.expected ? words(say("scan-is-still-being-read")) : kept_off_;
}

bool SessionController::feels() const {
  return live_.is_connected() && live_.start() == LiveSession::Start::feeling &&
         fault_of(status_.tick) == device::Fault::none;
}

void SessionController::release() {
  if (parted_) parted_->felt = false;
  live_.release();
}

void SessionController::keep_off(const QString& why) {
  if (why == kept_off_) return;
  kept_off_ = why;
  if (!why.isEmpty()) release();
}

void SessionController::clear_fault() {
  release();
  // A device in fault stays so until it is opened again; another fault is only forgotten.
  if (!live_.is_connected() || !is_lost(status_.tick)) {
    live_.clear_fault();
    return;
  }
  QString problem;
  try {
    live_.reopen();
    begin_anew();
  } catch (const std::exception& error) {
    hand_.hold(nullptr);
    problem = QString::fromUtf8(error.what());
  }
  poll();
  emit connection_changed();
  emit told(problem, true);
}

void SessionController::begin_anew() {
  ticks_.count_anew();
  if (live_.plan()) workspace_.set(live_.plan()->workspace);
}

QString SessionController::last_fault() const {
  return live_.last_fault() ? words(describe(*live_.last_fault())) : QString();
}

void SessionController::record(const std::string& file) {
  QString problem;
  try {
    mark_button_.forget();
    if (hand_.holds()) move_hand(status_.probe_mm);  // where the new session finds it
    live_.record(file);
    recording_to_ = QString::fromStdString(file);
  } catch (const std::exception& error) {
    problem = QString::fromUtf8(error.what());
  }
  // Where the file cannot be written a new session has begun without it.
  live_.is_connected() ? begin_anew() : hand_.hold(nullptr);
  emit connection_changed();
  problem.isEmpty() ? emit told(words(say("recording-the-session-began-anew")), false) : emit told(problem, true);
}

void SessionController::stop_recording() {
  std::optional<RecorderStatus> status;
  QString problem;
  try {
    status = live_.stop_recording();
  } catch (const std::exception& error) {
    problem = QString::fromUtf8(error.what());
  }
  emit connection_changed();
  tell_recorded(status);
  if (!problem.isEmpty()) emit told(problem, true);
}

void SessionController::tell_recorded(const std::optional<RecorderStatus>& status) {
  if (!status) return;
  emit told(status->stopped ? QString::fromStdString(status->why)
                            : words(say("recorded-ticks-lost", status->written, status->lost)),
            status->stopped);
  if (!status->stopped) emit recorded(recording_to_);
}

void SessionController::press_mark() {
  if (live_.is_connected() && !parted_) mark_button_.press();
}

FeltMark SessionController::mark_here() const {
  TickRecord pressed = status_.tick;
  pressed.buttons = mark_button;
  MarkPresses once;
  once.take({.tick = pressed,
             .time_s = pressed.time_s,
             .proxy_mm = status_.proxy_mm,
             .shares = status_.shares,
             .scene = live_.scene()});
  return std::get<FeltMark>(*once.finish());
}

void SessionController::follow_marks() {
  if (parted_) return mark_button_.drop();
  const auto proxy_mm = [this](const TickRecord& tick) {
    return workspace_.at(tick).to_patient(vector_of(tick.proxy_m));
  };
  if (const auto made = mark_button_.follow(status_.tick, status_.shares, live_.scene(), proxy_mm)) emit marked(*made);
}

void SessionController::obey_buttons(std::uint32_t pressed, std::uint32_t let, bool releases) {
  if (releases) release();
  if ((pressed & clutch_button) != 0) clutch();
  if ((let & clutch_button) != 0) emit clutch_button_let_go();
}

void SessionController::tell_force() {
  const double sent_n = glm::length(vector_of(status_.tick.sent_n)), allowed_n = live_.allowed_force_n();
  const auto acting = live_.force_on_device();
  status_.is_warm = sent_n > allowed_n;
  status_.is_held_back = acting && acting->is_held_back;
  status_.may_push = acting && acting->state != device::OnDevice::zero_taken && is_lost(status_.tick);
  status_.force_n = acting ? acting->newtons : std::min(sent_n, allowed_n);
  // The ticks' forces are no forces of the device where it gets others.
  const bool is_other = status_.is_held_back || status_.may_push;
  status_.peak_n = is_other ? status_.force_n : std::max(status_.force_n, std::min(status_.peak_n, allowed_n));
}

void SessionController::poll() {
  const TickRing* const ring = live_.ticks();
  status_.connected = live_.is_connected();
  status_.clutched = is_clutched();
  status_.kept_off = why_kept_off();
  status_.peak_n = 0;
  if (!status_.connected) {
    status_ = instead_ ? instead_() : SessionStatus{};
    emit polled(status_);
    return;
  }
  std::vector<double> ticks;
  bool releases = false;
  const NewTicks::Buttons buttons = ticks_.read(*ring, status_.tick, status_.shares, [&](std::uint32_t pressed) {
    // Where one key is both (the Falcon's in the middle) it is the clutch.
    if ((pressed & release_button) != 0 && (pressed & clutch_button) == 0) releases = true;
    status_.fresh = true;
    status_.peak_n = std::max(status_.peak_n, glm::length(vector_of(status_.tick.sent_n)));
    ticks.push_back(tick_us(status_.tick));
    follow_marks();
  });
  if (!ticks.empty()) status_.tick_us = io::quantile(std::move(ticks), 0.5);
  const TickRecord& tick = status_.tick;
  const bool is_silent = fault_of(tick) == device::Fault::commander_silent;
  if (!is_silent) status_.held_up.clear();
  if (is_silent && status_.held_up.isEmpty()) status_.held_up = slow_.in_words();
  status_.feels = feels();
  status_.workspace = workspace_.at(tick);
  status_.probe_mm = parted_ ? parted_->at_mm : status_.workspace.to_patient(vector_of(tick.probe_m));
  status_.proxy_mm = parted_ ? parted_->at_mm : status_.workspace.to_patient(vector_of(tick.proxy_m));
  tell_force();
  status_.missed = live_.missed();
  status_.homing = homing_;
  status_.trouble = words(live_.trouble());
  status_.orientation.reset();
  if (const auto turned = live_.orientation()) {
    status_.orientation = glm::normalize(glm::quat_cast(status_.workspace.rotation) * *turned);
  }
  status_.tissue = tissue_name(model_.scene(), live_.scan() ? live_.scan()->unit : std::string(), tick.value);
  // A tick before the last edit may refer to other structures.
  status_.nearest.reset();
  if (const auto plan = live_.plan(); plan && tick.scene_epoch == live_.epoch()) {
    status_.nearest = nearest_structure(tick, model_.scene(), plan->structures);
  }
  const auto held =
      held_boundary(status_.shares, live_.felt(), live_.scene(), status_.proxy_mm, status_.probe_mm, sites_.get());
  status_.held = held ? in_words(*held) : "";
  // On an edge the value is one of neither side: half-way from air to muscle it is fat's.
  if (held && live_.scene().modes[held->mode].structure.empty()) status_.tissue = "between tissues";
  obey_buttons(buttons.pressed, buttons.let & ~tick.buttons, releases);
  hand_.give_way(tick, status_.force_n);
  emit polled(status_);
}

}  // namespace palpate::plugin
