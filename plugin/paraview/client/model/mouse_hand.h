#pragma once

/// The hand of the simulated stylus, which mouse and keyboard move.

#include <glm/vec3.hpp>
#include <memory>
#include <optional>

#include "device/simulated/simulated_stylus.h"
#include "modes/scene/workspace.h"
#include "plugin/session/tick_record.h"

namespace palpate::plugin {

class MouseHand {
 public:
  /// Null: no simulated stylus is held.
  void hold(std::shared_ptr<device::SimulatedStylus> stylus);
  bool holds() const { return stylus_ != nullptr; }
  void move(const glm::dvec3& patient_mm, const modes::Workspace& workspace);
  /// Where it was last put; none while it relaxes, or since the workspace is another.
  const std::optional<glm::dvec3>& place_mm() const { return place_mm_; }
  void forget_place() { place_mm_.reset(); }
  /// It relaxes until nothing pushes it.
  void let_go();
  /// Once for each look at the ticks, with the force that the device was fed.
  void give_way(const TickRecord& tick, double force_n);
  /// True: the mouse is used for something else, and does not take the stylus.
  void keep_mouse_off(bool off) { mouse_off_ = off; }
  bool takes_mouse() const { return holds() && !mouse_off_; }

 private:
  std::shared_ptr<device::SimulatedStylus> stylus_;
  std::optional<glm::dvec3> place_mm_;
  bool letting_go_ = false;
  bool mouse_off_ = false;
};

}  // namespace palpate::plugin
