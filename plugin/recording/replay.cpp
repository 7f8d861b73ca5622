#include "plugin/recording/replay.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <stdexcept>
#include <vector>

#include "device/simulated/replay_stylus.h"
#include "plugin/messages/messages.h"

namespace palpate::plugin {
namespace {

/// Poses and states as the session got them, whichever stylus they came from.
struct Poses {
  std::vector<device::Reading> readings;
  std::vector<device::State> states;
};

Poses poses_of(std::span<const TickRecord> ticks) {
  Poses poses;
  poses.readings.reserve(ticks.size());
  poses.states.reserve(ticks.size());
  for (const TickRecord& tick : ticks) {
    poses.readings.push_back({.time = tick.pose_time_s,
                              .position = vector_of(tick.probe_m),
                              .buttons = tick.buttons,
                              .fresh = tick.fresh != 0});
    poses.states.push_back(static_cast<device::State>(tick.stylus_state));
  }
  return poses;
}

/// One of the session's styluses. All of them continue to read the same recorded poses, so opening and closing one does
/// not affect the others.
class RecordedStylus final : public device::Stylus {
 public:
  RecordedStylus(std::optional<device::ReplayStylus>& poses, const StylusRecord& record) : poses_(poses) {
    specification_.force_axes = record.force_axes;
    specification_.maximum_force = record.maximum_force_n;
  }
  device::Specification specification() const override { return specification_; }
  void open() override {}
  void close() noexcept override {}
  device::Reading read() noexcept override { return poses_->read(); }
  void write_force(const device::Vec3& /*force*/) noexcept override {}
  device::State state() const noexcept override { return poses_->state(); }

 private:
  std::optional<device::ReplayStylus>& poses_;
  device::Specification specification_;
};

template <typename Record>
const Record& find_epoch(const std::vector<Record>& records, std::uint32_t epoch, const char* what) {
  const auto found =
      std::find_if(records.begin(), records.end(), [&](const Record& record) { return record.epoch == epoch; });
  if (found == records.end()) {
    throw DamagedRecording(say("recording-lacks", what, epoch));
  }
  return *found;
}

/// Each epoch has its record, also one that was never taken: so they only ascend, and none is passed over unrecorded.
/// Else the session would be asked to count through up to 2^32 of them.
template <typename Record>
void check_next(const std::vector<Record>& records, std::uint32_t epoch, std::uint32_t next, const char* what) {
  const auto between = std::ranges::count_if(
      records, [&](const Record& record) { return record.epoch > epoch && record.epoch <= next; });
  if (next < epoch || next - epoch > between) {
    throw DamagedRecording(say("recording-goes-on-from-to", what, epoch, next));
  }
}

/// Infinite if one of the two is not a number: then no later difference is larger. A session only replays numbers.
double apart(const double (&recorded)[3], const double (&repeated)[3]) {
  const double distance = glm::length(vector_of(recorded) - vector_of(repeated));
  return std::isnan(distance) ? std::numeric_limits<double>::infinity() : distance;
}

void compare(const TickRecord& recorded, const TickRecord& repeated, Replay& result) {
  ++result.ticks;
  if (!same_in_replay(recorded, repeated)) {
    ++result.different;
    result.first_different = result.first_different.value_or(recorded.index);
  }
  result.largest_proxy_m = std::max(result.largest_proxy_m, apart(recorded.proxy_m, repeated.proxy_m));
  result.largest_force_n = std::max(result.largest_force_n, apart(recorded.sent_n, repeated.sent_n));
  const double bound = recorded.error_bound_m + repeated.error_bound_m;
  if (std::isfinite(bound)) {  // an answer without a bound excuses nothing
    result.largest_bound_m = std::max(result.largest_bound_m, bound);
  }
}

}  // namespace

struct Replayer::Progress {
  std::shared_ptr<device::Stylus> stylus(std::uint32_t epoch) {
    return std::make_shared<RecordedStylus>(poses, find_epoch(styluses, epoch, "stylus"));
  }
  Snapshot snapshot(std::uint32_t epoch) const { return make_snapshot(find_epoch(scenes, epoch, "scene")); }
  void repeat_commands(std::span<const TickRecord> coming);

