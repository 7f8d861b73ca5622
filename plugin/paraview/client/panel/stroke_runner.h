#pragma once

/// Runs a stroke through the present scene, without a stylus.

#include <functional>
#include <glm/vec3.hpp>
#include <optional>

#include "plugin/paraview/client/model/session_controller.h"
#include "plugin/report/stroke_picture.h"

namespace palpate::plugin {

/// Ends in patient space, mm.
struct WantedStroke {
  std::optional<glm::dvec3> from, to;
  double speed_mm_per_s = 50;
  bool is_whole() const { return from && to && *from != *to; }
};

class StrokeRunner {
 public:
  explicit StrokeRunner(const SessionController& session) : session_(session) {}

  /// A function that computes the profile, on any thread. Empty if nothing can be felt or the stroke is incomplete. It
  /// throws with the reason why the scene cannot be felt.
  std::function<Profile()> run(const WantedStroke& stroke);
  /// Releases the scan when it is closed.
  void forget() { prepared_ = {}; }

 private:
  const SessionController& session_;
  Prepared prepared_;  // with fields of its own, so that the servo's cache stays near the stylus
};

}  // namespace palpate::plugin
