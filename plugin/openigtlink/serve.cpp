#include "plugin/openigtlink/serve.h"

#include <chrono>
#include <thread>

#include "plugin/app/interruptible.h"
#include "plugin/messages/tell.h"
#include "plugin/openigtlink/say.h"

namespace palpate::plugin::igtl {
namespace {

using Clock = std::chrono::steady_clock;
constexpr auto between_looks = std::chrono::milliseconds(10);

}  // namespace

void serve(LiveSession& session, Server& server, const ServeOptions& options) {
  const Interruptible interruptible;
  const auto end = Clock::now() + std::chrono::duration<double>(options.seconds);
  std::optional<std::string> fault;
  {
    Received received;
    Publisher publisher(server, *session.ticks());
    Announcer announcer(session, server, publisher, received);
    Requests requests(session, server, announcer, received, options.load);
    while (!Interruptible::interrupted() && (options.seconds <= 0 || Clock::now() < end)) {
      session.heartbeat();
      requests.look();
      announcer.look();
      if (session.last_fault() && fault != session.last_fault()->time) {
        fault = session.last_fault()->time;
        tell(describe(*session.last_fault()));
      }
      std::this_thread::sleep_for(between_looks);
    }
  }
  const ServerCounts counts = server.counts();
  tell(say("igtl-served", counts.sent, counts.replaced, counts.taken, counts.outrun, counts.refused,
           counts.passed_over + counts.dropped, counts.cut + counts.turned_away));
}

}  // namespace palpate::plugin::igtl
