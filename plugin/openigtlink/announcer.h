#pragma once

/// What clients are told of a session beside its frames: status, contact, marks, the scene as it is felt, and its
/// shapes (shapes.h). Of the controlling thread; look() is called about a hundred times a second.

#include <chrono>
#include <cstdint>
#include <future>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "plugin/app/live_session.h"
#include "plugin/openigtlink/contents.h"
#include "plugin/openigtlink/publisher.h"
#include "plugin/openigtlink/received.h"
#include "plugin/openigtlink/shapes.h"
#include "plugin/recording/marks.h"

namespace palpate::plugin::igtl {

inline constexpr double mark_diameter_mm = 2;  ///< as clients draw them

class Announcer {
 public:
  /// Whose press of the mark button makes a mark: the program that owns the session may keep its own.
  enum class MakesMarks { yes, no };
  /// All have to outlive it.
  Announcer(const LiveSession& session, Server& server, Publisher& publisher, const Received& received,
            MakesMarks makes_marks = MakesMarks::yes);
  Announcer(const Announcer&) = delete;
  Announcer& operator=(const Announcer&) = delete;
  ~Announcer() = default;

  /// Follows the session: its ticks, its scan and its scene may be others than at the last call, or none.
  void look();
  /// These take the place of all.
  void set_marks(const std::vector<Point>& marks);

 private:
  using Clock = std::chrono::steady_clock;

  void follow_session();
  void announce_scene();
  void announce_off();
  void announce_status(const TickRecord& tick);
  void announce_contact(const TickRecord& tick, const std::vector<PrimitiveRecord>& shares);
  void announce_marks();
  void announce_shapes();
  void follow_marks();
  void offer(const char* type, const std::string& device, Bytes content, double stamp, bool kept);

  const LiveSession& session_;
  Server& server_;
  Publisher& publisher_;
  const Received& received_;
  MakesMarks makes_marks_;
  std::shared_ptr<const TickRing> ticks_;
  std::shared_ptr<const io::Volume> scan_;
  std::shared_ptr<const modes::Plan> plan_;  // every scene that is set has one of its own
  bool is_new_ = true;                       // the session
  std::string last_state_;
  Clock::time_point next_status_, next_contact_;
  MarkPresses presses_;
  std::uint64_t next_tick_ = 0;
  Marks felt_;                // made with the stylus
  std::vector<Point> marks_;  // all, as they are sent
  std::future<std::vector<Shape>> shapes_;
  std::optional<Clock::time_point> shapes_wanted_;  // from when on: a scene that is being tuned has others soon
  std::map<std::string, std::size_t> shapes_sent_;  // of each type and name the hash of its bytes
};

/// "off", "ready", "feeling" or "stopped", and the same as a sentence.
struct StateInWords {
  std::string state, sentence;
  Status::Code code = Status::Code::not_ready;
};
StateInWords state_of_session(const TickRecord& tick);

}  // namespace palpate::plugin::igtl
