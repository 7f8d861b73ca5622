#pragma once

/// A mode as a control shows it. A change may wait until files are read, and the scene may have been replaced when the
/// change is made.

#include <cstddef>
#include <string>

#include "plugin/messages/messages.h"
#include "plugin/paraview/client/model/scene_model.h"

namespace palpate::plugin {

class ShownMode {
 public:
  /// `n`: a mode of the model's scene. For changes of that model.
  ShownMode(const SceneModel& model, std::size_t n) : model_(&model), id_(model.mode_ids().at(n)) {
    const modes::Mode& mode = model.scene().modes.at(n);
    name_ = mode.name.empty() ? mode.type : mode.name;
  }

  /// Its place in the scene that a change gets, before the change adds or removes modes. Throws Refusal if the scene
  /// has it no longer.
  std::size_t in(const modes::Scene& scene) const {
    const auto place = model_->mode_ids().place_of(id_);
    if (!place || *place >= scene.modes.size()) throw Refusal(say("boundary-is-another-one", name_));
    return *place;
  }

 private:
  const SceneModel* model_;
  unsigned id_;
  std::string name_;
};

}  // namespace palpate::plugin
