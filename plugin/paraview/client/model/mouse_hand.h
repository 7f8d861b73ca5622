#pragma once

/// The hand that holds the simulated stylus, moved by mouse and keyboard.

#include <glm/vec3.hpp>
#include <memory>
#include <optional>

#include "device/simulated/simulated_stylus.h"
#include "modes/scene/workspace.h"
#include "plugin/session/tick_record.h"

namespace palpate::plugin {

class MouseHand {
 public:
  /// Null: there is no simulated stylus.
  void hold(std::shared_ptr<device::SimulatedStylus> stylus);
  bool holds() const { return stylus_ != nullptr; }
  void move(const glm::dvec3& patient_mm, const modes::Workspace& workspace);
  /// The hand's last position; none while it relaxes, or after a change of the workspace.
  const std::optional<glm::dvec3>& place_mm() const { return place_mm_; }
  void forget_place() { place_mm_.reset(); }
  /// Lets the hand relax until no force acts on it.
  void let_go();
  /// To be called at each poll, with the force on the device.
  void give_way(const TickRecord& tick, double force_n);
  /// True: the mouse is used for something else and does not move the stylus.
  void keep_mouse_off(bool off) { mouse_off_ = off; }
  bool takes_mouse() const { return holds() && !mouse_off_; }

 private:
  std::shared_ptr<device::SimulatedStylus> stylus_;
  std::optional<glm::dvec3> place_mm_;
  bool letting_go_ = false;
  bool mouse_off_ = false;
};

}  // namespace palpate::plugin
