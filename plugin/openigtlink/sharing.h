#pragma once

/// Shares a session with clients of OpenIGTLink while this object exists. For the controlling thread, which calls
/// look() about a hundred times a second; another thread serves the clients. The session's stylus may come and go.

#include "plugin/openigtlink/announcer.h"
#include "plugin/openigtlink/requests.h"
#include "plugin/openigtlink/server.h"

namespace palpate::plugin::igtl {

class Sharing {
 public:
  /// Session, server, maps and threads must outlive it. The maps should live as long as the session, whose scene names
  /// their files. Its destructor cancels what is being prepared, but does not wait for it: the threads do.
  Sharing(const LiveSession& session, Server& server, Received& received, JobThreads& threads, Changes changes,
          Announcer::MakesMarks makes_marks = Announcer::MakesMarks::yes);

  void look();
  /// Replaces all marks.
  void set_marks(const std::vector<Point>& marks) { announcer_.set_marks(marks); }

 private:
  Publisher publisher_;
  Announcer announcer_;
  Requests requests_;
};

}  // namespace palpate::plugin::igtl
