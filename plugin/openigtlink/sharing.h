#pragma once

/// A session that is shared with clients of OpenIGTLink, for as long as this lives. Of the controlling thread, which
/// calls look() about a hundred times a second; clients are served by a thread of its own. The session's stylus may
/// come and go.

#include "plugin/openigtlink/announcer.h"
#include "plugin/openigtlink/requests.h"
#include "plugin/openigtlink/server.h"

namespace palpate::plugin::igtl {

class Sharing {
 public:
  /// Session, server and maps have to outlive it. The maps had better live as long as the session: its scene names
  /// their files.
  Sharing(const LiveSession& session, Server& server, Received& received, Changes changes,
          Announcer::MakesMarks makes_marks = Announcer::MakesMarks::yes);

  void look();
  /// These take the place of all.
  void set_marks(const std::vector<Point>& marks) { announcer_.set_marks(marks); }

 private:
  Publisher publisher_;
  Announcer announcer_;
  Requests requests_;
};

}  // namespace palpate::plugin::igtl
