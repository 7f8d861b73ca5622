#include "plugin/app/running_session.h"

#include <utility>

#include "modes/scene/scene_json.h"
#include "plugin/session/felt_limits.h"

namespace palpate::plugin {
namespace {

StylusRecord stylus_record(std::uint32_t epoch, const device::Specification& stylus) {
  return {
      .epoch = epoch, .name = stylus.name, .force_axes = stylus.force_axes, .maximum_force_n = stylus.maximum_force};
}

}  // namespace

Snapshot snapshot_of(const modes::Scene& scene, const PreparedScene& felt, const device::Specification& stylus) {
  return {.plan = felt.plan,
          .source = felt.source,
          .limits = limits_for(scene.limits, stylus),
          .change_s = limits_for(scene.limits, stylus).ramp_time};
}

Snapshot snapshot_of(const SceneRecord& record, const std::shared_ptr<const io::Volume>& volume,
                     StructureFiles& files) {
  const modes::Scene scene = files.with_paths(modes::scene_from_json(record.scene, "the recording's scene"));
  device::Specification stylus;
  stylus.maximum_force = record.maximum_force_n;
  Snapshot snapshot = snapshot_of(scene, prepare(scene, volume, record.half_extent_m, record.registered), stylus);
  snapshot.change_s = record.change_s;
  return snapshot;
}

Snapshot snapshot_of(const SceneRecord& record, const std::shared_ptr<const io::Volume>& volume) {
  StructureFiles none;
  return snapshot_of(record, volume, none);
}

RunningSession::RunningSession(OpenStylus stylus, const Start& start) : specification_(stylus.specification()) {
  if (start.recording) {
    record_to(*start.recording);
    RecordedScene first = start.as_recorded(0);
    recorder_->note(first.record, std::move(first.known_to));
    recorder_->note(stylus_record(0, specification_));
  }
  session_ = std::make_unique<Session>(start.snapshot, std::move(stylus), ring_.get());
  if (start.is_released) session_->disarm();  // before the first tick
}

RunningSession::~RunningSession() {
  end();
}

void RunningSession::start_servo() {
  servo_ = std::make_unique<Servo>(*session_, specification_.rate);
}

void RunningSession::start_servo(std::unique_ptr<ServoClock> clock, double period_s) {
  servo_ = std::make_unique<Servo>(*session_, std::move(clock), period_s);
}

std::uint32_t RunningSession::publish(const Snapshot& next, const AsRecorded& as_recorded) {
  ++scenes_;
  if (recorder_) {
    RecordedScene recorded = as_recorded(scenes_);
    recorder_->note(recorded.record, std::move(recorded.known_to));
  }
  return session_->publish(next);
}

std::uint32_t RunningSession::change_stylus(std::shared_ptr<device::Stylus> stylus,
                                            const device::Specification& specification) {
  ++styluses_;
  if (recorder_) recorder_->note(stylus_record(styluses_, specification));
  return session_->change_stylus(std::move(stylus));
}

void RunningSession::record_to(const RecordingTo& recording) {
  RecorderOptions options = recording.options;
  if (next_tick_) options.first_tick = next_tick_;
  recorder_ = std::make_unique<Recorder>(*ring_, recording.file, recording.header, std::move(options));
}

std::optional<RecorderStatus> RunningSession::stop_recording() {
  if (!recorder_) return {};
  const RecorderStatus status = recorder_->finish();
  next_tick_ = recorder_->next();
  recorder_.reset();
  return status;
}

void RunningSession::stop() noexcept {
  servo_.reset();
  session_.reset();
}

std::optional<RecorderStatus> RunningSession::end() noexcept {
  stop();
  return stop_recording();  // writes what is left
}

}  // namespace palpate::plugin
