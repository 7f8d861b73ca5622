#pragma once

/// Sends clients the state of a session in addition to its frames: status, contact, marks, the felt scene, and its
/// shapes (shapes.h). For the controlling thread; look() is called about a hundred times a second.

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "plugin/app/live_session.h"
#include "plugin/openigtlink/contents.h"
#include "plugin/openigtlink/job.h"
#include "plugin/openigtlink/publisher.h"
#include "plugin/openigtlink/received.h"
#include "plugin/openigtlink/shapes.h"
#include "plugin/recording/marks.h"
#include "plugin/session/felt_workspace.h"

namespace palpate::plugin::igtl {

inline constexpr double mark_diameter_mm = 2;  ///< as clients draw them

class Announcer {
 public:
  /// Whether a press of the mark button makes a mark here; the program that owns the session may make marks itself.
  enum class MakesMarks { yes, no };
  /// The arguments must outlive it.
  Announcer(const LiveSession& session, Server& server, Publisher& publisher, const Received& received,
            JobThreads& threads, MakesMarks makes_marks = MakesMarks::yes);
  Announcer(const Announcer&) = delete;
  Announcer& operator=(const Announcer&) = delete;
  ~Announcer() = default;

  /// Updates from the session: ticks, scan and scene may have changed since the previous call, or be missing.
  void look();
  /// Replaces all marks.
  void set_marks(const std::vector<Point>& marks);
  /// Adds and moves marks as a client's list says (changed_marks()). Throws as that does. With a scan of another
  /// patient or frame of reference, all marks go, unless the owner of the session makes them.
  void merge_marks(const std::vector<Point>& sent);

 private:
  using Clock = std::chrono::steady_clock;

  void follow_session();
  void leave_marks();
  void announce_scene();
  void announce_off();
  void announce_status(const TickRecord& tick);
  void announce_contact(const TickRecord& tick, const std::vector<PrimitiveRecord>& shares);
  void announce_marks();
  void announce_shapes();
  void follow_marks();
  std::string free_name() const;
  void offer(const char* type, const std::string& device, Bytes content, double stamp, bool kept);

  const LiveSession& session_;
  Server& server_;
  Publisher& publisher_;
  const Received& received_;
  MakesMarks makes_marks_;
  std::shared_ptr<const TickRing> ticks_;
  std::shared_ptr<const io::Volume> scan_;
  std::shared_ptr<const modes::Plan> plan_;  // of the latest scene: every scene has its own plan
  bool is_new_ = true;                       // whether the session is new
  std::string last_state_;
  Clock::time_point next_status_, next_contact_;
  FeltWorkspace workspace_;
  MarkPresses presses_;
  bool is_cut_off_ = false;       // of a press on another patient; until the button is let go on this one
  std::uint32_t scan_epoch_ = 0;  // of its first scene
  std::uint64_t next_tick_ = 0;
  std::vector<Point> marks_;  // as sent
  Job<std::vector<Shape>> shapes_;
  std::optional<Clock::time_point>
      shapes_wanted_;  // time at which shapes will be sent: while a scene is being tuned they change often
  std::map<std::string, std::size_t> shapes_sent_;  // hash of the bytes, by type and name
};

/// "off", "ready", "feeling" or "stopped", and the same as a sentence.
struct StateInWords {
  std::string state, sentence;
  Status::Code code = Status::Code::not_ready;
};
StateInWords state_of_session(const TickRecord& tick);

}  // namespace palpate::plugin::igtl
