#pragma once

/// Replays a recorded session tick by tick, with the same poses, times, scenes and commands. So, with the same build,
/// the forces are the same to the last bit.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "plugin/recording/recording.h"
#include "plugin/session/session.h"
#include "solver/text/message.h"

namespace palpate::plugin {

/// Makes a recorded scene's snapshot again, from a scan with that hash. Throws if there is no such scan.
using SnapshotMaker = std::function<Snapshot(const SceneRecord&)>;

struct Replay {
  std::uint64_t ticks = 0;                       ///< replayed
  std::uint64_t different = 0;                   ///< ticks that differ in any bit (same_in_replay)
  std::optional<std::uint64_t> first_different;  ///< index of the tick
  /// Largest distance between the recorded and the replayed proxy; infinite if one of them is not a number.
  double largest_proxy_m = 0;
  double largest_force_n = 0;   ///< likewise for the force sent
  double largest_bound_m = 0;   ///< largest sum of a tick's two certified bounds: two builds may differ by that much
  std::uint64_t after_gap = 0;  ///< ticks that cannot be replayed, because earlier ones were lost
};

/// The recording does not hold what its ticks name.
class DamagedRecording : public Refusal {
 public:
  using Refusal::Refusal;
};

/// Throws DamagedRecording if a scene or stylus of a tick is missing, or if its epoch does not follow from the ones
/// before; and what the maker throws.
Replay replay(const Recording& recording, const SnapshotMaker& make_snapshot);

/// Replays a recording in several files, one after the other.
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
