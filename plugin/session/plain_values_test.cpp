/// What plain values say before anybody has set them: nothing. Older recordings, and callers that name only some of the
/// members, rely on it.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <string>

#include "io/bounding_box.h"
#include "plugin/recording/marks.h"
#include "plugin/recording/recorder.h"
#include "plugin/recording/replay.h"
#include "plugin/session/path.h"
#include "plugin/session/press_path.h"
#include "plugin/session/servo_clock.h"
#include "plugin/session/session.h"
#include "plugin/session/stroke.h"

namespace palpate::plugin {
namespace {

/// Of a value without padding.
template <typename T>
bool is_all_zero(const T& value) {
  const auto* const bytes = reinterpret_cast<const unsigned char*>(&value);
  return std::all_of(bytes, bytes + sizeof value, [](unsigned char byte) { return byte == 0; });
}

const glm::dvec3 origin(0);

TEST(PlainValues, ATickSaysNothingButThatNoChangeIsOnItsWay) {
  TickRecord tick;
  EXPECT_EQ(tick.change_part, 1);
  tick.change_part = 0;
  EXPECT_TRUE(is_all_zero(tick));
  EXPECT_TRUE(is_all_zero(PrimitiveRecord()));
  const Beat beat;
  EXPECT_EQ(beat.time_s, 0);
  EXPECT_EQ(beat.heartbeat_s, 0);
  EXPECT_EQ(beat.missed, 0U);
  EXPECT_EQ(beat.late_ns, 0U);
  const ServoClock::Deadline deadline;
  EXPECT_TRUE(deadline.due);
  EXPECT_EQ(deadline.late_s, 0);
  EXPECT_EQ(deadline.skipped, 0U);
  EXPECT_EQ(Snapshot().change_s, 0.5) << "as long as a scene that is recorded without it";
}

TEST(PlainValues, AStrokesPointSaysNothing) {
  const StrokePoint point;
  EXPECT_EQ(point.position_mm, origin);
  EXPECT_EQ(point.proxy_mm, origin);
  EXPECT_EQ(point.force_n, origin);
  EXPECT_EQ(point.value, 0);
  EXPECT_EQ(point.value_passed, 0);
  EXPECT_TRUE(is_all_zero(point.distance_mm));
  EXPECT_EQ(point.solver, nullptr);
  EXPECT_EQ(point.error_bound_m, 0);
  EXPECT_FALSE(point.boundary || point.primitive);
  EXPECT_TRUE(is_all_zero(Contact()));
  const PathPoint of_path;
  EXPECT_EQ(of_path.time_s, 0);
  EXPECT_EQ(of_path.position_mm, origin);
  EXPECT_EQ(of_path.buttons, 0U);
  EXPECT_EQ(PressPath().inward, glm::dvec3(0, 0, 1)) << "a unit vector from the start";
  EXPECT_EQ(PressPath().contact_mm, origin);
  EXPECT_TRUE(is_all_zero(io::Box()));
}

TEST(PlainValues, ARecordingsPartsSayWhatIsTrueWithoutThem) {
  EXPECT_EQ(RecordingHeader().seed, 0);
  EXPECT_EQ(RecordingHeader().rate_hz, 1000);
  EXPECT_EQ(ScanFrame().number, 0) << "the only one";
  EXPECT_EQ(ScanFrame().count, 1);
  const SceneRecord scene;
  EXPECT_EQ(scene.epoch, 0U);
  EXPECT_EQ(scene.half_extent_m, origin);
  EXPECT_EQ(scene.maximum_force_n, 1e9) << "no limit";
  EXPECT_EQ(scene.change_s, 0.5);
  EXPECT_FALSE(scene.frame);
  const StylusRecord stylus;
  EXPECT_EQ(stylus.epoch, 0U);
  EXPECT_EQ(stylus.force_axes, 3);
  EXPECT_EQ(stylus.maximum_force_n, 1e9);
  EXPECT_TRUE(is_all_zero(Gap()));
  EXPECT_TRUE(Recording().complete);
  const RecorderStatus status;
  EXPECT_EQ(status.written, 0U);
  EXPECT_EQ(status.lost, 0U);
  EXPECT_FALSE(status.stopped);
  const RecorderOptions options;
  EXPECT_EQ(options.spare_bytes, 64U * 1024 * 1024);
  EXPECT_EQ(options.most_behind, 250U) << "a quarter of a second";
  const Replay replay;
  EXPECT_EQ(replay.ticks, 0U);
  EXPECT_EQ(replay.different, 0U);
  EXPECT_FALSE(replay.first_different);
  EXPECT_EQ(replay.largest_proxy_m, 0);
  EXPECT_EQ(replay.largest_force_n, 0);
  EXPECT_EQ(replay.largest_bound_m, 0);
  EXPECT_EQ(replay.after_gap, 0U);
}

TEST(PlainValues, AMarkSaysNothing) {
  const FeltMark mark;
  EXPECT_EQ(mark.tick, 0U);
  EXPECT_EQ(mark.time_s, 0);
  EXPECT_EQ(mark.position_mm, origin);
  EXPECT_EQ(mark.value, 0);
  EXPECT_EQ(mark.force_n, 0);
  EXPECT_EQ(MarkedPath().begin_s, 0);
  EXPECT_EQ(MarkedPath().end_s, 0);
  EXPECT_EQ(MarkedPath().length_mm, 0);
  EXPECT_TRUE(is_all_zero(MarkedDistance()));
  EXPECT_TRUE(is_all_zero(MarkedAngle()));
  const TickRecord tick;
  const modes::Scene scene;
  const MarkPresses::Moment moment{.tick = tick, .shares = {}, .scene = scene};
  EXPECT_EQ(moment.time_s, 0);
  EXPECT_EQ(moment.proxy_mm, origin);
}

}  // namespace
}  // namespace palpate::plugin
