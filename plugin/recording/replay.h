#pragma once

/// A recorded session once more, frame by frame: the same poses, times, scenes and commands, and hence, on the same
/// build, the same forces to the last bit.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "plugin/recording/recording.h"
#include "plugin/session/session.h"

namespace palpate::plugin {

/// Makes a recorded scene's snapshot again, from a scan with that hash. Throws where there is none, saying so.
using SnapshotMaker = std::function<Snapshot(const SceneRecord&)>;

struct Replay {
  std::uint64_t frames = 0;                      ///< replayed
  std::uint64_t different = 0;                   ///< that are not the same to the last bit (same_in_replay)
  std::optional<std::uint64_t> first_different;  ///< index of the frame
  /// Largest distance between the recorded and the repeated proxy; infinity where one of them is not a number.
  double largest_proxy_m = 0;
  double largest_force_n = 0;   ///< the same of what was sent
  double largest_bound_m = 0;   ///< largest sum of a frame's two certified bounds: what two builds may differ by
  std::uint64_t after_gap = 0;  ///< frames that cannot be replayed, since some before them were lost
};

/// Throws std::runtime_error where the recording has no scene or an event is missing, and what the maker throws.
Replay replay(const Recording& recording, const SnapshotMaker& make_snapshot);

/// The same of a recording in several files, one after the other.
class Replayer {
 public:
  explicit Replayer(SnapshotMaker make_snapshot);
  Replayer(const Replayer&) = delete;
  Replayer& operator=(const Replayer&) = delete;
  ~Replayer();

  /// The next part. Throws as replay().
  void feed(const Recording& part);
  const Replay& result() const noexcept;

 private:
  struct Progress;
  std::unique_ptr<Progress> progress_;
};

}  // namespace palpate::plugin
