#pragma once

/// What is felt right now, as one line in a terminal that is written over.

#include <cstdint>
#include <string>

#include "modes/scene/scene.h"
#include "plugin/session/tick_ring.h"

namespace palpate::plugin {

class LiveView {
 public:
  /// `unit` is the scan's: CT's tissues are named by their HU where the scene names none. Both have to outlive the
  /// view.
  LiveView(const TickRing& ring, const modes::Scene& scene, std::string unit);
  /// Clears the line.
  ~LiveView();
  LiveView(const LiveView&) = delete;
  LiveView& operator=(const LiveView&) = delete;

  /// Writes the newest frame's line to stderr; ten times a second is enough. Ticks are timed, and missed ones counted,
  /// over all frames since it was last called that the ring still holds.
  void show();

 private:
  const TickRing& ring_;
  const modes::Scene& scene_;
  std::string unit_;
  std::uint64_t next_ = 0;
  std::uint64_t missed_ = 0;
};

/// "fat", "bone": of the scene's tissues, else CT's by HU, else the value itself.
std::string tissue_name(const modes::Scene& scene, const std::string& unit, double value);

/// The line for a frame: force, depth, tissue, solver, error bound, tick, missed ticks, and what is wrong.
std::string live_line(const TickRecord& frame, const std::string& tissue, double longest_tick_us, std::uint64_t missed);

}  // namespace palpate::plugin
