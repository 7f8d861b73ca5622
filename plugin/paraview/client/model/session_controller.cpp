#include "plugin/paraview/client/model/session_controller.h"

#include <algorithm>
#include <exception>
#include <glm/geometric.hpp>
#include <stdexcept>
#include <utility>

#include "io/quantile.h"
#include "modes/scene/scene.h"
#include "plugin/app/stylus_choice.h"
#include "plugin/messages/messages.h"
#include "plugin/paraview/client/words.h"
#include "plugin/report/held_boundary.h"
#include "plugin/report/live_view.h"
#include "plugin/report/summary.h"
#include "plugin/session/scene_fit.h"

namespace palpate::plugin {
namespace {

constexpr int heart_ms = 100;
constexpr int look_ms = 33;
constexpr std::uint32_t clutch_button = 1, release_button = 4;  // between them mark_button

void refuse_misfit(const modes::Scene& scene, const io::Volume& volume) {
  if (const Text why = why_not_felt(scene, volume); !why.empty()) throw InvalidInput(why);
}

}  // namespace

SessionController::SessionController(SceneModel& model, QObject* parent) : QObject(parent), model_(model) {
  setObjectName(QStringLiteral("palpateSession"));
  model.set_commit([this](const modes::Scene& scene, Pace pace) { commit(scene, pace); });
  model.set_read([this](const modes::Scene& scene, auto done) { return read(scene, std::move(done)); });
  connect(&heart_, &QTimer::timeout, this, [this] { live_.heartbeat(); });
  connect(&looks_, &QTimer::timeout, this, [this] { look(); });
  looks_.setTimerType(Qt::PreciseTimer);
  heart_.start(heart_ms);
  looks_.start(look_ms);
}

SessionController::~SessionController() {
  model_.set_commit({});
  model_.set_read({});
  live_.disconnect();
}

void SessionController::set_no_scan(const QString& why) {
  forget_marks();
  why_no_scan_ = why;
  const auto recorded_now = live_.disconnect();
  live_.set_scan(nullptr);
  simulated_.reset();
  clutched_ = false;
  look();
  emit connection_changed();
  tell_recorded(recorded_now);
}

void SessionController::set_scan(std::shared_ptr<const io::Volume> volume, const ScanFrame& frame) {
  why_no_scan_.clear();
  expects_scan_ = false;
  forget_marks();  // they would be of two scans
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
  if (live_.plan()) before_ = now_ = live_.plan()->workspace;
  emit connection_changed();
  tell_recorded(recorded_now);
  if (!problem.isEmpty()) emit told(problem, true);
}

void SessionController::commit(const modes::Scene& scene, Pace pace) {
  if (expects_scan_) {
    modes::validate(scene);
    return;
  }
  if (live_.scan()) refuse_misfit(scene, *live_.scan());
  live_.set_scene(scene, pace);
  follow_workspace();
}

/// In the background: neither panel nor servo waits for files.
bool SessionController::read(const modes::Scene& scene, std::function<void(const QString& error)> done) {
  if (expects_scan_ || !live_.scan()) return false;
  try {
    if (live_.has_read(scene)) return false;
  } catch (const std::exception&) {
    return false;  // it is refused
  }
  if (held_of_.lock() != live_.scan()) held_.clear();
  held_of_ = live_.scan();
  reading_.ask(live_.reading(scene), [this, done = std::move(done)](const auto& read, const QString& error) {
    if (read) {
      held_.insert(held_.end(), read->structures.begin(), read->structures.end());
      live_.offer(PreparedScene(*read));
    }
    done(error);
  });
  return true;
}

void SessionController::follow_workspace() {
  if (live_.plan()) before_ = std::exchange(now_, live_.plan()->workspace);
  if (before_ != now_) hand_mm_.reset();
}

void SessionController::connect_stylus(const StylusChoice& choice) {
  if (!live_.scan() && !why_no_scan_.isEmpty()) {
    emit told(why_no_scan_, true);
    return;
  }
  QString problem;
  try {
    const auto stylus =
        make_stylus({.device = choice.device, .firmware = choice.firmware, .settings = choice.settings});
    simulated_ = std::dynamic_pointer_cast<device::SimulatedStylus>(stylus);
    clutched_ = false;
    look_ = {};  // of a recording, perhaps
    hand_mm_.reset();
    buttons_ = 0;
    forget_marks();
    next_tick_ = 0;
    if (live_.plan()) {
      before_ = now_ = live_.plan()->workspace;
      if (simulated_ && start_) move_hand(start_(stylus->specification()));  // before the first tick
    }
    live_.connect(stylus, LiveSession::Start::released);
    homing_ = QString::fromUtf8(type_of(choice).homing.data(), static_cast<int>(type_of(choice).homing.size()));
    before_ = now_ = live_.plan()->workspace;
  } catch (const std::exception& error) {
    simulated_.reset();
    problem = QString::fromUtf8(error.what());
  }
  emit connection_changed();
  emit told(problem, true);
}

void SessionController::disconnect_stylus() {
  forget_marks();
  const auto recorded_now = live_.disconnect();
  simulated_.reset();
  clutched_ = false;
  look();
  emit connection_changed();
  tell_recorded(recorded_now);
}

void SessionController::begin_outside() {
  if (has_simulated() && !feels() && start_) move_hand(start_(live_.specification()));
}

void SessionController::feel() {
  if (!live_.is_connected()) return;
  if (!kept_off_.isEmpty()) {
    emit told(kept_off_, true);
    return;
  }
  clutched_ = false;
  live_.feel();
  emit told({}, false);
}

bool SessionController::feels() const {
  return live_.is_connected() && live_.start() == LiveSession::Start::feeling &&
         fault_of(look_.tick) == device::Fault::none;
}

void SessionController::release() {
  feels_after_clutch_ = false;
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
  const auto state = static_cast<device::State>(look_.tick.stylus_state);
  const bool lost = live_.is_connected() && (state == device::State::fault || state == device::State::disconnected);
  if (!lost) {
    live_.clear_fault();
    return;
  }
  QString problem;
  try {
    live_.reopen();
    next_tick_ = 0;
  } catch (const std::exception& error) {
    simulated_.reset();
    problem = QString::fromUtf8(error.what());
  }
  look();
  emit connection_changed();
  emit told(problem, true);
}

QString SessionController::last_fault() const {
  return live_.last_fault() ? words(describe(*live_.last_fault())) : QString();
}

void SessionController::record(const std::string& file) {
  QString problem;
  try {
    forget_marks();
    if (simulated_) move_hand(look_.probe_mm);  // where the new session finds it
    live_.record(file);
    recording_to_ = QString::fromStdString(file);
    next_tick_ = 0;
  } catch (const std::exception& error) {
    problem = QString::fromUtf8(error.what());
  }
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
  if (!live_.is_connected() || clutched_) return;
  letting_mark_go_ = false;
  live_.press(mark_button);
}

void SessionController::let_go_mark() {
  letting_mark_go_ = true;
}

FeltMark SessionController::mark_here() const {
  TickRecord pressed = look_.tick;
  pressed.buttons = mark_button;
  MarkPresses once;
  once.take({.tick = pressed,
             .time_s = pressed.time_s,
             .proxy_mm = look_.proxy_mm,
             .shares = look_.shares,
             .scene = live_.scene()});
  return std::get<FeltMark>(*once.finish());
}

/// What is being pressed makes nothing.
void SessionController::forget_marks() {
  live_.press(0);
  presses_.drop();
  letting_mark_go_ = false;
}

/// A press is in the ticks, as the stylus' own is: what is marked here is what a recording holds.
void SessionController::follow_marks() {
  const TickRecord& tick = look_.tick;
  if (clutched_) {
    presses_.drop();  // hand and patient are parted
    return;
  }
  const bool is_pressed = (tick.buttons & mark_button) != 0;
  if (!is_pressed && !presses_.is_down()) return;
  if (is_pressed && std::exchange(letting_mark_go_, false)) live_.press(0);
  const modes::Workspace reach = modes::between(before_, now_, tick.change_part);
  const auto made = presses_.take({.tick = tick,
                                   .time_s = tick.time_s,
                                   .proxy_mm = reach.to_patient(vector_of(tick.proxy_m)),
                                   .shares = look_.shares,
                                   .scene = live_.scene()});
  if (made) emit marked(*made);
}

void SessionController::clutch() {
  if (!live_.is_connected() || clutched_) return;
  forget_marks();
  clutched_ = true;
  clutched_at_mm_ = look_.probe_mm;
  feels_after_clutch_ = feels();
  live_.release();
}

void SessionController::unclutch(const glm::dmat3& rotation) {
  if (!std::exchange(clutched_, false)) return;
  const glm::dvec3 hand_m = vector_of(look_.tick.probe_m);
  const modes::Workspace held{.center_mm = {}, .rotation = rotation, .mm_per_m = now_.mm_per_m};
  const glm::dvec3 center = clutched_at_mm_ - held.to_patient(hand_m);
  model_.edit(tr("Clutch"), [&](modes::Scene& scene) {
    scene.workspace = {.center_mm = center, .rotation = rotation, .scale = now_.mm_per_m / 1e3, .fit = false};
  });
  before_ = now_;  // nothing is shown on its way: hand and patient were parted
  if (std::exchange(feels_after_clutch_, false)) feel();
}

bool SessionController::may_remap() const {
  return !live_.is_connected() || clutched_ || look_.force_n == 0;
}

void SessionController::move_hand(const glm::dvec3& patient_mm) {
  letting_go_ = false;
  hand_mm_ = patient_mm;
  if (simulated_) simulated_->move_target(now_.to_device(patient_mm));
}

void SessionController::let_go() {
  letting_go_ = simulated_ != nullptr;
  hand_mm_.reset();
}

/// To the proxy and a little beyond: the arm's own friction keeps a hand that goes no farther inside.
void SessionController::give_way() {
  constexpr double nothing_n = 0.02, beyond = 0.5;
  if (!letting_go_ || !simulated_) return;
  const glm::dvec3 proxy_m = vector_of(look_.tick.proxy_m);
  simulated_->move_target(proxy_m + beyond * (proxy_m - vector_of(look_.tick.probe_m)));
  if (look_.force_n < nothing_n) letting_go_ = false;
}

void SessionController::obey_buttons(std::uint32_t pressed, std::uint32_t let) {
  // Where one key is both (the Falcon's in the middle) it is the first.
  if ((pressed & release_button) != 0 && (pressed & clutch_button) == 0) release();
  if ((pressed & clutch_button) != 0) clutch();
  if ((let & clutch_button) != 0) emit clutch_button_let_go();
}

void SessionController::look() {
  const TickRing* const ring = live_.ticks();
  look_.connected = live_.is_connected();
  look_.clutched = clutched_;
  look_.kept_off = kept_off_;
  look_.peak_n = 0;
  if (!look_.connected) {
    look_ = instead_ ? instead_() : SessionStatus{};
    emit looked(look_);
    return;
  }
  std::vector<double> ticks;
  std::uint32_t pressed = 0, let = 0;  // in any tick: a short press counts though this thread was busy
  const std::uint64_t written = ring->written();
  next_tick_ = std::max(next_tick_, ring->oldest());
  for (; next_tick_ < written; ++next_tick_) {
    look_.shares.clear();
    if (!ring->read(next_tick_, look_.tick, &look_.shares)) continue;
    look_.fresh = true;
    look_.peak_n = std::max(look_.peak_n, glm::length(vector_of(look_.tick.sent_n)));
    ticks.push_back(tick_us(look_.tick));
    pressed |= look_.tick.buttons & ~buttons_;
    let |= buttons_ & ~look_.tick.buttons;
    buttons_ = look_.tick.buttons;
    follow_marks();
  }
  if (!ticks.empty()) look_.tick_us = io::quantile(std::move(ticks), 0.5);
  const TickRecord& tick = look_.tick;
  const bool is_silent = fault_of(tick) == device::Fault::commander_silent;
  if (!is_silent) look_.held_up.clear();
  if (is_silent && look_.held_up.isEmpty()) look_.held_up = slow_.in_words();
  look_.feels = feels();
  look_.workspace = modes::between(before_, now_, tick.change_part);
  look_.probe_mm = clutched_ ? clutched_at_mm_ : look_.workspace.to_patient(vector_of(tick.probe_m));
  look_.proxy_mm = clutched_ ? clutched_at_mm_ : look_.workspace.to_patient(vector_of(tick.proxy_m));
  look_.force_n = glm::length(vector_of(tick.sent_n));
  look_.missed = live_.missed();
  look_.homing = homing_;
  look_.trouble = QString::fromStdString(live_.trouble());
  look_.orientation.reset();
  if (const auto turned = live_.orientation()) {
    look_.orientation = glm::normalize(glm::quat_cast(look_.workspace.rotation) * *turned);
  }
  look_.tissue = tissue_name(model_.scene(), live_.scan() ? live_.scan()->unit : std::string(), tick.value);
  // A tick of before the last edit may tell of others.
  look_.nearest.reset();
  if (const auto plan = live_.plan(); plan && tick.scene_epoch == live_.epoch()) {
    look_.nearest = nearest_structure(tick, model_.scene(), plan->structures);
  }
  const auto held =
      held_boundary(look_.shares, live_.felt(), live_.scene(), look_.proxy_mm, look_.probe_mm, sites_.get());
  look_.held = held ? in_words(*held) : "";
  // On an edge the value is one of neither side: half-way from air to muscle it is fat's.
  if (held && live_.scene().modes[held->mode].structure.empty()) look_.tissue = "between tissues";
  obey_buttons(pressed, let);
  give_way();
  emit looked(look_);
}

}  // namespace palpate::plugin
