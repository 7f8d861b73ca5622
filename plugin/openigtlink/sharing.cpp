#include "plugin/openigtlink/sharing.h"

#include <utility>

namespace palpate::plugin::igtl {
namespace {

/// A client's marks are sent on to all.
Changes with_marks(Changes changes, Announcer& announcer) {
  if (!changes.set_marks) changes.set_marks = [&announcer](const auto& marks) { announcer.set_marks(marks); };
  return changes;
}

}  // namespace

Sharing::Sharing(const LiveSession& session, Server& server, Received& received, Changes changes,
                 Announcer::MakesMarks makes_marks)
    : publisher_(server),
      announcer_(session, server, publisher_, received, makes_marks),
      requests_(session, server, received, with_marks(std::move(changes), announcer_)) {}

void Sharing::look() {
  requests_.look();
  announcer_.look();
}

}  // namespace palpate::plugin::igtl
