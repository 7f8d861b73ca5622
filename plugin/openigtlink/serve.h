#pragma once

/// Shares a running session with clients of OpenIGTLink, until it is interrupted.

#include <filesystem>

#include "plugin/app/live_session.h"
#include "plugin/openigtlink/requests.h"
#include "plugin/openigtlink/server.h"

namespace palpate::plugin::igtl {

struct ServeOptions {
  double seconds = 0;                       ///< 0: until SIGINT or SIGTERM
  LoadScan load;                            ///< for PalpateFolder
  std::filesystem::path keep_maps_in = {};  ///< Received's folder
};

/// Functions that change the session itself. It must outlive them. A client's scene keeps the session's workspace.
Changes changes_of(LiveSession& session, LoadScan load);

/// The session must hold a stylus. Prints the address on stderr, and at the end the traffic.
void serve(LiveSession& session, Server& server, const ServeOptions& options);

}  // namespace palpate::plugin::igtl
