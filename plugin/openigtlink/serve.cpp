#include "plugin/openigtlink/serve.h"

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "device/safety/safety_limits.h"
#include "plugin/app/interruptible.h"
#include "plugin/messages/messages.h"
#include "plugin/messages/tell.h"
#include "plugin/openigtlink/say.h"
#include "plugin/openigtlink/sharing.h"
#include "plugin/session/session.h"

namespace palpate::plugin::igtl {
namespace {

using Clock = std::chrono::steady_clock;
constexpr auto between_looks = std::chrono::milliseconds(10);
constexpr auto longest_fall = std::chrono::milliseconds(500);  // on a busy machine; else a tenth of it

/// The last tick; none: there is none yet.
std::optional<TickRecord> last_tick(const LiveSession& session) {
  TickRecord tick;
  const std::uint64_t written = session.is_connected() ? session.ticks()->written() : 0;
  return written > 0 && session.ticks()->read(written - 1, tick) ? std::optional(tick) : std::nullopt;
}

/// Takes the force away while the stylus moves through the patient, because another scan lies elsewhere under the hand.
/// It comes back along its ramp when the change is over, and only if it was on before.
class ForceAcrossScans {
 public:
  explicit ForceAcrossScans(LiveSession& session) : session_(session) {}

  /// Returns when there is no force, or the servo has heard that there shall be none.
  void take_away() {
    if (session_.start() == LiveSession::Start::feeling) is_awaited_ = true;
    session_.release();
    std::optional<double> released_s;  // the first tick without it
    for (const auto end = Clock::now() + longest_fall; Clock::now() < end;) {
      session_.heartbeat();
      const auto tick = last_tick(session_);
      const bool off = tick && state_of(*tick) != device::State::active && state_of(*tick) != device::State::ramping;
      if (off && !released_s) released_s = tick->time_s;
      if (off && tick->time_s - *released_s > device::SafetyLimits{}.fall_time) return;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
  void look() {
    if (!is_awaited_) return;
    const auto tick = last_tick(session_);
    if (!tick || tick->scene_epoch != session_.epoch() || tick->change_part < 1) return;
    is_awaited_ = false;
    if (fault_of(*tick) == device::Fault::none) session_.feel();
  }

 private:
  LiveSession& session_;
  bool is_awaited_ = false;
};

}  // namespace

Changes changes_of(LiveSession& session, LoadScan load) {
  const auto force = std::make_shared<ForceAcrossScans>(session);
  return {.set_scene =
              [&session](const modes::Scene& scene, const PreparedScene& prepared) {
                session.offer(prepared);
                session.set_scene(scene);
              },
          .set_scan =
              [&session, force](const LoadedScan& scan, const modes::Scene& scene, const PreparedScene& prepared) {
                const bool moves = session.plan() && prepared.plan->workspace != session.plan()->workspace;
                if (moves) force->take_away();
                session.offer(prepared);
                session.set_scan(prepared.volume, scene, scan.frame);
              },
          .set_marks = {},
          .load = std::move(load),
          .look = [force] { force->look(); },
          .keeps_workspace = true};
}

void serve(LiveSession& session, Server& server, const ServeOptions& options) {
  const Interruptible interruptible;
  const auto end = Clock::now() + std::chrono::duration<double>(options.seconds);
  std::optional<std::string> fault;
  bool told_unrecorded = false;
  {
    Received received(options.keep_maps_in);
    JobThreads threads;
    Sharing sharing(session, server, received, threads, changes_of(session, options.load));
    while (!Interruptible::interrupted() && (options.seconds <= 0 || Clock::now() < end)) {
      session.heartbeat();
      sharing.look();
      if (session.last_fault() && fault != session.last_fault()->time) {
        fault = session.last_fault()->time;
        tell(describe(*session.last_fault()));
      }
      if (const auto recording = session.recording(); recording && recording->stopped && !told_unrecorded) {
        told_unrecorded = true;
        tell(plugin::say("goes-on-unrecorded", recording->why));
      }
      std::this_thread::sleep_for(between_looks);
    }
    // Cancels what is being prepared, and waits until it has ended: without a force.
    session.release();
  }
  const ServerCounts counts = server.counts();
  tell(say("igtl-served", counts.sent, counts.replaced, counts.taken, counts.outrun, counts.refused,
           counts.passed_over + counts.dropped, counts.cut + counts.turned_away));
}

}  // namespace palpate::plugin::igtl
