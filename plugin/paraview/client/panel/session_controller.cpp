#include "plugin/paraview/client/panel/session_controller.h"

#include <algorithm>
#include <exception>
#include <glm/geometric.hpp>
#include <utility>

#include "io/fields/volume_fields.h"
#include "plugin/app/stylus_choice.h"
#include "plugin/report/live_view.h"
#include "plugin/report/summary.h"

namespace palpate::plugin {
namespace {

constexpr int heart_ms = 100;
constexpr int look_ms = 33;
constexpr std::uint32_t clutch_button = 1, release_button = 2;

glm::dvec3 vector_of(const double (&from)[3]) {
  return {from[0], from[1], from[2]};
}

}  // namespace

SessionController::SessionController(SceneModel& model, QObject* parent) : QObject(parent), model_(model) {
  connect(&model, &SceneModel::changed, this, [this](Pace pace) { follow_scene(pace); });
  connect(&heart_, &QTimer::timeout, this, [this] { live_.heartbeat(); });
  connect(&looks_, &QTimer::timeout, this, [this] { look(); });
  looks_.setTimerType(Qt::PreciseTimer);
  heart_.start(heart_ms);
  looks_.start(look_ms);
}

SessionController::~SessionController() {
  live_.disconnect();
}

void SessionController::set_no_scan(const QString& why) {
  why_no_scan_ = why;
  live_.set_scan(nullptr);
  simulated_.reset();
  clutched_ = false;
  look();
  emit connection_changed();
}

void SessionController::set_scan(std::shared_ptr<const io::Volume> volume) {
  why_no_scan_.clear();
  try {
    live_.set_scan(std::move(volume));
  } catch (const std::exception& error) {
    live_.set_scan(nullptr);
    emit told(QString::fromUtf8(error.what()), true);
  }
  if (live_.plan()) before_ = now_ = live_.plan()->workspace;
  emit connection_changed();
}

void SessionController::follow_scene(Pace pace) {
  try {
    live_.set_scene(model_.scene(), pace);
    if (live_.plan()) before_ = std::exchange(now_, live_.plan()->workspace);
    if (before_ != now_) hand_mm_.reset();
  } catch (const std::exception& error) {
    emit told(QString::fromUtf8(error.what()), true);
  }
}

/// In front of the patient: a finger's breadth before what is met first on the way to the middle.
glm::dvec3 SessionController::first_place() const {
  const io::Volume& volume = *live_.scan();
  const Box box = bounding_box(volume.geometry);
  const io::VolumeFields fields(live_.scan(), io::FieldSet::value, 1, {.brick_bytes = 0, .background = false});
  const glm::dvec3 middle = (box.low + box.high) / 2.0;
  constexpr double step_mm = 1, before_mm = 15, tissue_part = 0.15;
  double lowest = 1e300, highest = -1e300;
  std::vector<std::pair<double, double>> along;  // y, value
  for (double y = box.low.y; y < middle.y; y += step_mm) {
    const io::Sample sample = fields.sample({middle.x, y, middle.z}, io::FieldSet::value);
    if (!sample.inside) continue;
    along.emplace_back(y, sample.value);
    lowest = std::min(lowest, sample.value);
    highest = std::max(highest, sample.value);
  }
  const double tissue = volume.unit == "HU" ? -300 : lowest + tissue_part * (highest - lowest);
  const auto met = std::find_if(along.begin(), along.end(), [&](const auto& at) { return at.second > tissue; });
  if (met == along.end()) return middle;
  return {middle.x, std::max(met->first - before_mm, box.low.y), middle.z};
}

void SessionController::connect_stylus(const StylusChoice& choice) {
  if (!live_.scan() && !why_no_scan_.isEmpty()) {
    emit told(why_no_scan_, true);
    return;
  }
  try {
    const auto stylus =
        make_stylus({.device = choice.device, .firmware = choice.firmware, .settings = choice.settings});
    simulated_ = std::dynamic_pointer_cast<device::SimulatedStylus>(stylus);
    live_.connect(stylus);
    look_ = {};  // of a recording, perhaps
    hand_mm_.reset();
    buttons_ = 0;
    before_ = now_ = live_.plan()->workspace;
    next_frame_ = 0;
    clutched_ = false;
    if (simulated_) {
      // Its hand begins in the middle of the patient: nothing is felt before it has come to its place.
      live_.release();
      move_hand(first_place());
      constexpr int there_ms = 900;
      QTimer::singleShot(there_ms, this, [this, held = std::weak_ptr(simulated_)] {
        if (held.lock() == simulated_ && simulated_ && !clutched_) live_.feel();
      });
    }
    emit told({}, false);
  } catch (const std::exception& error) {
    simulated_.reset();
    emit told(QString::fromUtf8(error.what()), true);
  }
  emit connection_changed();
}

void SessionController::disconnect_stylus() {
  const auto recorded_now = live_.disconnect();
  simulated_.reset();
  clutched_ = false;
  look();
  emit connection_changed();
  tell_recorded(recorded_now);
}

void SessionController::feel() {
  clutched_ = false;
  live_.feel();
}

void SessionController::release() {
  live_.release();
}

void SessionController::clear_fault() {
  live_.clear_fault();
  live_.feel();
}

void SessionController::record(const std::string& file) {
  try {
    if (simulated_) move_hand(look_.probe_mm);  // where the new session finds it
    live_.record(file);
    recording_to_ = QString::fromStdString(file);
    next_frame_ = 0;
    emit told(tr("Recording: the session began anew, so that it can be repeated to the last bit."), false);
  } catch (const std::exception& error) {
    emit told(QString::fromUtf8(error.what()), true);
  }
  emit connection_changed();
}

void SessionController::stop_recording() {
  try {
    tell_recorded(live_.stop_recording());
  } catch (const std::exception& error) {
    emit told(QString::fromUtf8(error.what()), true);
  }
  emit connection_changed();
}

void SessionController::tell_recorded(const std::optional<RecorderStatus>& status) {
  if (!status) return;
  emit told(status->stopped ? QString::fromStdString(status->why)
                            : tr("Recorded: %1 frames, %2 lost.").arg(status->written).arg(status->lost),
            status->stopped);
  if (!status->stopped) emit recorded(recording_to_);
}

void SessionController::clutch() {
  if (!live_.is_connected() || clutched_) return;
  clutched_ = true;
  clutched_at_mm_ = look_.probe_mm;
  live_.release();
}

void SessionController::unclutch(const glm::dmat3& rotation) {
  if (!std::exchange(clutched_, false)) return;
  const glm::dvec3 hand_m = vector_of(look_.frame.probe_m);
  const modes::Workspace held{.center_mm = {}, .rotation = rotation, .mm_per_m = now_.mm_per_m};
  const glm::dvec3 center = clutched_at_mm_ - held.to_patient(hand_m);
  model_.edit(tr("Clutch"), [&](modes::Scene& scene) {
    scene.workspace = {.center_mm = center, .rotation = rotation, .scale = now_.mm_per_m / 1e3, .fit = false};
  });
  before_ = now_;  // nothing is shown on its way: hand and patient were parted
  live_.feel();
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
  const glm::dvec3 proxy_m = vector_of(look_.frame.proxy_m);
  simulated_->move_target(proxy_m + beyond * (proxy_m - vector_of(look_.frame.probe_m)));
  if (look_.force_n < nothing_n) letting_go_ = false;
}

void SessionController::obey_buttons(std::uint32_t buttons) {
  const std::uint32_t pressed = buttons & ~buttons_;
  const std::uint32_t let = buttons_ & ~buttons;
  buttons_ = buttons;
  if ((pressed & release_button) != 0) release();
  if ((pressed & clutch_button) != 0) clutch();
  if ((let & clutch_button) != 0) emit clutch_button_let_go();
}

void SessionController::look() {
  const TickRing* const ring = live_.frames();
  look_.connected = live_.is_connected();
  look_.clutched = clutched_;
  look_.peak_n = 0;
  if (!look_.connected) {
    look_ = instead_ ? instead_() : SessionStatus{};
    emit looked(look_);
    return;
  }
  std::vector<double> ticks;
  const std::uint64_t written = ring->written();
  next_frame_ = std::max(next_frame_, ring->oldest());
  for (; next_frame_ < written; ++next_frame_) {
    look_.shares.clear();
    if (!ring->read(next_frame_, look_.frame, &look_.shares)) continue;
    look_.fresh = true;
    look_.peak_n = std::max(look_.peak_n, glm::length(vector_of(look_.frame.sent_n)));
    ticks.push_back(tick_us(look_.frame));
  }
  if (!ticks.empty()) {
    const auto middle = ticks.begin() + static_cast<std::ptrdiff_t>(ticks.size() / 2);
    std::nth_element(ticks.begin(), middle, ticks.end());
    look_.tick_us = *middle;
  }
  const TickRecord& frame = look_.frame;
  look_.workspace = modes::between(before_, now_, frame.change_part);
  look_.probe_mm = clutched_ ? clutched_at_mm_ : look_.workspace.to_patient(vector_of(frame.probe_m));
  look_.proxy_mm = clutched_ ? clutched_at_mm_ : look_.workspace.to_patient(vector_of(frame.proxy_m));
  look_.force_n = glm::length(vector_of(frame.sent_n));
  look_.missed = live_.missed();
  look_.tissue = tissue_name(model_.scene(), live_.scan() ? live_.scan()->unit : std::string(), frame.value);
  obey_buttons(frame.buttons);
  give_way();
  emit looked(look_);
}

}  // namespace palpate::plugin
