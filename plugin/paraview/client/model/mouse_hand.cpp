#include "plugin/paraview/client/model/mouse_hand.h"

#include <utility>

namespace palpate::plugin {

void MouseHand::hold(std::shared_ptr<device::SimulatedStylus> stylus) {
  stylus_ = std::move(stylus);
  place_mm_.reset();
}

void MouseHand::move(const glm::dvec3& patient_mm, const modes::Workspace& workspace) {
  letting_go_ = false;
  place_mm_ = patient_mm;
  if (stylus_) stylus_->move_target(workspace.to_device(patient_mm));
}

void MouseHand::let_go() {
  letting_go_ = holds();
  place_mm_.reset();
}

/// To the proxy and a little beyond: the arm's own friction keeps a hand that goes no farther inside.
void MouseHand::give_way(const TickRecord& tick, double force_n) {
  constexpr double nothing_n = 0.02, beyond = 0.5;
  if (!letting_go_ || !stylus_) return;
  const glm::dvec3 proxy_m = vector_of(tick.proxy_m);
  stylus_->move_target(proxy_m + beyond * (proxy_m - vector_of(tick.probe_m)));
  if (force_n < nothing_n) letting_go_ = false;
}

}  // namespace palpate::plugin
