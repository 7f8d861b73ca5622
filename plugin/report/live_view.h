#pragma once

/// The present state of a session, as one line of a terminal that is overwritten.

#include <cstdint>
#include <string>

#include "modes/scene/scene.h"
#include "plugin/session/tick_ring.h"

namespace palpate::plugin {

class LiveView {
 public:
  /// `unit` is the scan's. If the scene names no tissues, those of a CT are named by their HU. Both arguments must
  /// outlive the view.
  LiveView(const TickRing& ring, const modes::Scene& scene, std::string unit);
  /// Clears the line.
  ~LiveView();
  LiveView(const LiveView&) = delete;
  LiveView& operator=(const LiveView&) = delete;

  /// Writes the line of the newest tick to stderr; ten times a second is enough. Times and missed deadlines are those
  /// of all ticks since the previous call that are still in the ring.
  void show();

 private:
  const TickRing& ring_;
  const modes::Scene& scene_;
  std::string unit_;
  std::uint64_t next_ = 0;
  std::uint64_t missed_ = 0;
};

/// "fat", "bone": a tissue of the scene, else of CT by HU, else the value itself.
std::string tissue_name(const modes::Scene& scene, const std::string& unit, double value);

/// The line for a tick: force, depth, tissue, solver, error bound, tick, missed ticks, and problems.
std::string live_line(const TickRecord& tick, const std::string& tissue, double longest_tick_us, std::uint64_t missed);

}  // namespace palpate::plugin
