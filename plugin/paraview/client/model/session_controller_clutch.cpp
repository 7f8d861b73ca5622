// The clutch of a session's hand: hand and patient are parted, and joined with another mapping.

#include <QPointer>

#include <glm/geometric.hpp>
#include <optional>
#include <utility>

#include "plugin/paraview/client/model/session_controller.h"

namespace palpate::plugin {

void SessionController::clutch() {
  if (parted_) parted_->ends = false;
  if (!live_.is_connected() || parted_) return;
  mark_button_.forget();
  parted_ = Parted{.at_mm = status_.probe_mm, .felt = feels()};
  live_.release();
}

void SessionController::unclutch(const glm::dmat3& rotation) {
  if (!parted_ || parted_->ends) return;
  parted_->ends = true;
  // Both may come later, where structures are being read.
  const auto join = [alive = QPointer(this), rotation](modes::Scene& scene) {
    if (alive && alive->parted_) scene.workspace = alive->joined(rotation);
  };
  const auto told = [alive = QPointer(this)](const QString& why) {
    if (!alive || !alive->parted_ || !alive->parted_->ends) return;
    const bool felt = std::exchange(alive->parted_, std::nullopt)->felt;
    if (!why.isEmpty()) emit alive->told(why, true);
    if (felt && why.isEmpty()) alive->feel();
  };
  model_.edit(tr("Clutch"), join, told);
}

modes::WorkspaceSettings SessionController::joined(const glm::dmat3& rotation) const {
  const glm::dvec3 hand_m = vector_of(status_.tick.probe_m);
  const modes::Workspace held{.center_mm = {}, .rotation = rotation, .mm_per_m = workspace_.now().mm_per_m};
  return {.center_mm = parted_->at_mm - held.to_patient(hand_m),
          .rotation = rotation,
          .scale = workspace_.now().mm_per_m / 1e3,
          .fit = false};
}

bool SessionController::may_remap() const {
  return !live_.is_connected() ||
         (!feels() && status_.force_n == 0 && glm::length(vector_of(status_.tick.sent_n)) == 0);
}

}  // namespace palpate::plugin
