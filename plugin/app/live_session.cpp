#include "plugin/app/live_session.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <stdexcept>
#include <thread>
#include <utility>

#include "device/simulated/simulated_stylus.h"
#include "io/fields/filtered.h"
#include "io/fields/gradient.h"
#include "modes/scene/scene_json.h"
#include "plugin/app/recording_header.h"
#include "plugin/messages/messages.h"
#include "plugin/report/held_boundary.h"
#include "plugin/session/felt_limits.h"
#include "plugin/session/scan_hash.h"

namespace palpate::plugin {
namespace {

constexpr double dragged_s = 0.02;  // a small dragged change is there before the next one comes

/// The largest change of a value at a node; where nodes came or went, of the curve at any node.
double change_of(const modes::TransferFunction& from, const modes::TransferFunction& to) {
  const auto before = from.nodes(), after = to.nodes();
  const bool moved = before.size() == after.size();
  double most = 0;
  for (std::size_t n = 0; n < after.size(); ++n) {
    most = std::max(most, std::abs(after[n].value - (moved ? before[n].value : from(after[n].at))));
  }
  for (std::size_t n = 0; n < before.size() && !moved; ++n) {
    most = std::max(most, std::abs(before[n].value - to(before[n].at)));
  }
  return most;
}

/// By how many N a drag from one scene to another may change the force of its modes together.
double change_n(const modes::Scene& from, const modes::Scene& to) {
  if (from.modes.size() != to.modes.size()) return std::numeric_limits<double>::infinity();
  double sum_n = 0;
  for (std::size_t n = 0; n < to.modes.size(); ++n) {
    const modes::Mode &before = from.modes[n], &after = to.modes[n];
    if (before.gates.size() != after.gates.size()) return std::numeric_limits<double>::infinity();
    const modes::TransferFunction none;
    sum_n += change_of(before.enabled ? before.strength_n : none, after.enabled ? after.strength_n : none);
    for (std::size_t gate = 0; gate < after.gates.size(); ++gate) {
      sum_n += change_of(before.gates[gate].factor, after.gates[gate].factor) * after.strength_n.maximum();
    }
  }
  return sum_n;
}

bool ended_in_fault(const TickRing& ring) {
  TickRecord tick;
  const std::uint64_t written = ring.written();
  return written > 0 && ring.read(written - 1, tick) && fault_of(tick) != device::Fault::none;
}

}  // namespace

LiveSession::~LiveSession() {
  disconnect();
}

device::Specification LiveSession::planned_for() const {
  return is_connected() ? specification_ : device::SimulatedStylus().specification();
}

PreparedScene LiveSession::felt_of(const modes::Scene& scene, const std::shared_ptr<const io::Volume>& volume) const {
  if (!volume) return {};
  const device::Specification stylus = planned_for();
  const std::shared_ptr<const io::Volume>& ahead = offered_.volume;
  const bool of_scan = ahead && io::raw_of(ahead) == io::raw_of(volume);
  const bool filtered = of_scan && io::filter_of(*ahead) == scene.filter;
  Prepared before = this->before();
  if (of_scan) before.read_ahead = offered_.structures;
  return prepare(suited_to(scene, stylus), filtered ? ahead : volume, stylus.workspace_half_extent, before);
}

bool LiveSession::is_ahead_of(const std::shared_ptr<const io::Volume>& scan) const {
  return offered_.volume && scan && io::raw_of(offered_.volume) == io::raw_of(scan);
}

std::vector<LoadedStructure> LiveSession::at_hand(const std::shared_ptr<const io::Volume>& scan) const {
  std::vector<LoadedStructure> all;
  if (io::raw_of(scan) == volume_) {
    all = felt_.structures;
  } else if (volume_) {
    all = carried_over(felt_.structures, *volume_, *scan);
  }
  if (is_ahead_of(scan)) all.insert(all.end(), offered_.structures.begin(), offered_.structures.end());
  return all;
}

bool LiveSession::has_read(const modes::Scene& scene, const std::shared_ptr<const io::Volume>& scan) const {
  if (!scan) return true;
  const device::Specification stylus = planned_for();
  const modes::Scene suited = suited_to(scene, stylus);
  const io::Volume& nearest = is_ahead_of(scan) ? *offered_.volume : *scan;
  if (io::raw_of(scan) != volume_ && io::filter_of(nearest) != scene.filter) return false;
  return scene.structures.empty() ||
         are_loaded(suited, *plan_for(suited, *scan, stylus.workspace_half_extent), at_hand(scan));
}

std::function<PreparedScene()> LiveSession::reading(const modes::Scene& scene,
                                                    const std::shared_ptr<const io::Volume>& scan) const {
  const device::Specification stylus = planned_for();
  const bool is_other = io::raw_of(scan) != volume_;
  const std::shared_ptr<const io::Volume> felt = is_other ? scan : felt_.volume;
  return [suited = suited_to(scene, stylus), scan, is_other, felt = is_ahead_of(scan) ? offered_.volume : felt,
          extent = stylus.workspace_half_extent, before = at_hand(scan)]() -> PreparedScene {
    const bool is_filtered = !is_other || io::filter_of(*felt) == suited.filter;
    return {.plan = nullptr,
            .source = nullptr,
            .volume = is_filtered ? felt : io::filtered(scan, suited.filter),
            .structures = load_structures(suited, *plan_for(suited, *scan, extent), scan, before)};
  };
}

Snapshot LiveSession::snapshot(double change_s) const {
  Snapshot snapshot = snapshot_of(scene_, felt_, specification_);
  snapshot.change_s = change_s;
  return snapshot;
}

double LiveSession::ramp_s() const {
  return limits_for(scene_.limits, specification_).ramp_time;
}

std::vector<Text> LiveSession::drawn_down() const {
  return is_connected() ? plugin::drawn_down(scene_, specification_) : std::vector<Text>();
}

AsRecorded LiveSession::as_recorded(double change_s) const {
  return [this, change_s](std::uint32_t epoch) {
    SceneRecord record = record_of(suited_to(scene_, specification_), felt_, specification_, scan_hash());
    record.epoch = epoch;
    record.change_s = change_s;
    record.frame = frame_;
    return RecordedScene{std::move(record), known_to_of_ticks(felt_, scene_)};
  };
}

const std::string& LiveSession::scan_hash() const {
  if (scan_hash_.empty()) scan_hash_ = hash_of(*volume_);
  return scan_hash_;
}

void LiveSession::publish(double change_s) {
  if (is_connected()) last_epoch_ = running_->publish(snapshot(change_s), as_recorded(change_s));
}

void LiveSession::set_scan(std::shared_ptr<const io::Volume> volume, const modes::Scene& scene,
                           const ScanFrame& frame) {
  if (!volume) {
    disconnect();
    modes::validate(scene);
  }
  felt_ = felt_of(scene, volume);
  scene_ = scene;
  volume = io::raw_of(volume);
  if (volume != volume_) scan_hash_.clear();
  volume_ = std::move(volume);
  frame_ = frame;
  offered_ = {};
  publish(ramp_s());
}

void LiveSession::set_scene(const modes::Scene& scene, Pace pace) {
  if (!volume_) modes::validate(scene);  // else its plan does
  felt_ = felt_of(scene, volume_);
  offered_ = {};
  double change_s = 0;
  if (pace != Pace::at_once) {
    const device::SafetyLimits limits = limits_for(scene.limits, specification_);
    change_s = limits.ramp_time;
    // A number that is typed, or a mouse after a pause, can jump: no change is faster than the ramp of a force.
    if (pace == Pace::dragged) {
      const double part = limits.force > 0 ? change_n(scene_, scene) / limits.force : 1;
      change_s = std::clamp(change_s * part, std::min(dragged_s, change_s), change_s);
    }
  }
  scene_ = scene;
  publish(change_s);
}

void LiveSession::connect(std::shared_ptr<device::Stylus> stylus, Start start) {
  if (!volume_) throw Refusal(say("there-is-no-scan-to-feel-yet"));
  disconnect();
  start_ = start;
  begin(std::move(stylus), {});
}

void LiveSession::begin(std::shared_ptr<device::Stylus> stylus, const std::optional<std::filesystem::path>& file) {
  const PreparedScene before = felt_;
  last_epoch_ = 0;
  faults_ = 0;
  last_fault_.reset();
  try {
    stylus_ = std::move(stylus);
    OpenStylus open(stylus_);
    specification_ = open.specification();  // of the device that is there
    felt_ = prepare(suited_to(scene_, specification_), volume_, specification_.workspace_half_extent, this->before());
    RunningSession::Start start{
        .snapshot = snapshot(ramp_s()), .as_recorded = as_recorded(ramp_s()), .is_released = start_ == Start::released};
    if (file) {
      start.recording =
          RecordingTo{*file, header_for(suited_to(scene_, specification_), specification_, scan_hash()), {}};
    }
    running_ = std::make_unique<RunningSession>(std::move(open), start);
    const double period_s = 1 / specification_.rate;
    running_->start_servo(make_clock_(period_s), period_s);
  } catch (...) {
    end();
    felt_ = before;
    throw;
  }
}

std::optional<RecorderStatus> LiveSession::end() noexcept {
  auto recorded = running_ ? running_->end() : std::nullopt;
  stylus_.reset();
  return recorded;
}

std::optional<RecorderStatus> LiveSession::disconnect() noexcept {
  if (is_connected()) {
    release();
    TickRecord tick;
    constexpr int longest_ms = 100;
    for (int ms = 0; ms < longest_ms; ++ms) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      const std::uint64_t written = running_->ring().written();
      const bool zero = written > 0 && running_->ring().read(written - 1, tick) &&
                        std::all_of(std::begin(tick.sent_n), std::end(tick.sent_n), [](double n) { return n == 0; });
      if (zero && ms > 2) break;  // the release has been heard
    }
  }
  return end();
}

