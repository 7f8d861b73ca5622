#pragma once

/// The network's thread: steps the server, and sends the newest tick sixty times a second. It only reads the ring of
/// ticks, so nothing that a client does reaches the servo.

#include <atomic>
#include <cstdint>
#include <glm/gtc/quaternion.hpp>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "plugin/openigtlink/server.h"
#include "plugin/session/felt_workspace.h"
#include "plugin/session/tick_ring.h"

namespace palpate::plugin::igtl {

inline constexpr double frames_per_s = 60;

class Publisher {
 public:
  /// The server must outlive it. Nothing is sent without ticks.
  explicit Publisher(Server& server, std::shared_ptr<const TickRing> ticks = nullptr);
  Publisher(const Publisher&) = delete;
  Publisher& operator=(const Publisher&) = delete;
  /// Sends the queued messages, for at most a tenth of a second, and ends the thread.
  ~Publisher();

  // --- Any thread.
  /// The ticks of the running session; null: there is none. Forgets the workspaces of the previous one.
  void set_ticks(std::shared_ptr<const TickRing> ticks);
  /// The workspace for ticks from this epoch on. Ticks before the first one and after the last one are not sent.
  void set_workspace(std::uint32_t epoch, const modes::Workspace& workspace);
  void set_orientation(const std::optional<glm::dquat>& orientation);
  /// UTC, s since 1970, of a tick: the time stamp of its messages.
  double stamp_of(const TickRecord& tick) const;

 private:
  void run();
  std::optional<Bytes> newest_frame();
  std::optional<modes::Workspace> workspace_of(const TickRecord& tick);

  Server& server_;
  mutable std::mutex mutex_;
  std::shared_ptr<const TickRing> ticks_;
  double began_s_ = 0;  // UTC, of the session's tick 0
  FeltWorkspace workspace_;
  std::optional<std::uint32_t> first_epoch_;
  std::uint32_t last_epoch_ = 0;
  std::optional<glm::dquat> orientation_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace palpate::plugin::igtl
