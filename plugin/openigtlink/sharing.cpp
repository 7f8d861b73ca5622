#include "plugin/openigtlink/sharing.h"

#include <utility>

namespace palpate::plugin::igtl {
namespace {

/// A client's marks are sent on to all, among those that are there.
Changes with_marks(Changes changes, Announcer& announcer) {
  if (!changes.set_marks) changes.set_marks = [&announcer](const auto& marks) { announcer.merge_marks(marks); };
  return changes;
}

}  // namespace

Sharing::Sharing(const LiveSession& session, Server& server, Received& received, JobThreads& threads, Changes changes,
                 Announcer::MakesMarks makes_marks)
    : publisher_(server),
      announcer_(session, server, publisher_, received, threads, makes_marks),
      requests_(session, server, received, threads, with_marks(std::move(changes), announcer_)) {}

void Sharing::look() {
  requests_.look();
  announcer_.look();
}

}  // namespace palpate::plugin::igtl
