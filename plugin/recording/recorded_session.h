#pragma once

/// A recording in patient space: positions of stylus and proxy in the scan, and the felt forces.

#include <cstddef>
#include <glm/vec3.hpp>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "io/volume.h"
#include "modes/scene/scene.h"
#include "modes/scene/workspace.h"
#include "plugin/recording/recording.h"

namespace palpate::plugin {

class RecordedSession {
 public:
  /// Uses the ticks recorded on this scan, by its hash. Throws std::runtime_error if there are none, and
  /// std::invalid_argument if a scene is invalid.
  RecordedSession(Recording recording, const io::Volume& volume);

  std::size_t size() const noexcept { return recording_.ticks.size(); }
  /// s, from the first tick to the last.
  double duration_s() const noexcept;
  /// The last tick at or before this time, s after the first.
  std::size_t tick_at(double seconds) const noexcept;
  /// s after the first tick.
  double time_s(std::size_t n) const noexcept;

  const TickRecord& tick(std::size_t n) const { return recording_.ticks[n]; }
  std::span<const PrimitiveRecord> shares(std::size_t n) const;
  const modes::Scene& scene(std::size_t n) const;
  /// The scene's structures with recorded distances at this tick, in the record's order.
  const std::vector<std::size_t>& structures(std::size_t n) const { return setting(n).structures; }
  /// The workspace at this tick. During a change of scene it moves from the old to the new one.
  modes::Workspace workspace(std::size_t n) const;
  // mm and N, patient space (LPS). The force is the one sent to the stylus.
  glm::dvec3 probe_mm(std::size_t n) const;
  glm::dvec3 proxy_mm(std::size_t n) const;
  glm::dvec3 sent_n(std::size_t n) const;

  /// Ticks left out because they were recorded on another scan.
  std::size_t elsewhere() const noexcept { return elsewhere_; }

 private:
  struct Setting {
    modes::Scene scene;
    std::vector<std::size_t> structures;
    modes::Workspace workspace, before;
  };
  const Setting& setting(std::size_t n) const { return settings_.at(recording_.ticks[n].scene_epoch); }

  Recording recording_;
  std::vector<std::size_t> first_share_;  // of each tick
  std::map<std::uint32_t, Setting> settings_;
  std::size_t elsewhere_ = 0;
};

}  // namespace palpate::plugin
