#pragma once

/// What clients are told of a session beside its frames: status, contact, marks, the scene as it is felt, and its
/// shapes (shapes.h). Of the controlling thread; look() is called about a hundred times a second.

#include <chrono>
#include <cstdint>
#include <future>
#include <set>
#include <string>
#include <vector>

#include "plugin/app/live_session.h"
#include "plugin/openigtlink/publisher.h"
#include "plugin/openigtlink/received.h"
#include "plugin/openigtlink/shapes.h"
#include "plugin/recording/marks.h"

namespace palpate::plugin::igtl {

class Announcer {
 public:
  /// All have to outlive it.
  Announcer(LiveSession& session, Server& server, Publisher& publisher, const Received& received);
  Announcer(const Announcer&) = delete;
  Announcer& operator=(const Announcer&) = delete;
  ~Announcer() = default;

  void look();
  /// After a change of scene or scan.
  void scene_changed();
  /// A client's marks take the place of all.
  void set_marks(const std::vector<Point>& marks);

 private:
  using Clock = std::chrono::steady_clock;

  void announce_status(const TickRecord& tick);
  void announce_contact(const TickRecord& tick, const std::vector<PrimitiveRecord>& shares);
  void announce_marks();
  void announce_shapes();
  void follow_marks();
  void offer(const char* type, const std::string& device, Bytes content, double stamp, bool kept);

  LiveSession& session_;
  Server& server_;
  Publisher& publisher_;
  const Received& received_;
  std::string last_state_;
  Clock::time_point next_status_, next_contact_;
  MarkPresses presses_;
  std::uint64_t next_tick_ = 0;
  Marks felt_;                // made with the stylus
  std::vector<Point> marks_;  // all, as they are sent
  std::future<std::vector<Shape>> shapes_;
  bool shapes_wanted_ = true;
  std::set<std::string> shapes_sent_;  // each by its type and name
};

/// "off", "ready", "feeling" or "stopped", and the same as a sentence.
struct StateInWords {
  std::string state, sentence;
};
StateInWords state_of_session(const TickRecord& tick);

}  // namespace palpate::plugin::igtl