double LiveSession::allowed_force_n() const noexcept {
  return stylus_ ? stylus_->allowed_force() : std::numeric_limits<double>::infinity();
}

void LiveSession::feel() noexcept {
  start_ = Start::feeling;
  if (is_connected()) running_->session().arm();
}

void LiveSession::release() noexcept {
  start_ = Start::released;
  if (is_connected()) running_->session().disarm();
}

void LiveSession::press(std::uint32_t buttons) noexcept {
  if (is_connected()) running_->session().press(buttons);
}

void LiveSession::clear_fault() noexcept {
  start_ = Start::released;
  if (is_connected()) running_->session().clear_fault();
}

void LiveSession::heartbeat() {
  if (!is_connected()) return;
  running_->servo()->heartbeat();
  Session& session = running_->session();
  session.collect();
  if (session.faults() != faults_) {
    faults_ = session.faults();
    last_fault_ = keep_fault(session.fault_ticks(), specification_.name);
  }
}

std::optional<glm::dquat> LiveSession::orientation() const noexcept {
  if (!is_connected() || specification_.orientation_axes == 0) return {};
  return running_->session().orientation();
}

void LiveSession::reopen() {
  if (!is_connected()) throw Refusal(say("no-stylus-is-held"));
  std::shared_ptr<device::Stylus> stylus = stylus_;
  disconnect();
  start_ = Start::released;
  begin(std::move(stylus), {});
}

void LiveSession::record(const std::filesystem::path& file) {
  if (!is_connected()) throw Refusal(say("no-stylus-is-held"));
  std::shared_ptr<device::Stylus> stylus = stylus_;
  const Start before = start_;
  disconnect();
  start_ = ended_in_fault(running_->ring()) ? Start::released : before;
  try {
    begin(stylus, file);
  } catch (...) {
    begin(std::move(stylus), {});
    throw;
  }
}

std::optional<RecorderStatus> LiveSession::stop_recording() {
  return running_ ? running_->stop_recording() : std::nullopt;
}

std::optional<RecorderStatus> LiveSession::recording() const {
  if (!running_ || running_->recorder() == nullptr) return {};
  return running_->recorder()->status();
}

}  // namespace palpate::plugin
