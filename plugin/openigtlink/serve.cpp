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

}  // namespace

Changes changes_of(LiveSession& session, LoadScan load) {
  return {.set_scene =
              [&session](const modes::Scene& scene, const PreparedScene& prepared) {
                session.offer(prepared);
                session.set_scene(scene);
              },
          .set_scan =
              [&session](const LoadedScan& scan, const modes::Scene& scene, const PreparedScene& prepared) {
                session.offer(prepared);
                session.set_scan(prepared.volume, scene, scan.frame);
              },
          .set_marks = {},
          .load = std::move(load),
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
