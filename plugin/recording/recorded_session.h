#pragma once

/// A recording seen from the patient: where stylus and proxy were in the scan, and what was felt there.

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
  /// Of the frames that felt this scan, as its hash tells. Throws std::runtime_error where there is none, and what a
  /// scene that is none throws.
  RecordedSession(Recording recording, const io::Volume& volume);

  std::size_t size() const noexcept { return recording_.frames.size(); }
  /// s, from the first frame to the last.
  double duration_s() const noexcept;
  /// The last frame that is not later than this, s after the first.
  std::size_t frame_at(double seconds) const noexcept;
  /// s after the first frame.
  double time_s(std::size_t n) const noexcept;

  const TickRecord& frame(std::size_t n) const { return recording_.frames[n]; }
  std::span<const PrimitiveRecord> shares(std::size_t n) const;
  const modes::Scene& scene(std::size_t n) const;
  /// Of the scene's structures those whose distances the frame tells, in that order.
  const std::vector<std::size_t>& structures(std::size_t n) const { return setting(n).structures; }
  /// Where the hand's reach was; on its way while a change of the scene was.
  modes::Workspace workspace(std::size_t n) const;
  // mm and N, patient space (LPS). The force is what the stylus was fed.
  glm::dvec3 probe_mm(std::size_t n) const;
  glm::dvec3 proxy_mm(std::size_t n) const;
  glm::dvec3 sent_n(std::size_t n) const;

  /// Frames that are not here: they felt another scan.
  std::size_t elsewhere() const noexcept { return elsewhere_; }

 private:
  struct Setting {
    modes::Scene scene;
    std::vector<std::size_t> structures;
    modes::Workspace workspace, before;
  };
  const Setting& setting(std::size_t n) const { return settings_.at(recording_.frames[n].scene_epoch); }

  Recording recording_;
  std::vector<std::size_t> first_share_;  // of each frame
  std::map<std::uint32_t, Setting> settings_;
  std::size_t elsewhere_ = 0;
};

}  // namespace palpate::plugin
