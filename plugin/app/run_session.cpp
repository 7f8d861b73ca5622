#include "plugin/app/run_session.h"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <limits>
#include <optional>
#include <thread>
#include <utility>

#include "plugin/app/fault_report.h"
#include "plugin/app/interruptible.h"
#include "plugin/app/recording_header.h"
#include "plugin/messages/messages.h"
#include "plugin/messages/tell.h"
#include "plugin/report/held_boundary.h"
#include "plugin/report/live_view.h"
#include "plugin/session/felt_limits.h"

namespace palpate::plugin {
namespace {

using Clock = std::chrono::steady_clock;
constexpr auto between_looks = std::chrono::milliseconds(100);
constexpr int ticks_between_looks = 256;

/// The display for a person during the session.
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

void run_at_clock_pace(const SessionRun& run, RunningSession& running, Watch& watch, SessionRunResult& result) {
  running.start_servo();
  Servo& servo = *running.servo();
  Session& session = running.session();
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
  if (const auto fault = keep_fault(session.fault_ticks(), running.specification().name)) tell(describe(*fault));
  if (const Text trouble = run.stylus->trouble(); !trouble.empty()) tell(trouble);
  result.missed = servo.missed();
}

void run_in_arithmetic(const SessionRun& run, RunningSession& running, Watch& watch) {
  const auto ticks = static_cast<std::uint64_t>(run.seconds * running.specification().rate);
  for (std::uint64_t n = 0; n < ticks && !Interruptible::interrupted(); ++n) {
    if (n % ticks_between_looks == 0) {
      running.recorder()->wait_for_room();
      watch.look();
    }
    running.session().tick();
  }
}

}  // namespace

std::string in_words(const SessionRunResult& result, const std::filesystem::path& file) {
  return fmt::format("{} ticks in {}; missed ticks {}, ticks lost {}", result.recorder.written, file.string(),
                     result.missed, result.recorder.lost);
}

void tell_drawn_down(const modes::Scene& scene, const device::Specification& stylus) {
  for (const Text& text : drawn_down(scene, stylus)) tell(text);
}

bool stderr_is_terminal() {
  return isatty(STDERR_FILENO) != 0;
}

SessionRunResult run_session(const SessionRun& run, const std::filesystem::path& file) {
  OpenStylus open = OpenStylus::of(run.stylus);
  const device::Specification specification = open.specification();
  SessionRunResult result;
  RecorderOptions how;
  // Nothing waits for the clock: then nothing is too late, either.
  if (!run.at_clock_pace) how.most_behind = std::numeric_limits<std::uint64_t>::max();
  const auto as_recorded = [&](std::uint32_t) {
    SceneRecord record = record_of(run.scene, run.felt, specification, run.scan_hash);
    record.frame = run.frame;
    return RecordedScene{std::move(record), known_to_of_ticks(run.felt, run.scene)};
  };
  const RecordingHeader header = header_for(run.scene, specification, run.scan_hash, static_cast<double>(run.seed));
  RunningSession running(std::move(open), {.snapshot = snapshot_of(run.scene, run.felt, specification),
                                           .as_recorded = as_recorded,
                                           .recording = RecordingTo{file, header, how}});
  {
    const Interruptible interruptible;
    Watch watch(run, running.ring(), *running.recorder());
    if (run.at_clock_pace) {
      run_at_clock_pace(run, running, watch, result);
    } else {
      run_in_arithmetic(run, running, watch);
    }
    result.interrupted = Interruptible::interrupted();
    running.stop();
  }
  result.recorder = running.end().value();
  return result;
}

}  // namespace palpate::plugin
