#pragma once

/// Runs a stroke through the scene as it is felt now, without a stylus.

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

  /// What makes the profile, on any thread. Empty: nothing is felt, or the stroke is not whole. Throws with the reason
  /// why the scene cannot be felt.
  std::function<Profile()> run(const WantedStroke& stroke);
  /// A scan that is closed is not held.
  void forget() { prepared_ = {}; }

 private:
  const SessionController& session_;
  Prepared prepared_;  // fields of its own: the servo's stay where the stylus is
};

}  // namespace palpate::plugin