  SnapshotMaker make_snapshot;
  Replay result;
  std::vector<SceneRecord> scenes;
  std::vector<StylusRecord> styluses;
  std::uint64_t next = 0;  ///< index of the tick that comes next, unless some were lost
  std::uint32_t scene_epoch = 0;
  std::uint32_t stylus_epoch = 0;
  std::optional<device::ReplayStylus> poses;
  std::unique_ptr<Session> session;
};

/// Repeats the commands given to the session before the first of the coming ticks.
void Replayer::Progress::repeat_commands(std::span<const TickRecord> coming) {
  const TickRecord& tick = coming.front();
  if (tick.scene_epoch != scene_epoch) {
    // Some that were published were never taken; they have numbers, too.
    Snapshot taken = snapshot(tick.scene_epoch);
    taken.is_replayed = true;
    if (tick.change_part >= 1) taken.change_s = 0;  // its workspace came at once
    check_next(scenes, scene_epoch, tick.scene_epoch, "scene");
    while (scene_epoch != tick.scene_epoch) scene_epoch = session->publish(taken);
  }
  if ((tick.commands & command::change_stylus) != 0) {
    const auto taken = std::find_if(coming.begin(), coming.end(),
                                    [&](const TickRecord& later) { return later.stylus_epoch != stylus_epoch; });
    // A stylus that the recording never reaches can be the previous one: no pose of it is read.
    const auto changed = stylus(taken == coming.end() ? stylus_epoch : taken->stylus_epoch);
    if (taken != coming.end()) check_next(styluses, stylus_epoch, taken->stylus_epoch, "stylus");
    const std::uint32_t epoch = taken == coming.end() ? stylus_epoch + 1 : taken->stylus_epoch;
    while (stylus_epoch != epoch) stylus_epoch = session->change_stylus(changed);
  }
  if ((tick.commands & command::clear_fault) != 0) session->clear_fault();
  if ((tick.commands & command::disarm) != 0) session->disarm();
  if ((tick.commands & command::arm) != 0) session->arm();
}

Replayer::Replayer(SnapshotMaker make_snapshot) : progress_(std::make_unique<Progress>()) {
  progress_->make_snapshot = std::move(make_snapshot);
}

Replayer::~Replayer() = default;

const Replay& Replayer::result() const noexcept {
  return progress_->result;
}

void Replayer::feed(const Recording& part) {
  Progress& progress = *progress_;
  progress.scenes.insert(progress.scenes.end(), part.scenes.begin(), part.scenes.end());
  progress.styluses.insert(progress.styluses.end(), part.styluses.begin(), part.styluses.end());
  std::size_t unbroken = 0;
  while (unbroken < part.ticks.size() && part.ticks[unbroken].index == progress.next + unbroken) {
    ++unbroken;
  }
  const std::span<const TickRecord> ticks = std::span(part.ticks).first(unbroken);
  progress.next += unbroken;
  progress.result.after_gap += part.ticks.size() - unbroken;
  if (ticks.empty()) {
    return;
  }
  const Poses poses = poses_of(ticks);
  progress.poses.emplace(poses.readings, poses.states);
  progress.poses->open();
  if (!progress.session) {
    progress.session = std::make_unique<Session>(progress.snapshot(0), progress.stylus(0));
  }
  for (std::size_t n = 0; n < ticks.size(); ++n) {
    const TickRecord& tick = ticks[n];
    progress.repeat_commands(ticks.subspan(n));
    compare(
        tick,
        progress.session->tick(
            {.time_s = tick.time_s, .heartbeat_s = tick.heartbeat_s, .missed = tick.missed, .late_ns = tick.late_ns}),
        progress.result);
    progress.poses->write_force(vector_of(tick.sent_n));
  }
  progress.session->collect();
  progress.poses.reset();
  // Epochs ascend, so finished ones can be dropped, however long the session is.
  std::erase_if(progress.scenes, [&](const SceneRecord& record) { return record.epoch < progress.scene_epoch; });
  std::erase_if(progress.styluses, [&](const StylusRecord& record) { return record.epoch < progress.stylus_epoch; });
}

Replay replay(const Recording& recording, const SnapshotMaker& make_snapshot) {
  Replayer replayer(make_snapshot);
  replayer.feed(recording);
  return replayer.result();
}

}  // namespace palpate::plugin
