#include "plugin/app/run_session.h"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <limits>
#include <optional>
#include <thread>

#include "modes/scene/scene_json.h"
#include "plugin/app/fault_report.h"
#include "plugin/app/interruptible.h"
#include "plugin/app/recording_header.h"
#include "plugin/messages/messages.h"
#include "plugin/messages/tell.h"
#include "plugin/report/held_boundary.h"
#include "plugin/report/live_view.h"
#include "plugin/session/servo.h"

namespace palpate::plugin {
namespace {

using Clock = std::chrono::steady_clock;
constexpr auto between_looks = std::chrono::milliseconds(100);
constexpr int ticks_between_looks = 256;

/// What a person sees while it runs.
class Watch {
 public:
  Watch(const SessionRun& run, const TickRing& ring, const Recorder& recorder) : recorder_(recorder) {
    if (run.live) {
      view_.emplace(ring, run.scene, run.unit);
    }
  }
  void look() {
    if (Clock::now() < next_) {
      return;
    }
    next_ = Clock::now() + between_looks;
    if (view_) {
      view_->show();
    }
    const RecorderStatus status = recorder_.status();
    if (status.stopped && !told_) {
      told_ = true;
      std::fputs("\n", stderr);
      tell(say("goes-on-unrecorded", status.why));
    }
  }

 private:
  const Recorder& recorder_;
  std::optional<LiveView> view_;
  Clock::time_point next_ = Clock::now();
  bool told_ = false;
};

void run_at_clock_pace(const SessionRun& run, Session& session, double rate_hz, Watch& watch,
                       SessionRunResult& result) {
  Servo servo(session, rate_hz);
  result.realtime = servo.realtime();
  if (!result.realtime.advice.empty()) {
    tell(say("real-time", result.realtime.advice));
  }
  const auto end = Clock::now() + std::chrono::duration<double>(run.seconds);
  while (!Interruptible::interrupted() && (run.seconds <= 0 || Clock::now() < end)) {
    servo.heartbeat();
    session.collect();
    watch.look();
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  servo.stop();
  session.collect();
  if (const auto fault = keep_fault(session.fault_ticks(), run.stylus->specification().name)) tell(describe(*fault));
  if (const Text trouble = run.stylus->trouble(); !trouble.empty()) tell(trouble);
  result.missed = servo.missed();
}

void run_in_arithmetic(const SessionRun& run, Session& session, double rate_hz, Watch& watch, Recorder& recorder) {
  const auto ticks = static_cast<std::uint64_t>(run.seconds * rate_hz);
  for (std::uint64_t n = 0; n < ticks && !Interruptible::interrupted(); ++n) {
    if (n % ticks_between_looks == 0) {
      recorder.wait_for_room();
      watch.look();
    }
    session.tick();
  }
}

}  // namespace

std::string in_words(const SessionRunResult& result, const std::filesystem::path& file) {
  return fmt::format("{} ticks in {}; missed ticks {}, ticks lost {}", result.recorder.written, file.string(),
                     result.missed, result.recorder.lost);
}

modes::Scene suited_to(modes::Scene scene, const device::Specification& stylus) {
  for (const Text& text : drawn_down(scene, stylus)) tell(text);
  scene.stiffness_n_per_m = stiffness_for(scene, stylus);
  return scene;
}

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

bool stderr_is_terminal() {
  return isatty(STDERR_FILENO) != 0;
}

SessionRunResult run_session(const SessionRun& run, const std::filesystem::path& file) {
  OpenStylus open = OpenStylus::of(run.stylus);
  const device::Specification specification = open.specification();
  SessionRunResult result;
  TickRing ring;
  RecorderOptions how;
  // Nothing waits for the clock: then nothing is too late, either.
  if (!run.at_clock_pace) how.most_behind = std::numeric_limits<std::uint64_t>::max();
  Recorder recorder(ring, file, header_for(run.scene, specification, run.scan_hash, static_cast<double>(run.seed)),
                    how);
  SceneRecord record = record_of(run.scene, run.felt, specification, run.scan_hash);
  record.frame = run.frame;
  recorder.note(record, known_to_of_ticks(run.felt, run.scene));
  recorder.note(StylusRecord{.epoch = 0,
                             .name = specification.name,
                             .force_axes = specification.force_axes,
                             .maximum_force_n = specification.maximum_force});
  {
    const Interruptible interruptible;
    Session session(snapshot_of(run.scene, run.felt, specification), std::move(open), &ring);
    Watch watch(run, ring, recorder);
    if (run.at_clock_pace) {
      run_at_clock_pace(run, session, specification.rate, watch, result);
    } else {
      run_in_arithmetic(run, session, specification.rate, watch, recorder);
    }
    result.interrupted = Interruptible::interrupted();
  }
  result.recorder = recorder.finish();
  return result;
}

}  // namespace palpate::plugin
