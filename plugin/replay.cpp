#include "palpate/plugin/replay.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <stdexcept>
#include <vector>

#include "palpate/device/replay_stylus.h"

namespace palpate::plugin {
namespace {

glm::dvec3 vector_of(const double (&from)[3]) {
  return {from[0], from[1], from[2]};
}

/// Poses and states as the session got them, whichever stylus they came from.
struct Poses {
  std::vector<device::Reading> readings;
  std::vector<device::State> states;
};

Poses poses_of(std::span<const Frame> frames) {
  Poses poses;
  poses.readings.reserve(frames.size());
  poses.states.reserve(frames.size());
  for (const Frame& frame : frames) {
    poses.readings.push_back({.time = frame.pose_time_s,
                              .position = vector_of(frame.probe_m),
                              .buttons = frame.buttons,
                              .fresh = frame.fresh != 0});
    poses.states.push_back(static_cast<device::State>(frame.stylus_state));
  }
  return poses;
}

/// One of the session's styluses. All of them read on from the same recorded poses, so that opening and closing one
/// leaves the others where they are.
class RecordedStylus final : public device::Stylus {
 public:
  RecordedStylus(device::ReplayStylus& poses, const StylusRecord& record, double rate_hz) : poses_(poses) {
    specification_.name = record.name;
    specification_.force_axes = record.force_axes;
    specification_.maximum_force = record.maximum_force_n;
    specification_.rate = rate_hz;
  }
  device::Specification specification() const override { return specification_; }
  void open() override {}
  void close() noexcept override {}
  device::Reading read() noexcept override { return poses_.read(); }
  void write_force(const device::Vec3& force) noexcept override { force_ = force; }
  device::State state() const noexcept override { return poses_.state(); }

 private:
  device::ReplayStylus& poses_;
  device::Specification specification_;
  device::Vec3 force_{0};
};

template <typename Record>
const Record& find_epoch(const std::vector<Record>& records, std::uint32_t epoch, const char* what) {
  const auto found =
      std::find_if(records.begin(), records.end(), [&](const Record& record) { return record.epoch == epoch; });
  if (found == records.end()) {
    throw std::runtime_error(fmt::format("the recording lacks its {} {}", what, epoch));
  }
  return *found;
}

void compare(const Frame& recorded, const Frame& repeated, Replay& result) {
  ++result.frames;
  if (!same_in_replay(recorded, repeated)) {
    ++result.different;
    result.first_different = result.first_different.value_or(recorded.index);
  }
  const auto larger = [](double& largest, double value) {
    if (!(value <= largest)) largest = value;  // a NaN counts
  };
  larger(result.largest_proxy_m, glm::length(vector_of(recorded.proxy_m) - vector_of(repeated.proxy_m)));
  larger(result.largest_force_n, glm::length(vector_of(recorded.sent_n) - vector_of(repeated.sent_n)));
  larger(result.largest_bound_m, recorded.error_bound_m + repeated.error_bound_m);
}

/// The frames before the first that is missing.
std::span<const Frame> unbroken(const Recording& recording) {
  std::size_t count = 0;
  while (count < recording.frames.size() && recording.frames[count].index == count) {
    ++count;
  }
  return std::span(recording.frames).first(count);
}

}  // namespace

Replay replay(const Recording& recording, const SnapshotMaker& make_snapshot) {
  Replay result;
  const std::span<const Frame> frames = unbroken(recording);
  result.after_gap = recording.frames.size() - frames.size();
  if (frames.empty()) {
    return result;
  }
  const Poses poses = poses_of(frames);
  device::ReplayStylus source(poses.readings, poses.states);
  source.open();
  const auto stylus = [&](std::uint32_t epoch) {
    return std::make_shared<RecordedStylus>(source, find_epoch(recording.styluses, epoch, "stylus"),
                                            recording.header.rate_hz);
  };
  const auto snapshot = [&](std::uint32_t epoch) {
    return make_snapshot(find_epoch(recording.scenes, epoch, "scene"));
  };
  Session session(snapshot(frames.front().scene_epoch), stylus(frames.front().stylus_epoch));
  std::uint32_t scene_epoch = 0;
  std::uint32_t stylus_epoch = 0;
  for (std::size_t n = 0; n < frames.size(); ++n) {
    const Frame& frame = frames[n];
    if ((frame.commands & command::arm) != 0) session.arm();
    if ((frame.commands & command::disarm) != 0) session.disarm();
    if ((frame.commands & command::clear_fault) != 0) session.clear_fault();
    if (frame.scene_epoch != scene_epoch) {
      // Some that were published were never taken; they have numbers, too.
      const Snapshot next = snapshot(frame.scene_epoch);
      while (scene_epoch != frame.scene_epoch) scene_epoch = session.publish(next);
    }
    if ((frame.commands & command::change_stylus) != 0) {
      const auto taken = std::find_if(frames.begin() + static_cast<std::ptrdiff_t>(n), frames.end(),
                                      [&](const Frame& later) { return later.stylus_epoch != stylus_epoch; });
      const std::uint32_t epoch = taken == frames.end() ? stylus_epoch + 1 : taken->stylus_epoch;
      const auto next = taken == frames.end() ? stylus(stylus_epoch) : stylus(epoch);
      while (stylus_epoch != epoch) stylus_epoch = session.change_stylus(next);
    }
    compare(frame,
            session.tick({.time_s = frame.time_s,
                          .heartbeat_s = frame.heartbeat_s,
                          .missed = frame.missed,
                          .late_ns = frame.late_ns}),
            result);
    source.write_force(vector_of(frame.sent_n));
  }
  return result;
}

}  // namespace palpate::plugin
