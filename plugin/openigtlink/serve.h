#pragma once

/// Shares a running session with clients of OpenIGTLink, until it is interrupted.

#include "plugin/app/live_session.h"
#include "plugin/openigtlink/requests.h"
#include "plugin/openigtlink/server.h"

namespace palpate::plugin::igtl {

struct ServeOptions {
  double seconds = 0;  ///< 0: until SIGINT or SIGTERM
  LoadScan load;       ///< for PalpateFolder
};

/// What requests change, changed in the session itself. It has to outlive them.
Changes changes_of(LiveSession& session, LoadScan load);

/// The session holds a stylus. Says on stderr where it listens, and at the end what went over the wire.
void serve(LiveSession& session, Server& server, const ServeOptions& options);

}  // namespace palpate::plugin::igtl
